"""The real ABC, which reports errors with status 0."""

from dataclasses import replace
from pathlib import Path

import pytest

from wnn2hdl.errors import ToolError
from wnn2hdl.tools import abc, abc_version, find_abc, find_yosys, run_abc


def test_it_is_the_one_that_comes_with_yosys() -> None:
    assert find_abc().name == "yosys-abc"


def test_it_is_told_by_the_yosys_it_came_with() -> None:
    yosys = find_yosys()
    assert abc_version() == f"{yosys.name} {yosys.version.split()[0]}"


def test_one_that_came_alone_is_told_by_its_date(monkeypatch: pytest.MonkeyPatch) -> None:
    alone = replace(find_yosys(), abc_path=None)
    binary = find_abc()
    monkeypatch.setattr(abc, "find_yosys", lambda: alone)
    monkeypatch.setattr(abc, "find_abc", lambda: binary)
    assert abc_version.__wrapped__().startswith("compiled ")


def test_a_truth_table_becomes_luts(tmp_path: Path) -> None:
    output = run_abc(
        "read_truth 6996\nstrash; if -K 6; print_stats\nwrite_blif out.blif",
        cwd=tmp_path,
        timeout=30,
    )
    assert "i/o =    4/    1" in output
    assert "\x1b" not in output
    assert (tmp_path / "out.blif").read_text().count(".names") == 1


@pytest.mark.parametrize(
    ("script", "reason"),
    [
        ("no_such_command", r"\*\* cmd error: unknown command 'no_such_command'"),
        ("read_blif missing.blif", 'Cannot open input file "missing.blif"'),
        ("read_truth -x 8", "Reading truth table has failed"),
        ("strash", r"Error|Empty network"),
    ],
)
def test_an_error_line_is_a_failure(script: str, reason: str, tmp_path: Path) -> None:
    with pytest.raises(ToolError, match=rf"^yosys-abc failed: ({reason})"):
        run_abc(f"{script}\nwrite_blif out.blif", cwd=tmp_path, timeout=30)
    assert not (tmp_path / "out.blif").exists()


def test_a_crash_is_a_failure() -> None:
    with pytest.raises(ToolError, match=r"^yosys-abc was killed by SIGSEGV"):
        run_abc("read_truth zz", timeout=30)
