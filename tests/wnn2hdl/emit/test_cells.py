"""The models of the vendor's cells equal those that Yosys has."""

import shutil
from pathlib import Path

import pytest

from wnn2hdl.emit import CELLS_FILE, cells_model
from wnn2hdl.tools import find_yosys, lint_icarus, lint_verilator

CELLS = [*(f"LUT{inputs}" for inputs in range(1, 7)), "LUT6_2", "MUXF7", "MUXF8"]


def instance(cell: str, name: str) -> str:
    """A module around a cell; a LUT's contents are a mixture of bits."""
    outputs = ["O5", "O6"] if cell == "LUT6_2" else ["O"]
    if cell.startswith("MUX"):
        ports, contents = ["I0", "I1", "S"], ""
    else:
        inputs = int(cell[3])
        ports = [f"I{i}" for i in range(inputs)]
        contents = f"#(.INIT({1 << inputs}'h{0x9E3779B97F4A7C15 % (1 << (1 << inputs)):x})) "
    pins = ", ".join(f".{port}({port})" for port in (*ports, *outputs))
    head = f"module {name}(input {', '.join(ports)}, output {', '.join(outputs)});"
    return f"{head}\n{cell} {contents}cell_({pins});\nendmodule\n"


@pytest.mark.parametrize("cell", CELLS)
def test_a_model_is_proved_equal_to_that_of_yosys(cell: str, tmp_path: Path) -> None:
    (tmp_path / CELLS_FILE).write_text(cells_model())
    (tmp_path / "ours.v").write_text(instance(cell, "ours"))
    (tmp_path / "theirs.v").write_text(instance(cell, "theirs"))
    script = f"""
        read_verilog {CELLS_FILE} ours.v
        hierarchy -top ours
        proc; flatten; opt_clean
        design -stash ours
        read_verilog +/xilinx/cells_sim.v theirs.v
        hierarchy -top theirs
        proc; flatten; opt_clean
        design -copy-from ours ours
        miter -equiv -flatten ours theirs miter
        sat -verify -prove trigger 0 miter
    """
    find_yosys().run(script, timeout=60, cwd=tmp_path)


@pytest.mark.simulator
@pytest.mark.skipif(shutil.which("iverilog") is None, reason="Icarus is not installed")
@pytest.mark.parametrize("cell", CELLS)
def test_the_models_are_clean(cell: str, tmp_path: Path) -> None:
    sources = [tmp_path / CELLS_FILE, tmp_path / "top.v"]
    sources[0].write_text(cells_model())
    sources[1].write_text(instance(cell, "top"))
    assert lint_icarus(sources, "top", timeout=60) == []
    assert lint_verilator(sources, "top", timeout=60) == []
