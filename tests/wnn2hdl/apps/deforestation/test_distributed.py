"""Windows on a cluster."""

import os
import signal
from dataclasses import replace
from pathlib import Path
from typing import Any
from uuid import uuid4

import numpy as np
import pytest

from wnn2hdl.apps.deforestation.classify import Method, WindowResult
from wnn2hdl.apps.deforestation.distributed import run_distributed
from wnn2hdl.apps.deforestation.local import run_locally
from wnn2hdl.apps.deforestation.task import Task
from wnn2hdl.apps.deforestation.windows import Window
from wnn2hdl.errors import InputError, ToolError
from wnn2hdl.evaluation.classifiers import model_classifier
from wnn2hdl.images import write_png
from wnn2hdl.ir import WisardModel
from wnn2hdl.raster import Reading

WINDOWS = [
    Window(index, row, column, 10, 70)
    for index, (row, column) in enumerate((r, c) for r in range(0, 150, 10) for c in range(0, 210, 70))
]


@pytest.fixture
def task(picture_file: Path, red_model: WisardModel) -> Task:
    return Task(picture_file, Reading(), model_classifier(red_model), Method(square=10))


@pytest.mark.slow
def test_a_killed_worker_changes_nothing(cluster: Any, task: Task) -> None:
    first = next(iter(cluster.workers.values())).pid
    found: dict[int, WindowResult] = {}
    for number, result in enumerate(run_distributed(cluster.scheduler_address, task, WINDOWS)):
        if number == 2:
            os.kill(first, signal.SIGKILL)
        assert result.index not in found
        found[result.index] = result
    with pytest.raises(ProcessLookupError):
        os.kill(first, 0)
    assert [found[window.index] for window in WINDOWS] == list(run_locally(1, task, WINDOWS))


@pytest.mark.slow
def test_a_worker_sees_that_the_file_is_a_new_one(cluster: Any, task: Task) -> None:
    def scan() -> list[WindowResult]:
        found = run_distributed(cluster.scheduler_address, replace(task, token=uuid4().hex), WINDOWS)
        return sorted(found, key=lambda result: result.index)

    first = scan()
    write_png(task.path, np.full((150, 210, 3), 200, dtype=np.uint8))
    second = scan()
    assert second == list(run_locally(1, task, WINDOWS))
    assert second != first


@pytest.mark.slow
def test_what_a_worker_cannot_read_is_one_line(cluster: Any, task: Task, tmp_path: Path) -> None:
    elsewhere = Task(tmp_path / "none.png", task.reading, task.classifier, task.method)
    with pytest.raises(InputError, match=r"none\.png \(No such file or directory\)"):
        list(run_distributed(cluster.scheduler_address, elsewhere, WINDOWS))


@pytest.mark.slow
def test_a_window_that_kills_every_worker_is_named(
    cluster: Any, task: Task, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("wnn2hdl.apps.deforestation.distributed._classify", _die_of_the_second)
    with pytest.raises(ToolError, match="from row 0 and column 70 on"):
        list(run_distributed(cluster.scheduler_address, task, WINDOWS[:6]))


def _die_of_the_second(task: Task, window: Window) -> WindowResult:
    if window.index == 1:
        os.kill(os.getpid(), signal.SIGKILL)
    return next(run_locally(1, task, [window]))
