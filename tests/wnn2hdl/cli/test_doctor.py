"""`doctor` says what is here, and what to do about the rest."""

import json
from collections.abc import Callable
from typing import Any

import pytest

from wnn2hdl.tools.inventory import Part

Run = Callable[..., Any]

HERE = Part("Yosys", "proof", "pyosys 0.70", None, None, needed=True)
LACKING = Part("Yosys", "proof", None, "no Yosys found", "pip install pyosys", needed=True)
OPTIONAL = Part("extra geo", "scan", None, "rasterio is missing", "pip install 'wnn2hdl[geo]'", needed=False)


def pretend(monkeypatch: pytest.MonkeyPatch, *parts: Part) -> None:
    monkeypatch.setattr("wnn2hdl.cli.doctor.inventory", lambda: iter(parts))


def test_what_lacks_only_optional_parts_is_healthy(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    pretend(monkeypatch, HERE, OPTIONAL)
    done = run("doctor", "--json")
    assert done.status == 0
    assert json.loads(done.stdout)["healthy"] is True
    shown = run("doctor").stdout
    assert "pyosys 0.70" in shown
    assert "pip install 'wnn2hdl[geo]'" in shown


def test_the_table_fits_and_leaves_nothing_out(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    path = "/an/installation/as/deep/as/they/come/with/python3.11/site-packages/pyosys/yosys-abc"
    pretend(monkeypatch, Part("ABC", "LUT mapping", path, None, None, needed=True))
    for columns in (60, 200):
        monkeypatch.setenv("COLUMNS", str(columns))
        shown = run("doctor").stdout.splitlines()
        assert max(map(len, shown)) <= columns
        last = shown[0].index("found")
        assert path in "".join(line[last:] for line in shown[1:])


def test_a_machine_that_cannot_compile_fails_the_check(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    pretend(monkeypatch, LACKING, OPTIONAL)
    done = run("doctor")
    assert "MISSING" in done.stdout
    assert done.status == 1
    assert "pip install pyosys" in done.stderr
