"""Folds of cross-validation: which images or samples are trained on, and which are kept out."""

import numpy as np
from numpy.typing import NDArray

FOLDS = 5


def fold_count(items: int) -> int:
    """How many folds are made of so many images or samples; fewer than `FOLDS` are kept out one by one."""
    return min(FOLDS, items)


def training_sets(images: int) -> list[list[int]]:
    """For each fold the images that are trained on; fold ``f`` keeps out those with ``i % folds == f``.

    These are the folds of `wnn2hdl.dataset.folds`, for images in the order of their names.
    """
    folds = fold_count(images)
    return [[i for i in range(images) if i % folds != fold] for fold in range(folds)]


def dealt(owners: NDArray[np.int64], folds: int, seed: int) -> NDArray[np.int64]:
    """The fold that keeps out each sample: those of every class are shuffled and dealt out in turn.

    Args:
        owners: class index of each sample.
        folds: how many there are.
        seed: of the order.

    Returns:
        int64 ``[samples]``.
    """
    shuffled = np.lexsort((np.random.default_rng(seed).random(len(owners)), owners))
    fold_of = np.empty(len(owners), dtype=np.int64)
    fold_of[shuffled] = np.arange(len(owners)) % folds
    return fold_of
