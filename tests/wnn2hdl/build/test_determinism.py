"""A compile under heavy load writes the bytes of a quiet one."""

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from wnn2hdl.build.emission import emit
from wnn2hdl.build.planning import CompileOptions, plan
from wnn2hdl.ir import WisardModel

_BUSY = "while True: sum(range(10_000))"
_PROCESSES_PER_CORE = 3


def silent(step: str, done: int, total: int) -> None:
    pass


@contextmanager
def heavy_load() -> Iterator[None]:
    """Several busy processes on every core."""
    count = _PROCESSES_PER_CORE * (os.cpu_count() or 1)
    busy = [subprocess.Popen([sys.executable, "-c", _BUSY]) for _ in range(count)]
    try:
        yield
    finally:
        for process in busy:
            process.kill()
            process.wait()


def emitted(model: WisardModel, folder: Path) -> dict[str, bytes]:
    """The emitted files of a block, compiled from scratch."""
    folder.mkdir()
    emit(plan(model, "mine", CompileOptions(effort=2), silent).design, folder, sobel_threshold=128)
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.mark.slow
def test_the_load_of_the_machine_decides_no_byte(model: WisardModel, tmp_path: Path) -> None:
    quiet = emitted(model, tmp_path / "quiet")
    with heavy_load():
        loaded = emitted(model, tmp_path / "loaded")
    assert loaded == quiet
