"""The embedded landscapes as files read back as what they were."""

from pathlib import Path

import numpy as np
import pytest

from wnn2hdl.dataset import from_masks, from_samples
from wnn2hdl.errors import InputError
from wnn2hdl.images import MaskFormat, Palette
from wnn2hdl.samples.landscapes import write_landscapes


def silent(step: str, done: int, total: int) -> None:
    """No progress is shown."""


@pytest.mark.parametrize("every_kind", [False, True])
def test_the_files_hold_the_embedded_data_set(tmp_path: Path, every_kind: bool) -> None:
    write_landscapes(tmp_path, 2, 48, seed=5, progress=silent)
    palette = Palette.read(tmp_path / "palette.json") if every_kind else None
    files = from_masks(
        tmp_path / "images", tmp_path / ("kinds" if every_kind else "masks"), MaskFormat(palette)
    )
    embedded = from_samples(2, 48, seed=5, every_kind=every_kind)
    assert files.classes == embedded.classes
    for written, made in zip(files, embedded, strict=True):
        assert np.array_equal(written.pixels, made.pixels)
        assert np.array_equal(written.labels, made.labels)


def test_landscapes_without_pixels_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="size or seed"):
        write_landscapes(tmp_path, 1, 0, seed=0, progress=silent)
