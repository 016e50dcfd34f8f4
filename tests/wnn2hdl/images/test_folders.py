"""Pictures of a folder and their masks."""

from pathlib import Path

import pytest

from wnn2hdl.errors import InputError
from wnn2hdl.images import list_images, pair_masks


def test_images_are_listed_sorted_and_by_suffix(tmp_path: Path) -> None:
    for name in ("b.PNG", "a.tif", ".hidden.png", "notes.txt"):
        (tmp_path / name).touch()
    (tmp_path / "folder.png").mkdir()
    assert [path.name for path in list_images(tmp_path)] == ["a.tif", "b.PNG"]


def test_a_folder_without_pictures_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no pictures in the folder"):
        list_images(tmp_path)
    with pytest.raises(InputError, match=r"cannot read the folder: .*gone \(No such file"):
        list_images(tmp_path / "gone")


def make_pairs(folder: Path, images: list[str], masks: list[str]) -> tuple[Path, Path]:
    for name, files in (("images", images), ("masks", masks)):
        (folder / name).mkdir()
        for file in files:
            (folder / name / file).touch()
    return folder / "images", folder / "masks"


def test_masks_are_paired_by_stem(tmp_path: Path) -> None:
    images, masks = make_pairs(tmp_path, ["b.tif", "a.jpg"], ["a.png", "b.png", "more.png"])
    assert pair_masks(images, masks) == (
        (images / "a.jpg", masks / "a.png"),
        (images / "b.tif", masks / "b.png"),
    )


def test_missing_masks_are_counted_and_named(tmp_path: Path) -> None:
    folders = make_pairs(tmp_path, ["a.png", "b.png"], ["a.png"])
    with pytest.raises(InputError, match=r"1 of 2 pictures have no mask of the same stem in .*masks: b\.png"):
        pair_masks(*folders)


def test_two_files_of_one_stem_are_refused(tmp_path: Path) -> None:
    folders = make_pairs(tmp_path, ["a.png", "a.tif"], ["a.png"])
    with pytest.raises(InputError, match=r"same stem: .*a\.png, a\.tif"):
        pair_masks(*folders)
