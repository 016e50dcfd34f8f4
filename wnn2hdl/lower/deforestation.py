"""The circuits of the reference design: pixel, edge filter, matcher, block; and the neighbourhood."""

from collections.abc import Mapping

import numpy as np

from wnn2hdl.ir import (
    PIXEL_BITS,
    WINDOW_BITS,
    EdgeFilter,
    Neighbourhood,
    Tap,
    TruthTable,
    WisardModel,
    pixel_encoder,
)
from wnn2hdl.ir.care import CareSet
from wnn2hdl.ir.circuit import Care, Circuit, Instance
from wnn2hdl.ir.nodes import Match, Table
from wnn2hdl.ir.relational import occurring
from wnn2hdl.ir.wires import Port, Slice, Word
from wnn2hdl.lower.table import pixel_code, pixel_table

DECISION = "decision"
"""The table that gives the class for the code of a pixel or of a neighbourhood."""


def pixel(model: WisardModel, care: CareSet) -> Circuit:
    """The pixel classifier: ``rgb[23:0]`` to ``class_bits``, the index of the class in binary.

    Args:
        model: a model of single pixels.
        care: the codes of its encoder that matter.

    Raises:
        InputError: the model reads no pixels, or more bits than a table may have.
    """
    encoder = pixel_encoder(model)
    comparisons, code = pixel_code(encoder.names)
    decision = pixel_table(model)
    possible = occurring(encoder) & care.project(tuple(range(encoder.width)))
    table = Table(DECISION, code, decision.with_care(possible))
    return Circuit(
        "pixel",
        f"Pixel classifier of {len(model.classes)} classes.",
        (Port("rgb", PIXEL_BITS),),
        (*comparisons, table),
        {"class_bits": _all(table)},
        (Care(code, care),),
    )


def edge(edge_filter: EdgeFilter, care: CareSet) -> Circuit:
    """The 3x3 edge filter: ``bits[8:0]`` to ``edge_bit``.

    Args:
        edge_filter: the patterns that count as an edge.
        care: the binary windows that matter.
    """
    bits = Port("bits", WINDOW_BITS)
    table = Table("filter", bits.word, _cared(edge_filter.table(), care))
    return Circuit(
        "edge",
        "3x3 edge filter on a binary window.",
        (bits,),
        (table,),
        {"edge_bit": _all(table)},
        (Care(bits.word, care),),
    )


def match() -> Circuit:
    """The matcher: in how many of nine places ``bits`` and ``reference_bits`` agree, ``match_count[3:0]``."""
    bits, reference = Port("bits", WINDOW_BITS), Port("reference_bits", WINDOW_BITS)
    count = Match("agreement", bits.word, reference.word)
    summary = "Match and count: in how many places two binary windows agree."
    return Circuit("match", summary, (bits, reference), (count,), {"match_count": _all(count)})


def block(pixel_circuit: Circuit, edge_circuit: Circuit) -> Circuit:
    """The block of the reference design: nine pixel classifiers and the edge filter on their bits.

    ``window[215:0]`` to ``bits[8:0]``, where bit ``i`` is set if pixel ``i`` (``3 * row + column``) is not of
    class 0, the background, and ``edge_bit``.
    """
    window = Port("window", WINDOW_BITS * PIXEL_BITS)
    nodes: list[Instance | Table] = []
    bits: list[Slice] = []
    for i in range(WINDOW_BITS):
        pixel_i = Instance(
            f"pixel_{i}", pixel_circuit, {"rgb": (Slice("window", i * PIXEL_BITS, PIXEL_BITS),)}
        )
        nodes.append(pixel_i)
        (class_bits,) = _all(pixel_i)
        if class_bits.width > 1:
            foreground = Table(f"foreground_{i}", (class_bits,), _any(class_bits.width))
            nodes.append(foreground)
            (class_bits,) = _all(foreground)
        bits.append(class_bits)
    edges = Instance("edges", edge_circuit, {"bits": tuple(bits)})
    return Circuit(
        "block",
        "Nine pixel classifiers and the edge filter on their bits.",
        (window,),
        (*nodes, edges),
        {"bits": tuple(bits), "edge_bit": _all(edges)},
    )


def block_match(block_circuit: Circuit, match_circuit: Circuit) -> Circuit:
    """The block, and the matcher on its nine bits: all that the reference design computes from one window."""
    window, reference = Port("window", WINDOW_BITS * PIXEL_BITS), Port("reference_bits", WINDOW_BITS)
    classifiers = Instance("classifiers", block_circuit, {"window": window.word})
    bits, edge_bit = _all(classifiers)
    matcher = Instance("matcher", match_circuit, {"bits": (bits,), "reference_bits": reference.word})
    return Circuit(
        "block_match",
        "A block, and the matcher on its nine bits.",
        (window, reference),
        (classifiers, matcher),
        {"bits": (bits,), "edge_bit": (edge_bit,), "match_count": _all(matcher)},
    )


