"""The pictures of a folder, and the masks that belong to them."""

from pathlib import Path

from wnn2hdl.errors import InputError

SUFFIXES = (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".jp2")
"""What `list_images` takes for a picture, in lower or upper case."""


def list_images(folder: Path) -> tuple[Path, ...]:
    """The pictures of a folder by `SUFFIXES`, sorted by name; hidden files and subfolders are left out.

    Raises:
        InputError: the folder cannot be read or holds no picture.
    """
    try:
        entries = sorted(folder.iterdir())
    except OSError as error:
        raise InputError("cannot read the folder", value=f"{folder} ({error.strerror})") from error
    found = tuple(
        entry
        for entry in entries
        if entry.suffix.lower() in SUFFIXES and not entry.name.startswith(".") and entry.is_file()
    )
    if not found:
        raise InputError(
            "no pictures in the folder",
            value=folder,
            hint=f"it should hold files ending in {', '.join(SUFFIXES)}",
        )
    return found


def pair_masks(images: Path, masks: Path) -> tuple[tuple[Path, Path], ...]:
    """Each picture of one folder with the mask of the same stem in the other, sorted by name.

    Raises:
        InputError: a folder cannot be read or is empty, a picture has no mask, or two files of a folder have
            the same stem. Masks without a picture are left out.
    """
    pictures, mask_of = by_stem(images), by_stem(masks)
    missing = [path.name for stem, path in pictures.items() if stem not in mask_of]
    if missing:
        raise InputError(
            f"{len(missing)} of {len(pictures)} pictures have no mask of the same stem in {masks}",
            value=", ".join(missing[:3]) + (" …" if len(missing) > 3 else ""),
            hint="add the masks, or take the pictures out",
        )
    return tuple((path, mask_of[stem]) for stem, path in pictures.items())


def by_stem(folder: Path) -> dict[str, Path]:
    """The pictures of a folder by their stem, sorted.

    Raises:
        InputError: as `list_images`, or two pictures have the same stem.
    """
    found: dict[str, Path] = {}
    for path in list_images(folder):
        if path.stem in found:
            raise InputError(
                "two pictures of a folder have the same stem",
                value=f"{found[path.stem]}, {path.name}",
                hint="rename or remove one",
            )
        found[path.stem] = path
    return found
