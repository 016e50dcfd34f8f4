"""The applications: deforestation maps, navigation, the architecture sweep, the demo."""
