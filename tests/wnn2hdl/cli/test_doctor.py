"""`doctor` says what is here, and what to do about the rest."""

import json

import pytest
from click.testing import CliRunner

from wnn2hdl.cli.doctor import doctor_command
from wnn2hdl.errors import CheckError
from wnn2hdl.tools.inventory import Part

HERE = Part("Yosys", "proof", "pyosys 0.70", None, None, needed=True)
LACKING = Part("Yosys", "proof", None, "no Yosys found", "pip install pyosys", needed=True)
OPTIONAL = Part("extra geo", "scan", None, "rasterio is missing", "pip install 'wnn2hdl[geo]'", needed=False)


def pretend(monkeypatch: pytest.MonkeyPatch, *parts: Part) -> None:
    monkeypatch.setattr("wnn2hdl.cli.doctor.inventory", lambda: iter(parts))


def test_a_machine_that_lacks_only_optional_parts_is_healthy(monkeypatch: pytest.MonkeyPatch) -> None:
    pretend(monkeypatch, HERE, OPTIONAL)
    done = CliRunner().invoke(doctor_command, ["--json"])
    assert done.exit_code == 0
    assert json.loads(done.stdout)["healthy"] is True
    shown = CliRunner().invoke(doctor_command).stdout
    assert "pyosys 0.70" in shown
    assert "pip install 'wnn2hdl[geo]'" in shown


def test_the_table_fits_the_terminal_and_leaves_nothing_out(monkeypatch: pytest.MonkeyPatch) -> None:
    path = "/an/installation/as/deep/as/they/come/with/python3.11/site-packages/pyosys/yosys-abc"
    pretend(monkeypatch, Part("ABC", "LUT mapping", path, None, None, needed=True))
    for columns in (60, 200):
        monkeypatch.setenv("COLUMNS", str(columns))
        shown = CliRunner().invoke(doctor_command).stdout.splitlines()
        assert max(map(len, shown)) <= columns
        last = shown[0].index("found")
        assert path in "".join(line[last:] for line in shown[1:])


def test_a_machine_that_cannot_compile_fails_the_check(monkeypatch: pytest.MonkeyPatch) -> None:
    pretend(monkeypatch, LACKING, OPTIONAL)
    done = CliRunner().invoke(doctor_command)
    assert "MISSING" in done.stdout
    assert isinstance(done.exception, CheckError)
    assert "pip install pyosys" in done.exception.line()
