"""Where the steps of a core and the wires between them go in a drawing."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from wnn2hdl.ir.steps import Step

_WIDTH, _HEIGHT = 150.0, 84.0
_GAP, _BELOW = 52.0, 40.0
"""Pixels between two boxes of a row, where the wire's width is written, and between two rows."""

_MARGIN = 6.0
_LONGEST = 5
"""Boxes of a row at most."""


@dataclass(frozen=True)
class Box:
    """A step in the drawing.

    Attributes:
        step: the step.
        x: left edge in pixels.
        y: upper edge in pixels.
        lines: what is written into it, the name first.
    """

    step: Step
    x: float
    y: float
    lines: tuple[str, ...]


@dataclass(frozen=True)
class Link:
    """A wire.

    Attributes:
        path: an SVG path.
        x: of the middle of its label, in pixels.
        y: of the label's foot.
        label: how many bits pass in a cycle.
    """

    path: str
    x: float
    y: float
    label: str


@dataclass(frozen=True)
class Pipeline:
    """A drawing of a core.

    Attributes:
        width: in pixels.
        height: in pixels.
        box_width: of all boxes.
        box_height: of all boxes.
        boxes: the steps.
        links: what connects them.
    """

    width: float
    height: float
    box_width: float
    box_height: float
    boxes: tuple[Box, ...]
    links: tuple[Link, ...]


def lay_out(steps: Sequence[Step], parts: Mapping[str, Mapping[str, Any]], *, narrow: bool) -> Pipeline:
    """Lay the steps of a core out, from left to right in rows; narrow ones from top to bottom.

    Args:
        steps: at least one, each behind all that it reads.
        parts: the figures of each part, as in `report.json`.
        narrow: whether it is for a phone.
    """
    layers: dict[str, int] = {}
    for step in steps:
        layers[step.name] = 1 + max((layers[name] for name in step.reads), default=-1)
    count = 1 + max(layers.values())
    rows = count if narrow else -(-count // _LONGEST)
    columns = -(-count // rows)
    beside = max(list(layers.values()).count(layer) for layer in range(count))
    boxes: dict[str, Box] = {}
    for step in steps:
        layer = layers[step.name]
        peers = [name for name, other in layers.items() if other == layer]
        # Those of one layer stand around its middle.
        aside = peers.index(step.name) - (len(peers) - 1) / 2 + (beside - 1) / 2
        row, column = divmod(layer, columns)
        if narrow:
            aside += max(2 - beside, 0) / 2
            x, y = aside * (_WIDTH + 20), layer * (_HEIGHT + _BELOW)
        else:
            x = column * (_WIDTH + _GAP)
            y = (row * beside + aside) * (_HEIGHT + _BELOW)
        boxes[step.name] = Box(step, x + _MARGIN, y + _MARGIN, _lines(step, parts))
    links = [_link(boxes[name], boxes[step.name], narrow=narrow) for step in steps for name in step.reads]
    return Pipeline(
        max(2 * _WIDTH + 20 if narrow else 0.0, *(box.x + _WIDTH for box in boxes.values())) + _MARGIN,
        max(box.y for box in boxes.values()) + _HEIGHT + _MARGIN,
        _WIDTH,
        _HEIGHT,
        tuple(boxes.values()),
        tuple(links),
    )


def way(steps: Sequence[Step]) -> list[Step]:
    """The steps that what leaves the last one has passed, along the first that each reads."""
    by_name = {step.name: step for step in steps}
    found = [steps[-1]]
    while found[-1].reads:
        found.append(by_name[found[-1].reads[0]])
    return found[::-1]


def waiting(step: Step) -> str:
    """For how long a word is in a step, in words; nothing where no register is known."""
    amounts = ((step.lines, "line"), (step.beats, "beat"), (step.cycles, "cycle"))
    return ", ".join(_several(number, unit) for number, unit in amounts if number)


def memory(step: Step) -> str:
    """The memory of a step, in words; nothing if it has none."""
    return f"{step.words:,} × {_several(step.word_bits, 'bit')}" if step.words else ""  # noqa: RUF001


def _lines(step: Step, parts: Mapping[str, Mapping[str, Any]]) -> tuple[str, ...]:
    luts = parts.get(step.part or "", {}).get("luts")
    side_by_side = f"{step.count} × " if step.count > 1 else ""  # noqa: RUF001
    cost = "" if luts is None else f"{side_by_side}{_several(luts, 'LUT')}"
    return tuple(line for line in (step.name, cost, memory(step), waiting(step)) if line)


def _several(number: int, unit: str) -> str:
    return f"{number:,} {unit}{'' if number == 1 else 's'}"


def _link(source: Box, target: Box, *, narrow: bool) -> Link:
    label = _several(source.step.bits, "bit")
    if narrow:
        x, top = source.x + _WIDTH / 2, source.y + _HEIGHT
        end, middle = target.x + _WIDTH / 2, target.y - _BELOW / 2
        path = f"M{x:g} {top:g}V{middle:g}H{end:g}V{target.y:g}"
        # On the side to which the wire does not turn.
        return Link(path, x - 34 if end > x else x + 34, middle + 5, label)
    start, y = source.x + _WIDTH, source.y + _HEIGHT / 2
    end = target.y + _HEIGHT / 2
    if target.x > source.x:
        half = start + _GAP / 2
        return Link(f"M{start:g} {y:g}H{half:g}V{end:g}H{target.x:g}", half, y - 7, label)
    # From the end of a row to the beginning of the next one.
    below, x = source.y + _HEIGHT + _BELOW / 2, source.x + _WIDTH / 2
    down = target.x + _WIDTH / 2
    path = f"M{x:g} {source.y + _HEIGHT:g}V{below:g}H{down:g}V{target.y:g}"
    return Link(path, (x + down) / 2, below - 6, label)