def video(circuits: Mapping[str, Circuit]) -> Circuit:
    """What a video core computes between its registers.

    The circuits have nothing in common here: memories that a circuit cannot have lie between them.

    Args:
        circuits: by the place that they have in the core, in the order in which a pixel passes them:
            ``classifier``, of a pixel; ``decision``, of a neighbourhood, and ``window``, an edge filter, if
            it has them.
    """
    inputs = [port for circuit in circuits.values() for port in circuit.inputs]
    nodes = [
        Instance(place, circuit, {port.name: port.word for port in circuit.inputs})
        for place, circuit in circuits.items()
    ]
    drivers = {port.name: _all(node) for node in nodes for port in node.circuit.outputs}
    summary = "The circuits of a video core."
    return Circuit("video", summary, tuple(inputs), tuple(nodes), drivers)


def lane(columns: int) -> Circuit:
    """A lane of a match engine: in how many ``pairs`` of neighbouring bits the two are equal, ``count``."""
    pairs = Port("pairs", 2 * columns)
    segment, template = (
        tuple(Slice("pairs", 2 * column + side) for column in range(columns)) for side in range(2)
    )
    count = Match("agreement", segment, template)
    summary = "In how many pairs of neighbouring bits the two are equal."
    agreement = Circuit("agreement", summary, (pairs,), (count,), {"count": _all(count)})
    compares = Instance("compares", agreement, {"pairs": pairs.word})
    return Circuit("lane", "A lane of a match engine.", (pairs,), (compares,), {"count": _all(compares)})


def engine(lane_circuit: Circuit) -> Circuit:
    """What a match engine computes between its registers: the circuit of one of its lanes."""
    pairs = Port("pairs", lane_circuit.inputs[0].width)
    one = Instance("lane", lane_circuit, {"pairs": pairs.word})
    return Circuit("engine", "The circuit of a match engine.", (pairs,), (one,), {"count": _all(one)})


def neighbourhood(model: WisardModel, encoder: Neighbourhood, care: CareSet) -> Circuit:
    """The classifier of a pixel and its neighbours: ``window`` to ``class_bits``.

    Args:
        model: a model of neighbourhoods.
        encoder: its encoder.
        care: the codes of the encoder that matter.
    """
    window = Port("window", encoder.size**2 * PIXEL_BITS)
    tables = [
        _tap(name, tap, "window", PIXEL_BITS * (encoder.size * tap.row + tap.column))
        for name, tap in zip(encoder.names, encoder.taps, strict=True)
    ]
    code = tuple(Slice(table.name) for table in tables)
    table = Table(DECISION, code, _cared(pixel_table(model), care))
    return Circuit(
        "neighbourhood",
        f"Classifier of a pixel by the {encoder.size}x{encoder.size} pixels around it.",
        (window,),
        (*tables, table),
        {"class_bits": _all(table)},
        (Care(code, care),),
    )


def taps(encoder: Neighbourhood) -> Circuit:
    """What a neighbourhood sees of each pixel: ``rgb`` to ``tap_bits``, a bit for each of its `tables`."""
    names = (encoder.names[encoder.sources.index(place)] for place in range(len(encoder.tables)))
    tables = [_tap(name, tap, "rgb", 0) for name, tap in zip(names, encoder.tables, strict=True)]
    summary = f"What is seen of each of the {encoder.size}x{encoder.size} pixels around a pixel."
    bits = tuple(Slice(table.name) for table in tables)
    return Circuit("taps", summary, (Port("rgb", PIXEL_BITS),), tuple(tables), {"tap_bits": bits})


def _tap(name: str, tap: Tap, net: str, low: int) -> Table:
    """The table of a tap, of the pixel that lies in a net from bit ``low`` on."""
    word = tuple(Slice(net, low + position) for position in tap.pixel.pixel_positions)
    return Table(name, word, TruthTable.exact(tap.pixel.names, (name,), tap.table[:, np.newaxis]))


def decision(model: WisardModel, care: CareSet) -> Circuit:
    """The class by the code of a neighbourhood: ``code`` to ``class_bits``.

    Args:
        model: a model of neighbourhoods.
        care: the codes of its encoder that matter.
    """
    code = Port("code", model.encoder.width)
    table = Table(DECISION, code.word, _cared(pixel_table(model), care))
    summary = f"Class of a pixel, of {len(model.classes)}, by what is seen of the pixels around it."
    return Circuit(
        "decision", summary, (code,), (table,), {"class_bits": _all(table)}, (Care(code.word, care),)
    )


def _cared(table: TruthTable, care: CareSet) -> TruthTable:
    return table.with_care(care.project(tuple(range(len(table.inputs)))))


def _all(node: Table | Match | Instance) -> Word:
    return tuple(Slice(net, 0, width) for net, width in node.drives.items())


def _any(width: int) -> TruthTable:
    """The OR of all bits."""
    names = tuple(f"class_bit{i}" for i in range(width))
    return TruthTable.exact(names, ("foreground",), np.arange(1 << width)[:, np.newaxis] > 0)
