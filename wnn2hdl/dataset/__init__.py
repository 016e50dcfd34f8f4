"""Labelled pixels, grouped by image: sets are split by image, never by pixel, and read one image at a time.

Neighbouring pixels are nearly equal, so a split by pixel would test on what was trained.
"""

from wnn2hdl.dataset.histogram import ColourHistogram, colour_histogram
from wnn2hdl.dataset.labelled import CLASSES, Dataset, LabelledImage, Scene, cleared_classes, folds, split
from wnn2hdl.dataset.regions import from_regions
from wnn2hdl.dataset.sources import SAMPLE_IMAGES, SAMPLE_SIDE, from_masks, from_samples

__all__ = [
    "CLASSES",
    "SAMPLE_IMAGES",
    "SAMPLE_SIDE",
    "ColourHistogram",
    "Dataset",
    "LabelledImage",
    "Scene",
    "cleared_classes",
    "colour_histogram",
    "folds",
    "from_masks",
    "from_regions",
    "from_samples",
    "split",
]
