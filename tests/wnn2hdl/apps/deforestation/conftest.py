"""Models and pictures that are scanned."""

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.classify import WindowResult, classify_window
from wnn2hdl.apps.deforestation.task import Task
from wnn2hdl.apps.deforestation.windows import Window
from wnn2hdl.images import write_png
from wnn2hdl.ir import BitSelect, WisardModel
from wnn2hdl.raster import ClassWriter, Georeference
from wnn2hdl.samples import landscape

pytest.importorskip("rasterio")


class Neighbourhood:
    """A classifier of 5x5 neighbourhoods, plain enough to check: against their mean."""

    classes = ("darker", "equal", "brighter")
    halo = 2

    def classify(self, picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
        grey = picture.astype(np.int64).sum(axis=2)
        windows = np.lib.stride_tricks.sliding_window_view(grey, (5, 5))
        sign = np.sign(25 * grey[2:-2, 2:-2] - windows.sum(axis=(2, 3)))
        return np.asarray(1 + sign, dtype=np.uint8)

    def answer(self, picture: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
        return self.classify(picture), np.asarray(picture[2:-2, 2:-2, 0] > 60)


@pytest.fixture(scope="session")
def neighbourhood() -> Neighbourhood:
    return Neighbourhood()


@pytest.fixture(scope="session")
def red_model() -> WisardModel:
    """Deforested where red is at least 96; colours below 64 are unknown to it."""
    levels = np.arange(8)
    counts = np.stack([levels == 2, levels >= 3]).astype(np.int64)
    return WisardModel(
        BitSelect(("R5", "R6", "R7")),
        ("forest", "deforested"),
        np.array([[[0, 1, 2]]]),
        counts[:, np.newaxis],
        bleaching=1,
    )


@pytest.fixture
def model_file(red_model: WisardModel, tmp_path: Path) -> Path:
    red_model.save(tmp_path / "model.json")
    return tmp_path / "model.json"


@pytest.fixture(scope="session")
def pixels() -> NDArray[np.uint8]:
    """A landscape of 150 x 210."""
    return landscape(150, 210, seed=7).image


@pytest.fixture
def picture_file(pixels: NDArray[np.uint8], tmp_path: Path) -> Path:
    write_png(tmp_path / "picture.png", pixels)
    return tmp_path / "picture.png"


class _Counting:
    """Runs windows one after the other, and can be interrupted after some of them."""

    def __init__(self, stop: int | None = None) -> None:
        self.stop = stop
        self.done: list[int] = []

    def __call__(self, task: Task, windows: Iterable[Window]) -> Iterator[WindowResult]:
        source = task.source
        for window in windows:
            if len(self.done) == self.stop:
                raise KeyboardInterrupt
            self.done.append(window.index)
            yield classify_window(source, task.classifier, task.method, window)


@pytest.fixture(scope="session")
def counting() -> type[_Counting]:
    return _Counting


@pytest.fixture(scope="session")
def save_classes() -> Callable[[Path, NDArray[np.uint8], Georeference], Path]:
    """Writes a class raster, 255 without data."""

    def save(path: Path, classes: NDArray[np.uint8], place: Georeference) -> Path:
        height, width = classes.shape
        with ClassWriter(path, height, width, place, ((0, 90, 0), (200, 0, 0), (0, 0, 200))) as raster:
            raster.write(classes)
        return path

    return save
