"""Where the boxes and wires of a LUT network go in a drawing: inputs on the left, outputs on the right."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Literal

from wnn2hdl.ir import CONSTANTS, Lut, LutNetwork
from wnn2hdl.report.placement import Edge, Place, middles, order, straightened

Kind = Literal["input", "lut", "mux", "output"]

_PIN = 15.0
_GAP = 14.0
_MARGIN = 12.0
_COLUMN = 160.0
_WIDTHS: Mapping[Kind, float] = {"input": 52.0, "lut": 76.0, "mux": 44.0, "output": 92.0}
_TEXT_HEIGHT = 22.0
"""Pixels: between two pins, between two boxes, around the drawing, from layer to layer, and of the boxes."""

_OUTPUT = "→"
"""Stands before the names of outputs, which may be those of signals too."""


@dataclass(frozen=True)
class Node:
    """A box of the drawing.

    Attributes:
        name: the signal it drives or, of an output, its name.
        kind: what it is.
        x: left edge in pixels.
        y: middle in pixels.
        width: in pixels.
        height: in pixels.
        critical: whether it lies on the longest path.
    """

    name: str
    kind: Kind
    x: float
    y: float
    width: float
    height: float
    critical: bool


@dataclass(frozen=True)
class Wire:
    """A connection.

    Attributes:
        source: the driving signal.
        target: the name of the box that reads it.
        path: an SVG path from the right of one to the left of the other.
        critical: whether it lies on the longest path.
    """

    source: str
    target: str
    path: str
    critical: bool


@dataclass(frozen=True)
class Schematic:
    """A drawing of a network.

    Attributes:
        width: in pixels.
        height: in pixels.
        nodes: inputs that are read, cells and outputs, from left to right and top to bottom.
        wires: their connections.
        path: names along the longest path, input and output included.
        unread: inputs that nothing reads.
    """

    width: float
    height: float
    nodes: tuple[Node, ...]
    wires: tuple[Wire, ...]
    path: tuple[str, ...]
    unread: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class _Graph:
    """A network as boxes and who reads whom.

    Attributes:
        kinds: of each box.
        pins: for each cell the different signals it reads.
        readers: for each signal the boxes that read it.
        layers: of each box, from 0.
    """

    kinds: dict[str, Kind] = field(default_factory=dict)
    pins: dict[str, tuple[str, ...]] = field(default_factory=dict)
    readers: dict[str, list[str]] = field(default_factory=lambda: defaultdict(list))
    layers: dict[str, int] = field(default_factory=dict)

    def height(self, name: str) -> float:
        """Of a box in pixels."""
        return max(_PIN * (len(self.pins[name]) + 1), 40.0) if name in self.pins else _TEXT_HEIGHT

    def places(self) -> tuple[list[list[Place]], list[Edge]]:
        """What stands in each layer, and the connections between neighbouring layers.

        A wire over several layers has a place in each that it passes, shared by all its readers.
        """
        columns: list[list[Place]] = [[] for _ in range(1 + max(self.layers.values()))]
        edges: list[Edge] = []
        for name, layer in self.layers.items():
            columns[layer].append((name, layer))
        for name, targets in self.readers.items():
            for layer in range(self.layers[name] + 1, max(self.layers[target] for target in targets)):
                columns[layer].append((name, layer))
                edges.append(((name, layer - 1), (name, layer)))
            edges += [((name, self.layers[target] - 1), (target, self.layers[target])) for target in targets]
        return columns, edges


def draw(network: LutNetwork) -> Schematic:
    """Lay a network out; the same network gives the same drawing.

    Args:
        network: has at least one output.
    """
    graph = _graph(network)
    columns, edges = graph.places()
    columns = order(columns, edges)
    heights = {
        (name, layer): graph.height(name) if graph.layers[name] == layer else _PIN
        for column in columns
        for name, layer in column
    }
    ys = {place: y + _MARGIN for place, y in middles(columns, edges, heights, _GAP).items()}
    path = _longest(network)
    boxes = {
        name: Node(
            _label(name),
            graph.kinds[name],
            _left(layer, graph.kinds[name]),
            ys[name, layer],
            _WIDTHS[graph.kinds[name]],
            heights[name, layer],
            name in path,
        )
        for column in columns
        for name, layer in column
        if graph.layers[name] == layer
    }
    steps = set(pairwise(path))
    wires = [
        Wire(
            source,
            _label(target),
            straightened(_points(graph, boxes, ys, source, target)),
            (source, target) in steps,
        )
        for source, targets in graph.readers.items()
        for target in targets
    ]
    return Schematic(
        max(node.x + node.width for node in boxes.values()) + _MARGIN,
        max(ys[place] + heights[place] / 2 for place in ys) + _MARGIN,
        tuple(boxes.values()),
        tuple(wires),
        tuple(_label(name) for name in path),
        tuple(name for name in network.inputs if name not in graph.readers),
    )


def _graph(network: LutNetwork) -> _Graph:
    graph = _Graph()
    for cell in network.cells:
        graph.pins[cell.name] = tuple(dict.fromkeys(cell.reads))
        for name in graph.pins[cell.name]:
            graph.readers[name].append(cell.name)
    for name, signal in network.outputs:
        graph.readers[signal].append(_OUTPUT + name)
    graph.kinds.update({name: "input" for name in (*network.inputs, *CONSTANTS) if name in graph.readers})
    graph.kinds.update({cell.name: "lut" if isinstance(cell, Lut) else "mux" for cell in network.cells})
    # A signal that nothing reads drives no wire.
    graph.layers.update(_generations(graph))
    last = 1 + max(graph.layers.values())
    for name, _ in network.outputs:
        graph.kinds[_OUTPUT + name] = "output"
        graph.layers[_OUTPUT + name] = last
    return graph


def _generations(graph: _Graph) -> dict[str, int]:
    # Not at the top: commands that draw nothing need not wait for it.
    import networkx as nx

    drawn = nx.DiGraph()
    drawn.add_nodes_from(graph.kinds)
    drawn.add_edges_from((source, name) for name, pins in graph.pins.items() for source in pins)
    layers = enumerate(nx.topological_generations(drawn))
    return {name: layer for layer, names in layers for name in names}


def _points(
    graph: _Graph, boxes: Mapping[str, Node], ys: Mapping[Place, float], source: str, target: str
) -> Sequence[tuple[float, float]]:
    """The points of a wire: out of a box, level past the boxes of each layer between, and into a pin."""
    start, end = boxes[source], boxes[target]
    points = [(start.x + start.width, start.y)]
    for layer in range(graph.layers[source] + 1, graph.layers[target]):
        left, y = _left(layer, "lut"), ys[source, layer]
        points += [(left, y), (left + _WIDTHS["lut"], y)]
    pins = list(graph.pins.get(target, (source,)))
    if end.kind == "lut":
        # A table is a function of names, so the signals enter it as they come; a multiplexer has fixed pins.
        pins.sort(key=lambda name: ys[name, graph.layers[target] - 1])
    points.append((end.x, end.y + _PIN * (pins.index(source) - (len(pins) - 1) / 2)))
    return points


def _left(layer: int, kind: Kind) -> float:
    inset = (_WIDTHS["lut"] - _WIDTHS[kind]) / 2 if kind == "mux" else 0.0
    return _MARGIN + _COLUMN * layer - (_COLUMN - _WIDTHS["input"] - 72.0) * (layer > 0) + inset


def _longest(network: LutNetwork) -> tuple[str, ...]:
    """The names along the path with the most LUTs; of equal ones the first that is found."""
    level: dict[str, int] = dict.fromkeys((*network.inputs, *CONSTANTS), 0)
    slowest: dict[str, str] = {}
    for cell in network.cells:
        slowest[cell.name] = max(cell.reads, key=level.__getitem__)
        level[cell.name] = level[slowest[cell.name]] + isinstance(cell, Lut)
    name, signal = max(network.outputs, key=lambda pair: level[pair[1]])
    path = [_OUTPUT + name, signal]
    while path[-1] in slowest:
        path.append(slowest[path[-1]])
    return tuple(path[::-1])


def _label(name: str) -> str:
    return name.removeprefix(_OUTPUT)
