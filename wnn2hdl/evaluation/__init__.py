"""How good a classifier is: classifiers of pictures, accuracy, measures and their intervals."""
