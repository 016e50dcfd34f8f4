"""Arrays to PNG and back."""

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from wnn2hdl.errors import InputError
from wnn2hdl.images import read_rgb, write_png

RGB = np.random.default_rng(0).integers(0, 256, (6, 9, 3), dtype=np.uint8)


@pytest.mark.parametrize("array", [RGB, RGB[..., 0]], ids=["rgb", "grey"])
def test_a_written_png_holds_the_array(tmp_path: Path, array: NDArray[np.uint8]) -> None:
    write_png(tmp_path / "a.png", array)
    assert np.array_equal(np.asarray(Image.open(tmp_path / "a.png")), array)


def test_a_bool_array_becomes_black_and_white(tmp_path: Path) -> None:
    write_png(tmp_path / "a.png", RGB[..., 0] > 127)
    assert np.array_equal(read_rgb(tmp_path / "a.png")[..., 1], (RGB[..., 0] > 127) * np.uint8(255))


def test_a_png_is_not_written_into_a_missing_folder(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot write"):
        write_png(tmp_path / "gone" / "a.png", RGB)
