"""What a voting network costs, counted by the project's own flow."""

from collections.abc import Callable

from wnn2hdl.elaborate import component
from wnn2hdl.emit import verilog
from wnn2hdl.errors import InputError
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.models import LutGroupModel
from wnn2hdl.ir.nodes import ArgMax, Sum
from wnn2hdl.ir.wires import Port, Slice
from wnn2hdl.lower.structural import network
from wnn2hdl.minimise.circuit import minimise
from wnn2hdl.synth import synthesise


def network_luts(model: LutGroupModel) -> int:
    """LUTs of the whole circuit, encoder and winner included, as `compile` makes and counts it.

    Raises:
        ToolError: Yosys is missing or failed.
    """
    return _luts(minimise(network(model), 1, lambda *_: None).circuit)


def decision_luts(classes: int, nodes_per_class: int) -> int:
    """LUTs that add up the votes of all classes and find the winner."""
    bits = Port("bits", classes * nodes_per_class)
    sums = [
        Sum(
            f"votes_{owner}",
            tuple(Slice("bits", owner * nodes_per_class + i) for i in range(nodes_per_class)),
        )
        for owner in range(classes)
    ]
    words = tuple((Slice(votes.name, 0, votes.drives[votes.name]),) for votes in sums)
    winner = ArgMax("winner", words, "first")
    answer = (Slice(winner.name, 0, winner.drives[winner.name]),)
    return _luts(Circuit("decision", "Votes and winner.", (bits,), (*sums, winner), {"class_bits": answer}))


def affordable_nodes(max_luts: int, classes: int) -> int:
    """The most nodes per class that fit with their votes and the winner, were the encoder free.

    Raises:
        InputError: not even one node per class fits.
    """
    nodes = most_that_fit(
        max(1, max_luts // classes), lambda n: classes * n + decision_luts(classes, n) <= max_luts
    )
    if nodes == 0:
        raise InputError(
            f"no network of {classes} classes fits",
            value=f"{max_luts} LUTs",
            hint=f"allow at least {classes + decision_luts(classes, 1)}",
        )
    return nodes


def most_that_fit(most: int, fits: Callable[[int], bool]) -> int:
    """The largest number from 1 to ``most`` that fits, where all smaller ones fit, too; 0 if none does."""
    low, high = 0, most
    while low < high:
        middle = (low + high + 1) // 2
        if fits(middle):
            low = middle
        else:
            high = middle - 1
    return low


def _luts(circuit: Circuit) -> int:
    prefix = "counted_"
    text = verilog(component(circuit, style="cells"), prefix=prefix, header=())
    return synthesise(text, prefix + circuit.name).resources.luts
