"""Circuits to be made pipelines of."""

import pytest

from wnn2hdl.ir import Lut, LutNetwork
from wnn2hdl.ir.circuit import Circuit, Instance
from wnn2hdl.ir.nodes import Sum, Table
from wnn2hdl.ir.wires import Port, Slice

XOR = 0x6


def chain(levels: int) -> Circuit:
    """A parity of ``levels + 1`` bits in so many LUTs, one behind the other."""
    names = tuple(f"i{place}" for place in range(levels + 1))
    cells = [Lut("t0", names[:2], XOR)]
    cells += [Lut(f"t{i}", (f"t{i - 1}", names[i + 1]), XOR) for i in range(1, levels)]
    network = LutNetwork(names, tuple(cells), (("odd", f"t{levels - 1}"),))
    bits = Port("bits", levels + 1)
    table = Table("parity", bits.word, network)
    return Circuit("chain", "A chain.", (bits,), (table,), {"odd": (Slice("parity"),)})


@pytest.fixture
def nine() -> Circuit:
    """Nine instances of a chain of three LUTs, and how many of them are set."""
    inner = chain(3)
    window = Port("window", 36)
    instances = [Instance(f"pixel_{i}", inner, {"bits": (Slice("window", 4 * i, 4),)}) for i in range(9)]
    total = Sum("total", tuple(Slice(f"pixel_{i}.odd") for i in range(9)))
    drivers = {"bits": total.word, "ones": (Slice("total", 0, 4),)}
    return Circuit("nine", "Nine chains.", (window,), (*instances, total), drivers)
