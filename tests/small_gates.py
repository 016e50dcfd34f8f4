"""Gate networks for tests of lowering, mapping, proof and builds."""

import numpy as np
from hypothesis import strategies as st

from benchmarks.gates import network
from wnn2hdl.importers.gates import GateBuilder
from wnn2hdl.ir.models import LogicModel


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
