"""How many LUTs a circuit may take, said before tables are minimised."""

import math

import numpy as np

from wnn2hdl.ir import LUT_INPUTS, LutNetwork
from wnn2hdl.ir.circuit import Circuit, Instance, Node
from wnn2hdl.ir.models import LogicModel
from wnn2hdl.ir.nodes import Sum, Table

_SPARSE = 20
"""Fitted to 24 Bloom filters of 10 to 20 inputs: codes times inputs beyond a LUT's, for each LUT."""


def table_luts(inputs: int, fewer: int) -> int:
    """About how many LUTs a table of one output takes.

    Args:
        inputs: that it reads.
        fewer: codes that are on, or those that are off, whichever are fewer.
    """
    if inputs <= LUT_INPUTS or not fewer:
        return int(inputs > 1 and fewer > 0)
    # Four LUTs of six inputs become one of eight by dedicated multiplexers; a LUT joins four of these.
    leaves = 1 << inputs - LUT_INPUTS
    tree = leaves + math.ceil((leaves // 4 - 1) / 3)
    return max(2, min(tree, math.ceil(fewer * (inputs - LUT_INPUTS) / _SPARSE)))


def xor_luts(inputs: int) -> int:
    """LUTs of an exclusive or."""
    return max(0, math.ceil((inputs - 1) / (LUT_INPUTS - 1)))


def estimated_luts(circuit: Circuit) -> int:
    """About how many LUTs the tables and sums of a circuit take; what else it has counts nothing."""
    made: dict[str, int] = {}
    for name, definition in circuit.definitions().items():
        made[name] = sum(
            made[node.circuit.name] if isinstance(node, Instance) else _node_luts(node)
            for node in definition.nodes
        )
    return made[circuit.name]


def _node_luts(node: Node) -> int:
    if isinstance(node, Sum):
        # A full adder takes one LUT, and takes one bit away from the many.
        return len(node.weights)
    if not isinstance(node, Table):
        return 0
    table = node.function
    if isinstance(table, LogicModel):
        return 0  # gates are quick to map, and counted then
    if isinstance(table, LutNetwork):
        return len(table.luts)
    total = 0
    for column in table.values.T:
        on = int(np.count_nonzero(column & table.care))
        total += table_luts(len(table.inputs), min(on, int(table.care.sum()) - on))
    return total
