"""Compiled simulation: port packing, every sample answered, undefined values refused."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from wnn2hdl.errors import CheckError
from wnn2hdl.verify.compiled import CompiledSimulator, run_compiled
from wnn2hdl.verify.specification import Part, Samples


@pytest.mark.simulator
@pytest.mark.parametrize("simulator", ["icarus", pytest.param("verilator", marks=pytest.mark.slow)])
def test_every_window_gets_the_models_answer(
    circuits: ModuleType, tmp_path: Path, simulator: CompiledSimulator
) -> None:
    specification = circuits.random_specification(3, classes=3)
    path = tmp_path / "block.v"
    path.write_text(circuits.emitted(specification, "block_match"), encoding="utf-8")
    rng = np.random.default_rng(0)
    inputs: Samples = {
        "window": rng.integers(0, 256, (1000, 9, 3), dtype=np.uint8),
        "reference": rng.integers(0, 512, 1000),
    }
    outputs, _ = run_compiled(specification.part("block_match"), [path], inputs, simulator)
    for port, expected in specification.evaluate("block_match", inputs).items():
        assert np.array_equal(outputs[port], expected)


@pytest.mark.simulator
def test_ports_of_any_width_come_back_as_they_went_in(tmp_path: Path) -> None:
    path = tmp_path / "echo.v"
    path.write_text(
        "module echo(input [16:0] a, input b, output [16:0] c, output d);\n"
        "  assign c = a;\n  assign d = b;\nendmodule\n",
        encoding="utf-8",
    )
    part = Part("echo", {"a": 17, "b": 1}, {"c": 17, "d": 1})
    values = np.random.default_rng(0).integers(0, 1 << 17, 100)
    outputs, _ = run_compiled(part, [path], {"a": values, "b": values & 1}, "icarus")
    assert np.array_equal(outputs["c"], values)
    assert np.array_equal(outputs["d"], values & 1)


@pytest.mark.simulator
def test_an_undefined_output_is_an_error(tmp_path: Path) -> None:
    path = tmp_path / "half.v"
    path.write_text(
        "module half(input a, output [3:0] c);\n  assign c = a ? 4'b1x10 : 4'd3;\nendmodule\n",
        encoding="utf-8",
    )
    part = Part("half", {"a": 1}, {"c": 4})
    with pytest.raises(CheckError, match=r"undefined in icarus: sample 2"):
        run_compiled(part, [path], {"a": np.array([0, 0, 1])}, "icarus")
