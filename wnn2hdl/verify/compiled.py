"""Fast simulation of emitted Verilog in Verilator or Icarus: many samples in one run.

A generated testbench reads the samples from a binary file, applies one a time unit and writes the outputs;
the same testbench runs in both simulators. Verilator compiles it to a program first, Icarus interprets it.
"""

import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import CheckError
from wnn2hdl.tools import Completed, run_icarus, run_verilator
from wnn2hdl.verify.specification import Part, Samples

CompiledSimulator = Literal["verilator", "icarus"]

_RUN: dict[CompiledSimulator, Callable[..., Completed]] = {"verilator": run_verilator, "icarus": run_icarus}

_UNKNOWN = 255
_DIGITS = np.full(256, _UNKNOWN, dtype=np.uint8)
_DIGITS[list(b"0123456789abcdef")] = range(16)
_DIGITS[list(b"ABCDEF")] = range(10, 16)


def run_compiled(
    part: Part,
    sources: Sequence[Path],
    inputs: Samples,
    simulator: CompiledSimulator,
    *,
    timeout: float = 600.0,
) -> tuple[Samples, float]:
    """Simulate a combinational circuit.

    Args:
        part: its module and ports.
        sources: its Verilog files.
        inputs: values of each input port.
        simulator: who simulates.
        timeout: seconds for compiling and for running, each.

    Returns:
        int64 ``[samples]`` for each output port, and the seconds of the run itself, without compiling.

    Raises:
        CheckError: an output is undefined (x or z) for a sample.
        ToolError: the simulator is missing, cannot read the sources, failed or ran out of time.
    """
    samples = len(next(iter(inputs.values())))
    with tempfile.TemporaryDirectory(prefix="wnn2hdl-") as name:
        folder = Path(name)
        bench = folder / "drive.v"
        bench.write_text(_testbench(part), encoding="utf-8")
        columns = [_to_bytes(inputs[port], width) for port, width in part.inputs.items()]
        np.concatenate(columns, axis=1).tofile(folder / "inputs.bin")
        seconds = _RUN[simulator]([bench, *sources], "drive", cwd=folder, timeout=timeout).seconds
        text = np.fromfile(folder / "outputs.hex", dtype=np.uint8)
    widths = {port: _digits(width) for port, width in part.outputs.items()}
    if len(text) != samples * sum(widths.values()):
        raise CheckError(f"{simulator} answered for fewer samples than it was given", value=part.module)
    digits = _DIGITS[text].reshape(samples, -1)
    if (digits == _UNKNOWN).any():
        first = int(np.flatnonzero((digits == _UNKNOWN).any(axis=1))[0])
        raise CheckError(f"an output of {part.module} is undefined in {simulator}", value=f"sample {first}")
    outputs: Samples = {}
    start = 0
    for port, width in widths.items():
        weights = 16 ** np.arange(width - 1, -1, -1, dtype=np.int64)
        outputs[port] = digits[:, start : start + width].astype(np.int64) @ weights
        start += width
    return outputs, seconds


def _testbench(part: Part) -> str:
    total = sum(8 * _bytes(width) for width in part.inputs.values())
    connections, low = [], total
    for port, width in part.inputs.items():
        low -= 8 * _bytes(width)
        connections.append(f".{port}(sample[{low + width - 1}:{low}])")
    answer, wires = [], []
    for port, width in part.outputs.items():
        wires.append(f"  wire [{width - 1}:0] {port};")
        connections.append(f".{port}({port})")
        padding = 4 * _digits(width) - width
        answer.append(f"{padding}'d0, {port}" if padding else port)
    return "\n".join(
        [
            "`timescale 1ns / 1ns",
            "module drive;",
            f"  reg [{total - 1}:0] sample;",
            *wires,
            "  integer source, sink, count;",
            f"  {part.module} circuit ({', '.join(connections)});",
            "  initial begin",
            '    source = $fopen("inputs.bin", "rb");',
            '    sink = $fopen("outputs.hex", "wb");',
            "    count = $fread(sample, source);",
            f"    while (count == {total // 8}) begin",
            f'      #1 $fwrite(sink, "%h", {{{", ".join(answer)}}});',
            "      count = $fread(sample, source);",
            "    end",
            "    $fclose(sink);",
            "    $finish;",
            "  end",
            "endmodule",
            "",
        ]
    )


def _to_bytes(values: NDArray[np.int64] | NDArray[np.uint8], width: int) -> NDArray[np.uint8]:
    """Values as big-endian bytes, uint8 ``[samples, bytes]``: the order in which ``$fread`` fills a word."""
    if values.ndim > 1:
        # Pixels: the last one is the most significant, and red is the high byte of each.
        return values.reshape(len(values), -1, 3)[:, ::-1].reshape(len(values), -1).astype(np.uint8)
    return values.astype(">u8").view(np.uint8).reshape(-1, 8)[:, 8 - _bytes(width) :]


def _bytes(width: int) -> int:
    return -(-width // 8)


def _digits(width: int) -> int:
    return -(-width // 4)
