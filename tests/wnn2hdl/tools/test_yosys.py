"""The real Yosys, and false ones that fail."""

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from wnn2hdl.errors import InputError, ToolError
from wnn2hdl.tools import Yosys, find_yosys
from wnn2hdl.tools.yosys import CHOICE


@pytest.fixture
def fresh() -> Iterator[None]:
    find_yosys.cache_clear()
    yield
    find_yosys.cache_clear()


@pytest.fixture
def on_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, fresh: None) -> Path:
    """A file that is the only `yosys` to be found; a test writes its shell script."""
    monkeypatch.setenv(CHOICE, "path")
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    binary = tmp_path / "yosys"
    binary.touch(mode=0o755)
    return binary


def test_the_installed_one_is_found_with_version_and_abc() -> None:
    yosys = find_yosys()
    assert yosys.name == "pyosys"
    assert yosys.version.startswith("0.")
    assert yosys.abc_path is not None
    assert yosys.abc_path.is_file()
    assert find_yosys() is yosys
    assert "pyosys" not in sys.modules


def test_a_script_runs_in_its_folder_and_returns_the_log(tmp_path: Path) -> None:
    (tmp_path / "wire.v").write_text("module wire_through(input a, output y); assign y = a; endmodule\n")
    log = find_yosys().run("read_verilog wire.v\nwrite_rtlil out.il", cwd=tmp_path, timeout=60)
    assert "Successfully finished Verilog frontend" in log
    assert "connect \\y \\a" in (tmp_path / "out.il").read_text()


@pytest.mark.parametrize(
    ("script", "reason"),
    [
        ("no_such_pass", "ERROR: No such command: no_such_pass"),
        ("read_verilog missing.v", "ERROR: File `missing.v' not found"),
        ("read_verilog <<EOT\nmodule m(; endmodule\nEOT", "<inlined>:1: ERROR: syntax error"),
        (
            "read_verilog <<EOT\nmodule m(output y); assign y = 0; endmodule\nEOT\nselect -assert-none m",
            "ERROR: Assertion failed",
        ),
    ],
)
def test_a_pass_that_fails_is_an_error_and_this_process_lives_on(script: str, reason: str) -> None:
    with pytest.raises(ToolError, match=rf"^pyosys failed with exit status 1: {reason}"):
        find_yosys().run(script, timeout=60)


def test_the_time_limit_holds() -> None:
    with pytest.raises(ToolError, match=r"^pyosys did not finish in 0\.5 s"):
        find_yosys().run("exec -- sleep 30", timeout=0.5)


def test_a_killed_worker_is_an_error() -> None:
    with pytest.raises(ToolError, match=r"^pyosys was killed by SIGKILL"):
        find_yosys().run("exec -- kill -9 $PPID", timeout=60)


def test_one_on_the_path_is_used_when_chosen(on_path: Path) -> None:
    on_path.write_text(
        """#!/bin/sh
echo '   "creator": "Yosys 0.33 (false)",'
sed -n 's/^log //p'
"""
    )
    abc = on_path.with_name("yosys-abc")
    abc.touch()
    yosys = find_yosys()
    assert (yosys.name, yosys.version, yosys.abc_path) == ("yosys", "0.33 (false)", abc)
    assert yosys.command == (str(on_path), "-s", "-")


def test_one_that_does_not_work_is_named_with_the_reason(on_path: Path) -> None:
    on_path.write_text("#!/bin/sh\necho cannot load libstuff; exit 127\n")
    with pytest.raises(
        ToolError, match=r"^no Yosys works: yosys failed with exit status 127: cannot load libst"
    ):
        find_yosys()


def test_none_at_all_says_how_to_install(on_path: Path) -> None:
    on_path.unlink()
    with pytest.raises(ToolError, match=r"^no Yosys found: path; pip install pyosys"):
        find_yosys()


def test_a_choice_that_is_none(monkeypatch: pytest.MonkeyPatch, fresh: None) -> None:
    monkeypatch.setenv(CHOICE, "vivado")
    with pytest.raises(
        InputError, match=r"^WNN2HDL_YOSYS does not name a Yosys: vivado; leave it out or set it to pyosys"
    ):
        find_yosys()


def test_stopping_half_way_with_status_0_is_an_error() -> None:
    silent = Yosys("false-yosys", "1", ("sh", "-c", "cat > /dev/null; echo Executing ABC9."), None)
    with pytest.raises(
        ToolError, match=r"^false-yosys stopped in the middle of its script: Executing ABC9\."
    ):
        silent.run("synth_xilinx", timeout=10)
