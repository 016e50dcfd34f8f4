"""A picture's class raster: the same whatever happened on the way."""

import tracemalloc
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation import mapping
from wnn2hdl.apps.deforestation.class_raster import open_classes
from wnn2hdl.apps.deforestation.classify import Method
from wnn2hdl.apps.deforestation.finished import FinishedWindows
from wnn2hdl.apps.deforestation.mapping import Coverage, Runner, write_classes
from wnn2hdl.apps.deforestation.task import Task
from wnn2hdl.apps.deforestation.windows import cut
from wnn2hdl.evaluation.classifiers import PictureClassifier
from wnn2hdl.images import Palette
from wnn2hdl.raster import Georeference, Reading

rasterio = pytest.importorskip("rasterio")

PALETTE = Palette.of(("darker", "equal", "brighter"))


@pytest.fixture(autouse=True)
def small_windows(monkeypatch: pytest.MonkeyPatch) -> None:
    """Cuts pictures into windows of about 50 pixels squared."""

    monkeypatch.setattr("wnn2hdl.apps.deforestation.windows.WINDOW_SIDE", 50)
    monkeypatch.setattr(mapping, "cut", lambda height, width, block, side: cut(height, width, (1, 1), side))


def written(task: Task, run: Runner, folder: Path, **identity: Any) -> tuple[NDArray[np.uint8], Coverage]:
    output = folder / "classes.tif"
    with FinishedWindows(folder / "windows", identity) as kept:
        coverage = write_classes(task, task.source, kept, run, output, PALETTE, lambda *_: None)
    with open_classes(output) as dataset:
        assert Georeference.of(dataset) == Georeference()
        return dataset.read(1), coverage


@pytest.fixture
def task(picture_file: Path, neighbourhood: PictureClassifier) -> Task:
    return Task(picture_file, Reading(), neighbourhood, Method())


def test_the_raster_holds_the_classes(
    task: Task, pixels: NDArray[np.uint8], counting: Any, tmp_path: Path
) -> None:
    padded = np.pad(pixels, ((2, 2), (2, 2), (0, 0)), mode="edge")
    classes, coverage = written(task, counting(), tmp_path)
    assert np.array_equal(classes, task.classifier.classify(padded))
    assert coverage == Coverage(padded[2:-2, 2:-2, 0].size, int(task.classifier.answer(padded)[1].sum()))


@pytest.mark.parametrize("stop", [0, 1, 7, 14])
def test_an_interrupted_scan_goes_on(stop: int, task: Task, counting: Any, tmp_path: Path) -> None:
    expected = written(task, counting(), tmp_path)
    (tmp_path / "windows").unlink()
    (tmp_path / "classes.tif").unlink()
    with pytest.raises(KeyboardInterrupt):
        written(task, counting(stop), tmp_path)
    assert not (tmp_path / "classes.tif").exists()
    again = counting()
    classes, coverage = written(task, again, tmp_path)
    assert again.done == list(range(stop, 15))
    assert np.array_equal(classes, expected[0])
    assert coverage == expected[1]


def test_other_options_begin_anew(task: Task, counting: Any, tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt):
        written(task, counting(7), tmp_path, seed=0)
    again = counting()
    written(task, again, tmp_path, seed=1)
    assert len(again.done) == 15


def test_results_may_come_in_any_order(task: Task, counting: Any, tmp_path: Path) -> None:
    def backwards(task: Task, windows: Any) -> Any:
        yield from counting()(task, list(windows)[::-1])

    expected, _ = written(task, counting(), tmp_path)
    (tmp_path / "windows").unlink()
    assert np.array_equal(written(task, backwards, tmp_path)[0], expected)


def test_memory_holds_one_row_of_windows(
    counting: Any, neighbourhood: PictureClassifier, tmp_path: Path
) -> None:
    path = tmp_path / "tall.tif"
    options = {"driver": "GTiff", "count": 3, "height": 10_000, "width": 100, "dtype": "uint8"}
    place = rasterio.Affine(1, 0, 5, 0, -1, 0)
    with rasterio.open(path, "w", photometric="rgb", sparse_ok=True, transform=place, **options):
        pass
    task = Task(path, Reading(), neighbourhood, Method())
    tracemalloc.start()
    with FinishedWindows(tmp_path / "windows", {}) as kept:
        output = tmp_path / "classes.tif"
        write_classes(task, task.source, kept, counting(), output, PALETTE, lambda *_: None)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    # The whole picture is 3 MB, and a neighbourhood takes 200 bytes per pixel of a window.
    assert peak < 2e6
