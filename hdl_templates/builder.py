"""Writing LUT networks by hand: cells by what they compute, constants and idle inputs gone."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product

from wnn2hdl.ir import CONSTANTS, LUT_INPUTS, Lut, LutNetwork


@dataclass(frozen=True)
class Function:
    """A function of a few signals that is not a cell yet.

    Attributes:
        pins: the signals, all different and none constant; the first is the least significant address bit.
        contents: its value at each address, ``2**len(pins)`` of them.
    """

    pins: tuple[str, ...]
    contents: tuple[int, ...]


class NetworkBuilder:
    """A network under construction.

    Args:
        inputs: names of the network's inputs.
    """

    def __init__(self, inputs: Sequence[str]) -> None:
        self._inputs = tuple(inputs)
        self._cells: dict[Function, str] = {}

    def add(self, pins: Sequence[str], compute: Callable[..., int]) -> str:
        """The signal of a function; a new cell, unless it is a constant, a signal or an older cell.

        Args:
            pins: signals or constants; at most six of them are different signals.
            compute: gives 0 or 1 from one int for each pin.
        """
        return self.signal(function(pins, compute))

    def signal(self, wanted: Function) -> str:
        """The signal of a function; see `add`."""
        if not wanted.pins:
            return CONSTANTS[wanted.contents[0]]
        if wanted.contents == (0, 1):
            return wanted.pins[0]
        if wanted not in self._cells:
            self._cells[wanted] = f"t{len(self._cells)}"
        return self._cells[wanted]

    def network(self, outputs: Sequence[tuple[str, str]]) -> LutNetwork:
        """The network; ``outputs`` are pairs (output name, signal)."""
        cells = (
            Lut(name, cell.pins, sum(bit << address for address, bit in enumerate(cell.contents)))
            for cell, name in self._cells.items()
        )
        return LutNetwork(self._inputs, tuple(cells), tuple(outputs))


def function(pins: Sequence[str], compute: Callable[..., int]) -> Function:
    """A function without constants, without repeated pins and without pins that it does not depend on."""
    signals = [pin for pin in dict.fromkeys(pins) if pin not in CONSTANTS]
    values: dict[tuple[int, ...], int] = {}
    for address in product((0, 1), repeat=len(signals)):
        known = {**dict(zip(signals, address, strict=True)), CONSTANTS[0]: 0, CONSTANTS[1]: 1}
        values[address] = int(compute(*(known[pin] for pin in pins)))
    for place in reversed(range(len(signals))):
        halves = [
            {x[:place] + x[place + 1 :]: v for x, v in values.items() if x[place] == bit} for bit in (0, 1)
        ]
        if halves[0] == halves[1]:
            values = halves[0]
            del signals[place]
    # The first pin is the least significant bit of an address, so the last one varies slowest.
    contents = tuple(values[x[::-1]] for x in product((0, 1), repeat=len(signals)))
    return Function(tuple(signals), contents)


def choose(select: str, low: Function, high: Function) -> Function | None:
    """The function ``high if select else low``; None if it reads more than six signals."""
    pins = tuple(dict.fromkeys((select, *low.pins, *high.pins)))
    if len(pins) > LUT_INPUTS:
        return None

    def compute(*bits: int) -> int:
        values = dict(zip(pins, bits, strict=True))
        taken = high if values[select] else low
        return taken.contents[sum(values[pin] << place for place, pin in enumerate(taken.pins))]

    return function(pins, compute)
