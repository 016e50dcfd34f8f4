"""Windows on threads give what one after the other gives."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.classify import Method, WindowResult, classify_window
from wnn2hdl.apps.deforestation.local import run_locally
from wnn2hdl.apps.deforestation.task import Task
from wnn2hdl.apps.deforestation.windows import Window
from wnn2hdl.evaluation.classifiers import PictureClassifier
from wnn2hdl.images import PlainPicture, write_png
from wnn2hdl.raster import Reading

WINDOWS = [
    Window(index, row, column, 30, 42)
    for index, (row, column) in enumerate((r, c) for r in range(0, 150, 30) for c in range(0, 210, 42))
]


@pytest.mark.parametrize("jobs", [1, 2, 5])
def test_results_come_in_order_and_are_the_same(
    jobs: int, picture_file: Path, pixels: NDArray[np.uint8], neighbourhood: PictureClassifier
) -> None:
    method = Method(square=6)
    task = Task(picture_file, Reading(), neighbourhood, method)
    alone = [classify_window(PlainPicture(pixels), neighbourhood, method, window) for window in WINDOWS]
    assert list(run_locally(jobs, task, WINDOWS)) == alone


def test_windows_are_taken_as_they_are_needed(picture_file: Path, neighbourhood: PictureClassifier) -> None:
    taken: list[int] = []

    def windows() -> Iterator[Window]:
        for window in WINDOWS:
            taken.append(window.index)
            yield window

    results = run_locally(2, Task(picture_file, Reading(), neighbourhood, Method()), windows())
    assert isinstance(next(results), WindowResult)
    assert len(taken) == 4
    results.close()
    assert len(taken) == 4


def test_an_error_in_a_thread_comes_through(tmp_path: Path, neighbourhood: PictureClassifier) -> None:
    class Broken(type(neighbourhood)):  # type: ignore[misc]
        def answer(self, picture: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
            raise MemoryError

    write_png(tmp_path / "a.png", np.zeros((150, 210, 3), dtype=np.uint8))
    with pytest.raises(MemoryError):
        list(run_locally(2, Task(tmp_path / "a.png", Reading(), Broken(), Method()), WINDOWS))
