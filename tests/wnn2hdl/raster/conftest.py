"""Rasters to read."""

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

rasterio = pytest.importorskip("rasterio")

Save = Callable[..., Path]


@pytest.fixture
def save(tmp_path: Path) -> Save:
    """Writes bands ``[count, height, width]`` as a GeoTIFF."""

    def write(bands: NDArray[Any], name: str = "scene.tif", colours: str = "", **profile: Any) -> Path:
        path = tmp_path / name
        count, height, width = bands.shape
        options = {"driver": "GTiff", "count": count, "height": height, "width": width, "dtype": bands.dtype}
        with (
            warnings.catch_warnings(action="ignore"),
            rasterio.open(path, "w", **options, **profile) as target,
        ):
            target.write(bands)
            if colours:
                target.colorinterp = [rasterio.enums.ColorInterp[x] for x in colours.split()]
        return path

    return write


@pytest.fixture
def scene() -> NDArray[np.uint8]:
    """Three bands of 40 x 70."""
    return np.random.default_rng(0).integers(0, 256, (3, 40, 70), dtype=np.uint8)
