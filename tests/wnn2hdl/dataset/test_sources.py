"""Labelled images from masks and from the embedded landscapes."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from wnn2hdl.dataset import CLASSES, from_masks, from_samples
from wnn2hdl.errors import InputError
from wnn2hdl.images import UNLABELLED, MaskFormat, Palette, write_png
from wnn2hdl.samples import CLASSES as KINDS
from wnn2hdl.samples import landscape


@pytest.fixture
def folders(tmp_path: Path) -> tuple[Path, Path]:
    images, masks = tmp_path / "images", tmp_path / "masks"
    images.mkdir()
    masks.mkdir()
    for seed in (1, 2):
        scene = landscape(40, 30, seed)
        write_png(images / f"s{seed}.png", scene.image)
        write_png(masks / f"s{seed}.png", scene.deforested)
    return images, masks


def test_masks_label_every_pixel(folders: tuple[Path, Path]) -> None:
    dataset = from_masks(*folders)
    assert dataset.classes == CLASSES
    assert dataset.names == ("s1.png", "s2.png")
    for seed, image in zip((1, 2), dataset, strict=True):
        scene = landscape(40, 30, seed)
        assert np.array_equal(image.pixels, scene.image.reshape(-1, 3))
        assert np.array_equal(image.labels, scene.deforested.ravel())
        assert image.labels.dtype == np.uint8


def test_a_palette_gives_more_classes(folders: tuple[Path, Path]) -> None:
    images, masks = folders
    palette = Palette.of(KINDS)
    for seed in (1, 2):
        write_png(masks / f"s{seed}.png", palette.paint(landscape(40, 30, seed).labels))
    dataset = from_masks(images, masks, MaskFormat(palette))
    assert dataset.classes == KINDS
    assert np.array_equal(next(iter(dataset)).labels, landscape(40, 30, 1).labels.ravel())


def test_a_mask_of_another_size_is_refused_when_read(folders: tuple[Path, Path]) -> None:
    write_png(folders[1] / "s1.png", np.zeros((30, 40), dtype=np.bool_))
    dataset = from_masks(*folders)
    with pytest.raises(InputError, match="different sizes"):
        dataset.load("s1.png")


@pytest.mark.parametrize("every_kind", [False, True])
def test_samples_are_landscapes_of_successive_seeds(every_kind: bool) -> None:
    dataset = from_samples(2, 32, seed=7, every_kind=every_kind)
    assert dataset.names == ("landscape-00007", "landscape-00008")
    assert dataset.classes == (KINDS if every_kind else CLASSES)
    scene = landscape(32, 32, 8)
    image = dataset.load("landscape-00008")
    assert np.array_equal(image.pixels, scene.image.reshape(-1, 3))
    assert np.array_equal(image.labels, (scene.labels if every_kind else scene.deforested).ravel())


def test_a_set_of_no_samples_is_refused() -> None:
    with pytest.raises(InputError, match="at least one landscape: 0"):
        from_samples(0, 32, seed=0)


def test_pixels_that_nobody_labelled_or_measured_are_left_out(folders: tuple[Path, Path]) -> None:
    images, masks = folders
    scene = landscape(40, 30, 1)
    alpha = np.full((40, 30), 255, dtype=np.uint8)
    alpha[:10] = 0
    Image.fromarray(np.dstack([scene.image, alpha])).save(images / "s1.png")
    labels = scene.deforested.astype(np.uint8)
    labels[:, :5] = 7
    write_png(masks / "s1.png", labels)
    image = from_masks(images, masks, MaskFormat(ignored=frozenset({7}))).load("s1.png")
    used = (alpha == 255) & (labels != 7)
    assert np.array_equal(image.pixels, scene.image[used])
    assert np.array_equal(image.labels, labels[used])
    assert image.left_out == (~used).sum()
    assert np.array_equal(image.picture, scene.image)
    assert np.array_equal(image.label_picture, np.where(used, labels, UNLABELLED))
    near = image.usable(1)
    # A pixel beside one without data is not whole; one beside an unlabelled pixel is.
    assert np.array_equal(near, used & (np.arange(40)[:, np.newaxis] > 10))


def test_masks_of_a_folder_that_name_deforested_differently_are_refused(folders: tuple[Path, Path]) -> None:
    for seed, value in ((1, 1), (2, 255)):
        write_png(
            folders[1] / f"s{seed}.png", landscape(40, 30, seed).deforested.astype(np.uint8) * np.uint8(value)
        )
    with pytest.raises(InputError, match="masks of one folder hold 1 and 255"):
        list(from_masks(*folders))
