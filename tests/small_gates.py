"""Gate networks for tests of lowering, mapping, proof and builds."""

import numpy as np
from hypothesis import strategies as st

from wnn2hdl.importers.gates import GateBuilder
from wnn2hdl.ir.models import LogicModel


def network(builder: GateBuilder, inputs: int, literals: list[int]) -> LogicModel:
    """A model with the inputs ``i0`` … and the outputs ``o0`` … ."""
    return LogicModel(
        tuple(f"i{place}" for place in range(inputs)),
        tuple(f"o{place}" for place in range(len(literals))),
        builder.array(),
        np.array(literals, dtype=np.uint32),
    )


def multiplier(bits: int) -> LogicModel:
    """Two numbers of so many bits, the first in the low inputs, to their product: rows of full adders."""
    builder = GateBuilder(2 * bits)
    first, second = ([2 * (1 + bits * side + place) for place in range(bits)] for side in range(2))
    product: list[int] = []
    row = [builder.both(first[0], y) for y in second] + [0]
    for x in first[1:]:
        product.append(row[0])
        carry, added = 0, []
        for a, y in zip(row[1:], second, strict=True):
            total, carry = _full_adder(builder, a, builder.both(x, y), carry)
            added.append(total)
        row = [*added, carry]
    return network(builder, 2 * bits, product + row)


def _full_adder(builder: GateBuilder, a: int, b: int, carry: int) -> tuple[int, int]:
    half = _xor(builder, a, b)
    return _xor(builder, half, carry), builder.any([builder.both(a, b), builder.both(half, carry)])


def _xor(builder: GateBuilder, a: int, b: int) -> int:
    return builder.any([builder.both(a, b ^ 1), builder.both(a ^ 1, b)])


@st.composite
def gate_networks(draw: st.DrawFn) -> LogicModel:
    """Networks of up to 8 inputs and 40 gates; outputs may be constants, inputs, inverted or the same."""
    inputs = draw(st.integers(1, 8))
    builder = GateBuilder(inputs)
    for _ in range(draw(st.integers(0, 40))):
        literals = st.integers(0, 2 * (inputs + len(builder.gates)) + 1)
        builder.both(draw(literals), draw(literals))
    literals = st.integers(0, 2 * (inputs + len(builder.gates)) + 1)
    return network(builder, inputs, draw(st.lists(literals, min_size=1, max_size=6)))


def all_inputs(model: LogicModel) -> np.ndarray[tuple[int, int], np.dtype[np.bool_]]:
    """Every combination of inputs: bool ``[2**width, width]``."""
    codes = np.arange(1 << model.width)[:, np.newaxis]
    return (codes >> np.arange(model.width) & 1).astype(np.bool_)
