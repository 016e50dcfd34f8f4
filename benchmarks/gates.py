"""Gate networks against plain synthesis of the same gates, and at scale.

``python benchmarks/gates.py [--effort 0…3] [--largest GATES]`` compiles generated networks of gates whole,
each in a process of its own: multipliers, and layers of random gates with sums behind them, as networks of
logic gates have. Beside each stand the LUTs that the same run of `synth_xilinx` needs for the gates as they
are, one ``assign`` each, then wall clock, CPU seconds (user time) and the most memory, children included.
"""

import argparse
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from benchmarks.compiling import compile_apart
from wnn2hdl.importers.gates import GateBuilder
from wnn2hdl.ir.models import LogicModel
from wnn2hdl.markdown import head, row
from wnn2hdl.synth import synthesise

TOP = "plain"


def _exclusive_or(gates: GateBuilder, left: int, right: int) -> int:
    return gates.any([gates.both(left, right ^ 1), gates.both(left ^ 1, right)])


def _full_adder(gates: GateBuilder, x: int, y: int, z: int) -> tuple[int, int]:
    """Sum and carry of three literals."""
    half = _exclusive_or(gates, x, y)
    return _exclusive_or(gates, half, z), gates.any([gates.both(x, y), gates.both(half, z)])


def network(gates: GateBuilder, width: int, outputs: list[int]) -> LogicModel:
    """A model with the inputs ``i0`` … and the outputs ``o0`` … ."""
    inputs = tuple(f"i{place}" for place in range(width))
    names = tuple(f"o{place}" for place in range(len(outputs)))
    return LogicModel(inputs, names, gates.array(), np.array(outputs, dtype=np.uint32))


def multiplier(bits: int) -> LogicModel:
    """Two numbers of so many bits, the first in the low inputs, to their product: rows of full adders."""
    gates = GateBuilder(2 * bits)
    left, right = ([2 * (1 + start + place) for place in range(bits)] for start in (0, bits))
    total = [*(gates.both(left[0], bit) for bit in right), 0]
    outputs: list[int] = []
    for bit in left[1:]:
        outputs.append(total[0])
        carry, following = 0, []
        for above, other in zip(total[1:], right, strict=True):
            value, carry = _full_adder(gates, above, gates.both(bit, other), carry)
            following.append(value)
        total = [*following, carry]
    return network(gates, 2 * bits, outputs + total)


def layers(inputs: int, width: int, depth: int, classes: int) -> LogicModel:
    """Layers of random gates of two inputs; for each class, how many gates of the last layer are set."""
    rng = np.random.default_rng(0)
    gates = GateBuilder(inputs)
    signals = [2 * (1 + place) for place in range(inputs)]
    for _ in range(depth):
        pairs = rng.integers(0, len(signals), (width, 2)).tolist()
        kinds = rng.integers(0, 16, width).tolist()
        chosen = zip(pairs, kinds, strict=True)
        signals = [_gate(gates, signals[x], signals[y], kind) for (x, y), kind in chosen]
    outputs = [bit for group in range(classes) for bit in _count(gates, signals[group::classes])]
    return network(gates, inputs, outputs)


def _gate(gates: GateBuilder, x: int, y: int, kind: int) -> int:
    """A quarter of the kinds are exclusive ors, the others ands of inputs that may be inverted."""
    if kind % 4 == 3:
        return _exclusive_or(gates, x, y) ^ (kind >> 2 & 1)
    return gates.both(x ^ (kind >> 2 & 1), y ^ (kind >> 3 & 1)) ^ (kind & 1)


def _count(gates: GateBuilder, ones: list[int]) -> list[int]:
    """How many literals are true, the least significant bit first."""
    outputs = []
    column = list(ones)
    while column:
        carries = []
        while len(column) > 1:
            x, y = column.pop(0), column.pop(0)
            value, carry = _full_adder(gates, x, y, column.pop(0) if column else 0)
            column.append(value)
            carries.append(carry)
        outputs.append(column[0])
        column = carries
    return outputs


def plain_gates(model: LogicModel) -> str:
    """A module of one ``assign`` for each gate."""
    first = 1 + model.width

    def read(literal: int) -> str:
        variable = literal >> 1
        name = f"inputs[{variable - 1}]" if 0 < variable < first else f"n{variable}" if variable else "1'b0"
        return f"~{name}" if literal & 1 else name

    ports = f"input [{model.width - 1}:0] inputs, output [{len(model.outputs) - 1}:0] outputs"
    lines = [f"module {TOP}({ports});"]
    for own, (left, right) in enumerate(model.gates.tolist(), start=first):
        lines.append(f"  wire n{own} = {read(left)} & {read(right)};")
    lines += [f"  assign outputs[{place}] = {read(x)};" for place, x in enumerate(model.literals.tolist())]
    return "\n".join([*lines, "endmodule", ""])


NETWORKS: dict[str, Callable[[], LogicModel]] = {
    "multiplier of 12 bits": lambda: multiplier(12),
    "layers of 150": lambda: layers(64, 150, 4, 4),
    "multiplier of 36 bits": lambda: multiplier(36),
    "layers of 1,500": lambda: layers(256, 1_500, 4, 10),
    "layers of 14,000": lambda: layers(784, 14_000, 4, 10),
    "layers of 70,000": lambda: layers(784, 70_000, 4, 10),
}


def main() -> None:
    """Print a row for each network."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--effort", type=int, default=1)
    parser.add_argument("--largest", type=int, default=30_000, metavar="GATES")
    given = parser.parse_args()
    print(head(["network", "gates", "LUTs", "plain", "share", "proof", "wall s", "CPU s", "peak MB"]))
    for name, make in NETWORKS.items():
        model = make()
        if len(model.gates) > given.largest:
            continue
        with tempfile.TemporaryDirectory() as place:
            found = compile_apart(model, Path(place), "--effort", str(given.effort))
        plain = synthesise(plain_gates(model), TOP, baseline=True).resources.luts
        share = f"{found.luts / plain:.2f}" if found.luts else ""
        cells = [name, len(model.gates), found.luts, plain, share, found.proof]
        print(row([*cells, round(found.wall), round(found.cpu), round(found.peak / 1e6)]), flush=True)


if __name__ == "__main__":
    main()
