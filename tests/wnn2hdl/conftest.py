"""A small model and builds of it, rasters to read: what tests of several packages share."""

import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.build.compile import compile_model
from wnn2hdl.build.planning import CompileOptions
from wnn2hdl.dataset import from_samples
from wnn2hdl.encode import parse_bits
from wnn2hdl.images import write_png
from wnn2hdl.ir import WisardModel
from wnn2hdl.samples import landscape
from wnn2hdl.samples.landscapes import IMAGES, MASKS, write_landscapes
from wnn2hdl.training.discriminators import train


def silent(step: str, done: int, total: int) -> None:
    """No progress is shown."""


@pytest.fixture(scope="session")
def model() -> WisardModel:
    """Eight pixel bits, discriminators of six RAMs, trained on three small landscapes."""
    return train(
        from_samples(3, 64, seed=1),
        parse_bits("R7,R6,R5,G7,G6,G5,B6,B5"),
        address_bits=3,
        rams=6,
        bleaching=None,
        seed=0,
        progress=silent,
    )


@pytest.fixture(scope="session")
def imagery(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of two landscapes."""
    folder = tmp_path_factory.mktemp("imagery")
    for seed in (7, 8):
        write_png(folder / f"{seed}.png", landscape(64, 64, seed).image)
    return folder


@pytest.fixture(scope="session")
def tested(tmp_path_factory: pytest.TempPathFactory) -> CompileOptions:
    """Options that name two labelled landscapes to test on."""
    folder = tmp_path_factory.mktemp("test imagery")
    write_landscapes(folder, 2, 64, seed=5, progress=silent)
    return CompileOptions(test_images=folder / IMAGES, test_masks=folder / MASKS)


@pytest.fixture(scope="session")
def build(
    model: WisardModel, imagery: Path, tested: CompileOptions, tmp_path_factory: pytest.TempPathFactory
) -> Path:
    """A block in domain mode, compiled once."""
    folder = tmp_path_factory.mktemp("builds") / "block"
    options = replace(tested, mode="domain", care=imagery)
    assert compile_model(model, folder, options, silent).failure is None
    return folder


@pytest.fixture(scope="session")
def pixel_build(model: WisardModel, imagery: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A pixel in domain mode, compiled once: quicker to check again than a block."""
    folder = tmp_path_factory.mktemp("builds") / "pixel"
    options = CompileOptions(target="pixel", mode="domain", care=imagery)
    assert compile_model(model, folder, options, silent).failure is None
    return folder


@pytest.fixture
def save(tmp_path: Path) -> Callable[..., Path]:
    """``save(bands, name, colours, **profile)`` writes bands ``[count, height, width]`` as a GeoTIFF."""
    rasterio = pytest.importorskip("rasterio")

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
