"""Fast simulation of emitted Verilog in Verilator or Icarus: many samples in one run.

A generated testbench reads the samples from a binary file, applies one per time unit, or per cycle of a
pipeline's clock, and writes the outputs; the same testbench runs in both simulators. Verilator compiles it to
a program first, Icarus interprets it.
"""

import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import CheckError
from wnn2hdl.ir.wires import Bits
from wnn2hdl.tools import Completed, run_icarus, run_verilator
from wnn2hdl.verify.equivalence import CLOCK
from wnn2hdl.verify.specification import Claim, Samples

CompiledSimulator = Literal["verilator", "icarus"]

RUN: dict[CompiledSimulator, Callable[..., Completed]] = {"verilator": run_verilator, "icarus": run_icarus}

_UNKNOWN = 255
_DIGITS = np.full(256, _UNKNOWN, dtype=np.uint8)
_DIGITS[list(b"0123456789abcdef")] = range(16)
_DIGITS[list(b"ABCDEF")] = range(10, 16)


def run_compiled(
    claim: Claim,
    module: str,
    sources: Sequence[Path],
    inputs: Samples,
    simulator: CompiledSimulator,
    *,
    latency: int = 0,
    timeout: float = 600.0,
) -> tuple[dict[str, Bits], float]:
    """Simulate a circuit.

    Args:
        claim: its ports.
        module: its module.
        sources: its Verilog files.
        inputs: values of each input port.
        simulator: who simulates.
        latency: clock cycles from inputs to outputs; 0 of a combinational circuit.
        timeout: seconds for compiling and for running, each.

    Returns:
        bool ``[samples, width]`` for each output port, and the seconds of the run itself, without compiling.

    Raises:
        CheckError: an output is undefined (x or z) for a sample.
        ToolError: the simulator is missing, cannot read the sources, failed or ran out of time.
    """
    samples = len(next(iter(inputs.values())))
    with tempfile.TemporaryDirectory(prefix="wnn2hdl-") as name:
        folder = Path(name)
        bench = folder / "drive.v"
        bench.write_text(_testbench(claim, module, latency), encoding="utf-8")
        columns = [_to_bytes(inputs[port]) for port in claim.inputs]
        np.concatenate(columns, axis=1).tofile(folder / "inputs.bin")
        seconds = RUN[simulator]([bench, *sources], "drive", cwd=folder, timeout=timeout).seconds
        text = np.fromfile(folder / "outputs.hex", dtype=np.uint8)
    widths = {port: _digits(width) for port, width in claim.outputs.items()}
    if len(text) != samples * sum(widths.values()):
        raise CheckError(f"{simulator} answered for fewer samples than it was given", value=module)
    digits = _DIGITS[text].reshape(samples, -1)
    if (digits == _UNKNOWN).any():
        first = int(np.flatnonzero((digits == _UNKNOWN).any(axis=1))[0])
        raise CheckError(f"an output of {module} is undefined in {simulator}", value=f"sample {first}")
    outputs: dict[str, Bits] = {}
    start = 0
    for port, width in claim.outputs.items():
        # Digits come the most significant first.
        nibbles = digits[:, start : start + widths[port]][:, ::-1]
        bits = np.unpackbits(nibbles[..., np.newaxis], axis=2, count=4, bitorder="little")
        outputs[port] = bits.reshape(samples, -1)[:, :width].astype(np.bool_)
        start += widths[port]
    return outputs, seconds


def _testbench(claim: Claim, module: str, latency: int) -> str:
    clock = f"#1 {CLOCK} = 1'b1; #1 {CLOCK} = 1'b0;" if latency else ""
    connections = [f".{CLOCK}({CLOCK})"] if latency else []
    total = sum(8 * _bytes(width) for width in claim.inputs.values())
    low = total
    for port, width in claim.inputs.items():
        low -= 8 * _bytes(width)
        connections.append(f".{port}(sample[{low + width - 1}:{low}])")
    answer, wires = [], []
    for port, width in claim.outputs.items():
        wires.append(f"  wire [{width - 1}:0] {port};")
        connections.append(f".{port}({port})")
        padding = 4 * _digits(width) - width
        answer.append(f"{padding}'d0, {port}" if padding else port)
    write = f'if (cycle >= {latency}) $fwrite(sink, "%h", {{{", ".join(answer)}}});'
    return "\n".join(
        [
            "`timescale 1ns / 1ns",
            "module drive;",
            f"  reg [{total - 1}:0] sample;",
            *wires,
            f"  reg {CLOCK} = 1'b0;",
            "  integer source, sink, count, cycle;",
            f"  {module} circuit ({', '.join(connections)});",
            "  initial begin",
            '    source = $fopen("inputs.bin", "rb");',
            '    sink = $fopen("outputs.hex", "wb");',
            "    count = $fread(sample, source);",
            f"    for (cycle = 0; count == {total // 8}; cycle = cycle + 1) begin",
            f"      #1 {write} {clock}",
            "      count = $fread(sample, source);",
            "    end",
            # What is still on its way.
            f"    repeat ({latency}) begin",
            f"      #1 {write} {clock}",
            "      cycle = cycle + 1;",
            "    end",
            "    $fclose(sink);",
            "    $finish;",
            "  end",
            "endmodule",
            "",
        ]
    )


def _to_bytes(bits: Bits) -> NDArray[np.uint8]:
    """Values as big-endian bytes, uint8 ``[samples, bytes]``: the order in which ``$fread`` fills a word."""
    return np.packbits(bits, axis=1, bitorder="little")[:, ::-1]


def _bytes(width: int) -> int:
    return -(-width // 8)


def _digits(width: int) -> int:
    return -(-width // 4)
