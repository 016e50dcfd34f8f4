"""Pictures that are moved a little."""

import numpy as np

from wnn2hdl.training.gradient.pictures import distorted


def test_a_blob_stays_near_its_place_and_keeps_its_light() -> None:
    pictures = np.zeros((40, 20, 24))
    pictures[:, 8:12, 10:14] = 200.0
    moved = distorted(pictures.reshape(40, -1), (20, 24), seed=0).reshape(40, 20, 24)
    centres = np.stack(
        [(moved.sum(axis=axis) * np.arange(n)).sum(axis=1) for axis, n in ((2, 20), (1, 24))], axis=1
    )
    centres /= moved.sum(axis=(1, 2))[:, np.newaxis]
    assert np.abs(centres - [9.5, 11.5]).max() < 2
    assert np.abs(centres - [9.5, 11.5]).mean() > 0.3
    assert np.all(np.abs(moved.sum(axis=(1, 2)) / pictures.sum(axis=(1, 2)) - 1) < 0.25)


def test_a_seed_gives_the_same_pictures() -> None:
    pictures = np.random.default_rng(0).random((5, 36))
    one, same, other = (distorted(pictures, (6, 6), seed) for seed in (1, 1, 2))
    assert np.array_equal(one, same)
    assert not np.array_equal(one, other)
