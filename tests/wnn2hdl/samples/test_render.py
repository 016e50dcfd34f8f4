"""Generated landscapes: repeatable, of any size, truthful, and neither trivial nor hopeless to classify."""

import subprocess
import sys

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.samples import CLASSES, Landscape, landscape

HASH = """
import hashlib
from wnn2hdl.samples import landscape
print(hashlib.sha256(landscape(96, 128, 5).image).hexdigest())
"""


def test_the_same_seed_gives_the_same_bytes_in_another_process() -> None:
    runs = {
        subprocess.run([sys.executable, "-c", HASH], capture_output=True, check=True).stdout for _ in range(2)
    }
    assert len(runs) == 1


def test_another_seed_or_season_gives_another_picture() -> None:
    one, other, wet = landscape(64, 64, 1), landscape(64, 64, 2), landscape(64, 64, 1, season="wet")
    assert not np.array_equal(one.image, other.image)
    assert not np.array_equal(one.image, wet.image)
    assert np.array_equal(one.labels, wet.labels)


@pytest.mark.parametrize("shape", [(1, 1), (1, 9), (9, 1), (3, 2), (50, 131)])
def test_any_size_is_possible(shape: tuple[int, int]) -> None:
    scene = landscape(*shape, 3)
    assert scene.image.shape == (*shape, 3)
    assert scene.image.dtype == np.uint8
    assert scene.labels.shape == shape
    assert scene.labels.dtype == np.uint8
    assert scene.labels.max() < len(CLASSES)


@pytest.mark.parametrize(("height", "width", "seed"), [(0, 5, 0), (5, -1, 0), (5, 5, -1)])
def test_impossible_sizes_and_seeds_are_refused(height: int, width: int, seed: int) -> None:
    with pytest.raises(InputError, match="no landscape has this size or seed"):
        landscape(height, width, seed)


def test_forest_and_river_are_not_deforested_and_all_else_is() -> None:
    labels = np.arange(len(CLASSES), dtype=np.uint8).reshape(1, -1)
    scene = Landscape(np.zeros((1, len(CLASSES), 3), dtype=np.uint8), labels)
    kept = {name for name, flag in zip(CLASSES, scene.deforested[0], strict=True) if not flag}
    assert kept == {"forest", "river"}


@pytest.fixture(scope="module")
def scenes() -> list[Landscape]:
    return [landscape(256, 256, seed) for seed in range(40, 52)]


def test_every_kind_of_ground_occurs_and_both_classes_in_every_picture(scenes: list[Landscape]) -> None:
    assert np.unique(np.stack([scene.labels for scene in scenes])).tolist() == list(range(len(CLASSES)))
    for scene in scenes:
        assert 0.03 < scene.deforested.mean() < 0.9


def histogram(scene: Landscape) -> NDArray[np.int64]:
    """12-bit colours counted for the two classes, ``[2, 4096]``."""
    red, green, blue = (scene.image >> 4).reshape(-1, 3).T.astype(np.int64)
    cells = scene.deforested.ravel() * 4096 + (red << 8 | green << 4 | blue)
    return np.bincount(cells, minlength=8192).reshape(2, 4096)


def test_a_12_bit_pixel_classifier_is_right_on_most_pixels_of_other_pictures_but_not_on_all(
    scenes: list[Landscape],
) -> None:
    counts = np.stack([histogram(scene) for scene in scenes])
    shares = []
    for tested in counts:
        train = counts.sum(axis=0) - tested
        right = np.where(train[1] > train[0], tested[1], tested[0]).sum()
        shares.append(right / tested.sum())
    assert 0.88 < np.mean(shares) < 0.97


def test_forest_is_darker_and_greener_than_bare_ground(scenes: list[Landscape]) -> None:
    forest, bare = (
        np.concatenate([scene.image[scene.labels == CLASSES.index(name)] for scene in scenes]).mean(axis=0)
        for name in ("forest", "bare ground")
    )
    assert forest.sum() < bare.sum() / 2
    assert forest[1] > forest[0]
    assert bare[0] > bare[1]
