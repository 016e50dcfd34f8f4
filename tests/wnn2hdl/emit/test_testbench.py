# amaranth: UnusedElaboratable=no
"""The testbench notices what is wrong."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from wnn2hdl.elaborate import component
from wnn2hdl.emit import testbench as write_testbench
from wnn2hdl.emit import vectors, verilog
from wnn2hdl.errors import ToolError
from wnn2hdl.ir import codes_to_bits
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.nodes import Match, Register
from wnn2hdl.ir.wires import Bits, Port, Slice
from wnn2hdl.tools import lint_icarus, lint_verilator, run_icarus, run_verilator

needs_simulator = pytest.mark.skipif(shutil.which("iverilog") is None, reason="Icarus is not installed")
REFERENCE, BITS = np.divmod(np.arange(1 << 12), 1 << 6)
INPUTS = {"bits": codes_to_bits(BITS, 6), "reference_bits": codes_to_bits(REFERENCE, 6)}
COUNTS = codes_to_bits(6 - np.bitwise_count(BITS ^ REFERENCE), 3)


def matcher(latency: int = 0) -> Circuit:
    """A matcher of six bits, its count perhaps delayed."""
    bits, reference = Port("bits", 6), Port("reference_bits", 6)
    match, late = (
        Match("same", bits.word, reference.word),
        Register("late", (Slice("same", 0, 3),), latency or 1),
    )
    if latency:
        return Circuit(
            "match", "M.", (bits, reference), (match, late), {"match_count": (Slice("late", 0, 3),)}
        )
    return Circuit("match", "M.", (bits, reference), (match,), {"match_count": (Slice("same", 0, 3),)})


def bench(folder: Path, counts: Bits = COUNTS, *, design: str = "", latency: int = 0) -> list[Path]:
    part = component(matcher(latency), style="cells")
    files = [folder / "match.v", folder / "my_match_tb.v"]
    files[0].write_text(design or verilog(part, prefix="my_", header=[]))
    files[1].write_text(
        write_testbench(
            part, name="my_match", count=len(counts), vectors_file="match.hex", sources=["match.v"]
        )
    )
    (folder / "match.hex").write_text(vectors(part, INPUTS, {"match_count": counts}))
    return files


def test_vectors_put_the_ports_side_by_side() -> None:
    two = {"bits": codes_to_bits([0b000001, 0], 6), "reference_bits": codes_to_bits([0b100000, 0], 6)}
    text = vectors(component(matcher(), style="cells"), two, {"match_count": codes_to_bits([4, 6], 3)})
    assert text == f"{0b000001_100000_100:04x}\n0006\n"


@needs_simulator
@pytest.mark.simulator
@pytest.mark.parametrize("latency", [0, 1, 3])
def test_a_right_circuit_passes(tmp_path: Path, latency: int) -> None:
    files = bench(tmp_path, latency=latency)
    assert lint_icarus(files, "my_match_tb", timeout=60) == []
    assert lint_verilator(files, "my_match_tb", timeout=60) == []
    assert (
        run_icarus(files, "my_match_tb", cwd=tmp_path, timeout=60).output == "PASS: my_match, 4096 vectors\n"
    )


@needs_simulator
@pytest.mark.simulator
@pytest.mark.parametrize("latency", [0, 2])
@pytest.mark.parametrize("vector", [0, 100, 4095])
def test_a_wrong_answer_is_shown_and_ends_with_a_status(tmp_path: Path, vector: int, latency: int) -> None:
    wrong = COUNTS.copy()
    wrong[vector] = True
    with pytest.raises(ToolError) as caught:
        run_icarus(bench(tmp_path, wrong, latency=latency), "my_match_tb", cwd=tmp_path, timeout=60)
    assert f"FAIL: my_match, vector {vector} of 4096" in caught.value.output
    if vector == 100:
        shown = "  bits = 24\n  reference_bits = 01\n  match_count = 3, expected 7\n"
        assert shown in caught.value.output


@needs_simulator
@pytest.mark.simulator
def test_a_circuit_that_is_a_cycle_late_fails(tmp_path: Path) -> None:
    files = bench(tmp_path, latency=1)
    files[0].write_text(verilog(component(matcher(2), style="cells"), prefix="my_", header=[]))
    with pytest.raises(ToolError) as caught:
        run_icarus(files, "my_match_tb", cwd=tmp_path, timeout=60)
    assert "FAIL: my_match, vector 0 of 4096" in caught.value.output


@needs_simulator
@pytest.mark.simulator
def test_an_unknown_output_fails(tmp_path: Path) -> None:
    ports = "input [5:0] bits, input [5:0] reference_bits, output [2:0] match_count"
    nothing = f"module my_match ({ports});\nendmodule\n"
    with pytest.raises(ToolError) as caught:
        run_icarus(bench(tmp_path, design=nothing), "my_match_tb", cwd=tmp_path, timeout=60)
    assert "match_count = z" in caught.value.output


@needs_simulator
@pytest.mark.simulator
@pytest.mark.parametrize("latency", [0, 2])
def test_missing_vectors_fail(tmp_path: Path, latency: int) -> None:
    files = bench(tmp_path, latency=latency)
    (tmp_path / "match.hex").unlink()
    with pytest.raises(ToolError) as caught:
        run_icarus(files, "my_match_tb", cwd=tmp_path, timeout=60)
    assert "FAIL: my_match, vector 0" in caught.value.output


@pytest.mark.slow
@pytest.mark.simulator
@needs_simulator
@pytest.mark.skipif(shutil.which("g++") is None, reason="no C++ compiler")
@pytest.mark.parametrize("latency", [0, 2])
def test_it_runs_in_verilator_too(tmp_path: Path, latency: int) -> None:
    files = bench(tmp_path, latency=latency)
    assert (
        "PASS: my_match, 4096 vectors"
        in run_verilator(files, "my_match_tb", cwd=tmp_path, timeout=300).output
    )
