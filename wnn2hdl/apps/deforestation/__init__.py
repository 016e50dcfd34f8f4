"""Maps of deforestation: classes, areas, polygons and changes, from imagery of any size."""
