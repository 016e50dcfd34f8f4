"""Training: discriminators on images, classifiers under a LUT budget, cross-validation."""
