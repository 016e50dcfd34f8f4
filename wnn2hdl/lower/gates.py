"""Gate networks as circuits: one function between a port of all inputs and a port of all outputs."""

from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.models import LogicModel
from wnn2hdl.ir.nodes import Table
from wnn2hdl.ir.wires import Port, Slice

NETWORK = "network"
INPUTS, OUTPUTS = "inputs", "outputs"


def network(model: LogicModel) -> Circuit:
    """``inputs`` to ``outputs``; bit ``i`` of each is the model's input or output ``i``."""
    inputs = Port(INPUTS, model.width)
    return Circuit(
        NETWORK,
        f"Network of {len(model.gates)} gates.",
        (inputs,),
        (Table("gates", inputs.word, model),),
        {OUTPUTS: (Slice("gates", 0, len(model.outputs)),)},
    )
