"""A compile writes the same bytes under heavy load, and when it remembers an earlier one."""

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from wnn2hdl.build.compile import compile_model
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
def test_the_load_of_the_machine_decides_no_byte(
    model: WisardModel, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("WNN2HDL_CACHE", str(tmp_path / "cache of the quiet one"))
    quiet = emitted(model, tmp_path / "quiet")
    monkeypatch.setenv("WNN2HDL_CACHE", str(tmp_path / "cache of the loaded one"))
    with heavy_load():
        loaded = emitted(model, tmp_path / "loaded")
    assert loaded == quiet


@pytest.mark.slow
def test_what_is_remembered_decides_no_byte(
    model: WisardModel, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("WNN2HDL_CACHE", str(tmp_path / "cache"))
    cold, warm = tmp_path / "cold" / "mine", tmp_path / "warm" / "mine"
    for folder in (cold, warm):
        folder.parent.mkdir()
        assert compile_model(model, folder, CompileOptions(target="pixel"), silent).failure is None
    # These tell the times, or are made of what tells them.
    reports = {"manifest.json", "report.html", "report.json", "report.md"}
    first, second = (
        {path.name: path.read_bytes() for path in folder.iterdir() if path.name not in reports}
        for folder in (cold, warm)
    )
    assert first == second
    told, again = (json.loads((folder / "report.json").read_text()) for folder in (cold, warm))
    assert (told["proof"]["before"], again["proof"]["before"]) == ([], ["pixel"])
    assert (told["options"]["simulated_before"], again["options"]["simulated_before"]) == ("", "pixel")
    assert without_memory(told) == without_memory(again)


def without_memory(report: dict[str, Any]) -> dict[str, Any]:
    """A report without its times and what it says about earlier builds."""
    for place, key in (("proof", "seconds"), ("proof", "before"), ("options", "simulated_before")):
        del report[place][key]
    del report["seconds"]
    return report
