"""The testbench notices what is wrong."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from wnn2hdl import elaborate
from wnn2hdl.emit import testbench as write_testbench
from wnn2hdl.emit import vectors, verilog
from wnn2hdl.errors import ToolError
from wnn2hdl.tools import run_icarus, run_verilator

pytestmark = [
    pytest.mark.simulator,
    pytest.mark.skipif(shutil.which("iverilog") is None, reason="Icarus is not installed"),
]
REFERENCE, BITS = np.divmod(np.arange(1 << 12), 1 << 6)
INPUTS = {"bits": BITS, "reference": REFERENCE}
COUNTS = 6 - np.bitwise_count(BITS ^ REFERENCE)


def bench(
    folder: Path, counts: np.ndarray[tuple[int, ...], np.dtype[np.uint8]], design: str = ""
) -> list[Path]:
    component = elaborate.match(6)
    files = [folder / "match.v", folder / "match_tb.v"]
    files[0].write_text(design or verilog(component, name="match", header=[]))
    files[1].write_text(
        write_testbench(
            component, name="match", count=len(counts), vectors_file="match.hex", sources=["match.v"]
        )
    )
    (folder / "match.hex").write_text(vectors(component, INPUTS, {"match_count": counts}))
    return files


def test_vectors_put_the_ports_side_by_side() -> None:
    two = {"bits": np.array([0b000001, 0]), "reference": np.array([0b100000, 0])}
    assert vectors(elaborate.match(6), two, {"match_count": np.array([4, 6])}) == "0b04\n0006\n".replace(
        "0b04", f"{0b000001_100000_100:04x}"
    )


def test_a_right_circuit_passes(tmp_path: Path) -> None:
    assert run_icarus(bench(tmp_path, COUNTS), "match_tb", cwd=tmp_path, timeout=60).output == (
        "PASS: match, 4096 vectors\n"
    )


def test_a_wrong_answer_is_shown_and_ends_with_a_status(tmp_path: Path) -> None:
    wrong = COUNTS.copy()
    wrong[100] = 7
    with pytest.raises(ToolError) as caught:
        run_icarus(bench(tmp_path, wrong), "match_tb", cwd=tmp_path, timeout=60)
    assert "FAIL: match, vector 100 of 4096" in caught.value.output
    assert "  bits = 24\n  reference = 01\n  match_count = 3, expected 7\n" in caught.value.output


def test_an_unknown_output_fails(tmp_path: Path) -> None:
    nothing = "module match (input [5:0] bits, input [5:0] reference, output [2:0] match_count);\nendmodule\n"
    with pytest.raises(ToolError) as caught:
        run_icarus(bench(tmp_path, COUNTS, nothing), "match_tb", cwd=tmp_path, timeout=60)
    assert "match_count = z" in caught.value.output


def test_missing_vectors_fail(tmp_path: Path) -> None:
    files = bench(tmp_path, COUNTS)
    (tmp_path / "match.hex").unlink()
    with pytest.raises(ToolError) as caught:
        run_icarus(files, "match_tb", cwd=tmp_path, timeout=60)
    assert "FAIL: match, vector 0" in caught.value.output


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("g++") is None, reason="no C++ compiler")
def test_it_runs_in_verilator_too(tmp_path: Path) -> None:
    files = bench(tmp_path, COUNTS)
    assert "PASS: match, 4096 vectors" in run_verilator(files, "match_tb", cwd=tmp_path, timeout=300).output
