"""Batches, epochs and the part for validation."""

import numpy as np

from wnn2hdl.training.gradient.samples import Samples, split

ROWS = np.random.default_rng(0).integers(0, 2, (11, 30), dtype=np.uint8)
LABELS = np.arange(30) % 3


def test_an_epoch_shows_every_sample_once_in_its_own_order() -> None:
    samples = Samples([ROWS], LABELS, seed=5)
    first, again, second = (list(samples.epoch(number, 8)) for number in (0, 0, 1))
    assert [batch.shape for batch, _ in first] == [(11, 8), (11, 8), (11, 8), (11, 6)]
    seen = np.concatenate([np.packbits(rows, axis=0).T for rows, _ in first])
    assert sorted(map(tuple, seen)) == sorted(map(tuple, np.packbits(ROWS, axis=0).T))
    assert all(np.array_equal(a, b) for (a, _), (b, _) in zip(first, again, strict=True))
    assert not all(np.array_equal(a, b) for (a, _), (b, _) in zip(first, second, strict=True))


def test_labels_stay_with_their_samples() -> None:
    labels = ROWS[0].astype(np.int64)
    for rows, of in Samples([ROWS], labels, seed=1).epoch(0, 7):
        assert np.array_equal(rows[0], of)


def test_epochs_take_one_copy_after_the_other() -> None:
    samples = Samples([ROWS * 0, ROWS * 0 + 1], LABELS, seed=0)
    assert [next(iter(samples.epoch(number, 30)))[0].max() for number in range(4)] == [0, 1, 0, 1]
    assert samples.some(10)[0].max() == 0


def test_a_share_of_each_class_is_kept_for_validation() -> None:
    labels = np.array([0] * 20 + [1] * 10 + [2] * 3)
    chosen, kept = split(labels, 0.25, seed=0)
    assert sorted([*chosen, *kept]) == list(range(33))
    assert np.bincount(labels[kept], minlength=3).tolist() == [5, 2, 0]
    assert split(labels, 0, seed=0)[1].size == 0
