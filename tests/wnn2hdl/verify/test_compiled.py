"""Compiled simulation: port packing, every sample answered, undefined values refused."""

from collections.abc import Mapping
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from wnn2hdl.errors import CheckError
from wnn2hdl.ir import codes_to_bits
from wnn2hdl.verify.compiled import CompiledSimulator, run_compiled
from wnn2hdl.verify.specification import Claim


def claim(inputs: Mapping[str, int], outputs: Mapping[str, int]) -> Claim:
    """A claim of these ports about no model in particular."""
    return Claim("echo", inputs, outputs, "none", lambda samples: dict(samples), None)


@pytest.mark.simulator
@pytest.mark.parametrize("simulator", ["icarus", pytest.param("verilator", marks=pytest.mark.slow)])
def test_every_window_gets_the_models_answer(
    circuits: ModuleType, tmp_path: Path, simulator: CompiledSimulator
) -> None:
    block = circuits.random_block(3, classes=3)
    path = tmp_path / "block.v"
    path.write_text(circuits.emitted(block, "block_match"), encoding="utf-8")
    rng = np.random.default_rng(0)
    inputs = {"window": rng.random((1000, 216)) < 0.5, "reference_bits": rng.random((1000, 9)) < 0.5}
    claimed = circuits.specification(block).claims["block_match"]
    outputs, _ = run_compiled(claimed, "block_match", [path], inputs, simulator)
    for port, expected in claimed.answers(inputs).items():
        assert np.array_equal(outputs[port], expected)


@pytest.mark.simulator
def test_ports_of_any_width_come_back_as_they_went_in(tmp_path: Path) -> None:
    path = tmp_path / "echo.v"
    path.write_text(
        "module echo(input [16:0] a, input b, output [16:0] c, output d);\n"
        "  assign c = a;\n  assign d = b;\nendmodule\n",
        encoding="utf-8",
    )
    ports = claim({"a": 17, "b": 1}, {"c": 17, "d": 1})
    values = np.random.default_rng(0).random((100, 17)) < 0.5
    outputs, _ = run_compiled(ports, "echo", [path], {"a": values, "b": values[:, :1]}, "icarus")
    assert np.array_equal(outputs["c"], values)
    assert np.array_equal(outputs["d"], values[:, :1])


@pytest.mark.simulator
def test_an_undefined_output_is_an_error(tmp_path: Path) -> None:
    path = tmp_path / "half.v"
    path.write_text(
        "module half(input a, output [3:0] c);\n  assign c = a ? 4'b1x10 : 4'd3;\nendmodule\n",
        encoding="utf-8",
    )
    ports = claim({"a": 1}, {"c": 4})
    with pytest.raises(CheckError, match=r"undefined in icarus: sample 2"):
        run_compiled(ports, "half", [path], {"a": codes_to_bits(np.array([0, 0, 1]), 1)}, "icarus")
