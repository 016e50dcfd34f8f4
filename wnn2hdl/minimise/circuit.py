"""The minimising pass: every truth table of a circuit becomes a network of LUTs."""

from dataclasses import dataclass, replace

from wnn2hdl.ir import TruthTable
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.nodes import Table
from wnn2hdl.minimise.espresso import Minimised, espresso
from wnn2hdl.minimise.portfolio import map_luts
from wnn2hdl.progress import Progress, reported


@dataclass(frozen=True, eq=False)
class MinimisedCircuit:
    """A circuit whose tables are mapped to LUTs.

    Attributes:
        circuit: the circuit.
        covers: the two-level cover of each table, by the names of `Circuit.tables`.
        methods: how each network was found, by the same names.
    """

    circuit: Circuit
    covers: dict[str, Minimised]
    methods: dict[str, str]


def minimise(circuit: Circuit, effort: int, progress: Progress) -> MinimisedCircuit:
    """Minimise the tables of a circuit; what they give on cared-for inputs stays as it is.

    Args:
        circuit: its tables are truth tables.
        effort: 0 to 3, how much work is put into each table.
        progress: reports each table.

    Raises:
        CheckError: a minimised table differs from its truth table.
    """
    covers: dict[str, Minimised] = {}
    methods: dict[str, str] = {}
    mapped: dict[int, Table] = {}
    tables = circuit.tables()
    for name, table in reported(tables.items(), "minimising tables", len(tables), progress):
        if not isinstance(table.function, TruthTable):
            continue
        covers[name] = espresso(table.function)
        mapping = map_luts(table.function, effort=effort)
        methods[name] = mapping.method
        mapped[id(table)] = replace(table, function=mapping.network)

    def change(definition: Circuit) -> Circuit:
        nodes = (mapped.get(id(node), node) if isinstance(node, Table) else node for node in definition.nodes)
        return replace(definition, nodes=tuple(nodes))

    return MinimisedCircuit(circuit.rebuilt(change), covers, methods)
