"""Random circuits of every kind of node, and values for their ports: strategies for property tests."""

from collections.abc import Sequence

import numpy as np
from hypothesis import strategies as st

from wnn2hdl.ir import Lut, LutNetwork, Mux, TruthTable
from wnn2hdl.ir.circuit import Circuit, Instance, Node
from wnn2hdl.ir.nodes import ArgMax, Match, Register, Sum, Table, Threshold
from wnn2hdl.ir.wires import Bits, Port, Slice, Word

KINDS = ("table", "threshold", "sum", "match", "argmax", "register", "instance")


def random_inputs(circuit: Circuit, count: int) -> dict[str, Bits]:
    """Random values for each input port; samples of few set bits and of many are among them."""
    rng = np.random.default_rng(count)
    return {port.name: rng.random((count, port.width)) < rng.random((count, 1)) for port in circuit.inputs}


@st.composite
def networks(draw: st.DrawFn, inputs: tuple[str, ...], outputs: tuple[str, ...]) -> LutNetwork:
    """Random LUTs, sometimes with a multiplexer behind the first two."""
    cells: list[Lut | Mux] = []
    signals = list(inputs)
    for i in range(draw(st.integers(2, 6))):
        chosen = draw(st.lists(st.sampled_from(signals), min_size=1, max_size=6, unique=True))
        contents = draw(st.integers(0, (1 << (1 << len(chosen))) - 1))
        cells.append(Lut(f"lut{i}", tuple(chosen), contents))
        signals.append(f"lut{i}")
    if draw(st.booleans()):
        cells.append(Mux("mux0", "lut0", "lut1", draw(st.sampled_from(inputs))))
        signals.append("mux0")
    sources = [draw(st.sampled_from([*signals, "0", "1"])) for _ in outputs]
    return LutNetwork(inputs, tuple(cells), tuple(zip(outputs, sources, strict=True)))


@st.composite
def truth_tables(draw: st.DrawFn, inputs: tuple[str, ...], outputs: tuple[str, ...]) -> TruthTable:
    """Random tables; half of them have don't-cares."""
    rng = np.random.default_rng(draw(st.integers(0, 1000)))
    values = rng.random((1 << len(inputs), len(outputs))) < rng.random()
    return TruthTable(inputs, outputs, values, rng.random(len(values)) < draw(st.sampled_from([0.6, 1.0])))


@st.composite
def circuits(
    draw: st.DrawFn,
    kinds: Sequence[str] = KINDS,
    *,
    mapped: bool = True,
    name: str = "random",
) -> Circuit:
    """A circuit of up to eight nodes.

    Args:
        kinds: the kinds of node that may occur, also in instances; any are in these if no other is given.
        mapped: whether its tables are LUT networks, not truth tables.
        name: its name.
    """
    ports = tuple(Port(f"port{i}", draw(st.integers(1, 7))) for i in range(draw(st.integers(1, 3))))
    # The bits that words can be made of, by the cycle in which they arrive.
    bits = {0: [Slice(port.name, low) for port in ports for low in range(port.width)]}
    nodes: list[Node] = []
    for i in range(draw(st.integers(1, 8))):
        time = draw(st.sampled_from(sorted(bits)))
        node = draw(_nodes(f"node{i}", kinds, bits[time], mapped=mapped))
        nodes.append(node)
        driven = [Slice(net, low) for net, width in node.drives.items() for low in range(width)]
        bits.setdefault(time + node.latency, []).extend(driven)
    time = draw(st.sampled_from(sorted(bits)))
    drivers = {f"out{i}": draw(_words(bits[time])) for i in range(draw(st.integers(1, 3)))}
    return Circuit(name, "A random circuit.", ports, tuple(nodes), drivers)


@st.composite
def _words(draw: st.DrawFn, bits: Sequence[Slice], *, width: int | None = None) -> Word:
    """A few of the bits, in any order, some perhaps more than once; or a whole net's."""
    if width is None and draw(st.booleans()):
        net = draw(st.sampled_from(bits)).net
        return (Slice(net, 0, sum(bit.net == net for bit in bits)),)
    low, high = (1, 7) if width is None else (width, width)
    return tuple(draw(st.lists(st.sampled_from(bits), min_size=low, max_size=high)))


@st.composite
def _nodes(draw: st.DrawFn, name: str, kinds: Sequence[str], bits: Sequence[Slice], *, mapped: bool) -> Node:
    kind = draw(st.sampled_from(kinds))
    if kind == "instance":
        simple = [other for other in kinds if other != "instance"] or KINDS[:-1]
        inner = draw(circuits(simple, mapped=mapped, name=f"inner_{name}"))
        return Instance(
            name, inner, {port.name: draw(_words(bits, width=port.width)) for port in inner.inputs}
        )
    word = draw(_words(bits))
    width = sum(part.width for part in word)
    match kind:
        case "table":
            inputs = tuple(f"in{i}" for i in range(width))
            outputs = tuple(f"y{i}" for i in range(draw(st.integers(1, 3))))
            if mapped:
                return Table(name, word, draw(networks(inputs, outputs)))
            return Table(name, word, draw(truth_tables(inputs, outputs)))
        case "threshold":
            return Threshold(name, word, draw(st.integers(-1, 1 << width)))
        case "sum":
            weights = st.lists(st.integers(1, 9), min_size=width, max_size=width)
            return Sum(name, word, tuple(draw(weights)) if draw(st.booleans()) else ())
        case "match":
            return Match(name, word, draw(_words(bits, width=width)))
        case "argmax":
            words = (word, *draw(st.lists(_words(bits), min_size=1, max_size=5)))
            return ArgMax(name, words, draw(st.sampled_from(["first", "last"])))
        case _:
            return Register(name, word, draw(st.integers(1, 3)))
