"""From a model to a circuit."""
