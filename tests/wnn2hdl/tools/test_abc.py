"""The real ABC, which tells of errors on status 0."""

from pathlib import Path

import pytest

from wnn2hdl.errors import ToolError
from wnn2hdl.tools import find_abc, run_abc


def test_it_is_the_one_that_comes_with_yosys() -> None:
    assert find_abc().name == "yosys-abc"


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
