"""Samples as they are stored, for masks."""

from typing import Any

import numpy as np
import pytest

from wnn2hdl.errors import InputError
from wnn2hdl.raster import read_stored

pytest.importorskip("rasterio")


def test_signed_samples_and_their_nodata(save: Any) -> None:
    stored = read_stored(save(np.array([[[-1, 0, 1]]], dtype=np.int8), nodata=-1))
    assert stored.samples.tolist() == [[[-1, 0, 1]]]
    assert stored.valid.tolist() == [[False, True, True]]
    assert stored.palette is None


def test_white_by_zero_has_two_readings(save: Any) -> None:
    with pytest.raises(InputError, match="0 is white"):
        read_stored(save(np.zeros((1, 2, 2), np.uint8), photometric="miniswhite"))
