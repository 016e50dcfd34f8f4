"""What to expect of images that nobody has seen, from accuracies on images that a classifier had not seen."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.training.crossval import EXPOSURES

OTHERS = 10
"""Other images whose mean accuracy is predicted."""

CONFIDENCE = 0.95


def prediction_interval(shares: NDArray[np.float64], others: int = OTHERS) -> tuple[float, float] | None:
    """An interval that holds the mean over other images of the kind with the probability `CONFIDENCE`.

    Student's prediction interval: images differ, so that both the mean of these ``n`` and that of the others
    are uncertain, together by ``s * sqrt(1/n + 1/others)``. Pixels of one image resemble one another and are
    no samples.

    Args:
        shares: the share of right pixels of each image, float64 ``[n]``, 0 to 1.
        others: how many other images.

    Returns:
        low and high, within 0 and 1; None with fewer than two images.
    """
    # Not at the top: SciPy takes its time to import.
    from scipy.stats import t

    count = len(shares)
    if count < 2:
        return None
    reach = t.ppf((1 + CONFIDENCE) / 2, count - 1) * shares.std(ddof=1) * np.sqrt(1 / count + 1 / others)
    return float(max(0, shares.mean() - reach)), float(min(1, shares.mean() + reach))


def light_figures(shares: NDArray[np.float64]) -> dict[str, dict[str, Any]]:
    """How accurate a classifier was on images that it had not seen, for each of `EXPOSURES`.

    Args:
        shares: of right pixels, float64 ``[images, exposures]``, at least two images.

    Returns:
        For each exposure the mean over images, the interval of `prediction_interval`, and the lowest share of
        an image.
    """
    return {
        f"{exposure:g}": {
            "accuracy": float(column.mean()),
            "other_images": prediction_interval(column),
            "worst_image": float(column.min()),
        }
        for exposure, column in zip(EXPOSURES, shares.T, strict=True)
    }
