"""The minimising pass: every truth table, and every network of gates, becomes a network of LUTs."""

from collections.abc import Callable
from dataclasses import dataclass, replace

from wnn2hdl.ir import LUT_INPUTS, LutNetwork, TruthTable
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.models import LogicModel
from wnn2hdl.ir.nodes import Table
from wnn2hdl.minimise.espresso import Minimised, espresso
from wnn2hdl.minimise.gates import map_gates
from wnn2hdl.minimise.portfolio import map_luts
from wnn2hdl.progress import Progress, reported
from wnn2hdl.tools import in_parallel


@dataclass(frozen=True)
class MinimisedTable:
    """What a table becomes.

    Attributes:
        cover: its two-level cover.
        network: its LUTs.
        method: how the network was found.
    """

    cover: Minimised
    network: LutNetwork
    method: str


@dataclass(frozen=True, eq=False)
class MinimisedCircuit:
    """A circuit whose tables are mapped to LUTs.

    Attributes:
        circuit: the circuit.
        covers: the two-level cover of each truth table, by the names of `Circuit.tables`.
        methods: how each network was found, by the same names.
    """

    circuit: Circuit
    covers: dict[str, Minimised]
    methods: dict[str, str]


def minimise_table(table: TruthTable, effort: int, lut_inputs: int = LUT_INPUTS) -> MinimisedTable:
    """Minimise one table to LUTs of so many inputs.

    Raises:
        CheckError: the result differs from the table on a cared-for code.
    """
    mapping = map_luts(table, effort=effort, lut_inputs=lut_inputs)
    return MinimisedTable(espresso(table), mapping.network, mapping.method)


def minimise(
    circuit: Circuit,
    effort: int,
    progress: Progress,
    by: Callable[[TruthTable, int], MinimisedTable] = minimise_table,
) -> MinimisedCircuit:
    """Minimise the tables of a circuit side by side; what they give on cared-for inputs stays as it is.

    Args:
        circuit: its tables are truth tables, or gates, which are mapped and not checked.
        effort: 0 to 3, how much work is put into each table.
        progress: reports each table.
        by: what minimises a table, given the effort.

    Raises:
        CheckError: a minimised table differs from its truth table.
    """
    tables = circuit.tables()
    functions = {
        name: table.function for name, table in tables.items() if isinstance(table.function, TruthTable)
    }
    names = list(functions)
    results = in_parallel(lambda function: by(function, effort), functions.values())
    found = {
        names[position]: minimised
        for position, minimised in reported(results, "minimising tables", len(names), progress)
    }
    covers = {name: found[name].cover for name in names}
    methods = {name: found[name].method for name in names}
    mapped = {id(tables[name]): replace(tables[name], function=found[name].network) for name in names}
    for name, table in tables.items():
        if isinstance(table.function, LogicModel):
            network, methods[name] = map_gates(table.function, effort, progress)
            mapped[id(table)] = replace(table, function=network)

    def change(definition: Circuit) -> Circuit:
        nodes = (mapped.get(id(node), node) if isinstance(node, Table) else node for node in definition.nodes)
        return replace(definition, nodes=tuple(nodes))

    return MinimisedCircuit(circuit.rebuilt(change), covers, methods)
