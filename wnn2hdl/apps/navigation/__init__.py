"""Where is the UAV, from edges alone: camera frames matched with a georeferenced map."""
