"""Sums of weighted bits by a tree of counters, each a few LUTs."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache

from hdl_templates.builder import NetworkBuilder
from wnn2hdl.ir import CONSTANTS, LUT_INPUTS, LutNetwork
from wnn2hdl.ir.packing import packed_luts

_SIZES = ((6,), (5, 6), (3,), (5,), (5, 3), (6, 3), (3, 6))
"""Bits of one column that counters take, one counter after the other; which is best depends on how many there
are, since two outputs of a counter of five bits share a LUT6_2 and those of six do not."""

Digits = Callable[[int], Iterator[tuple[int, bool]]]
"""Of a weight, the powers of two that add up to it; those with a true flag are subtracted."""


@dataclass(frozen=True)
class _Bit:
    """A bit that is added: a signal, or its inverse, which a counter takes at no cost."""

    signal: str
    inverted: bool = False


@cache
def sum_network(weights: tuple[int, ...], offset: int, width: int) -> LutNetwork:
    """The sum of the weights of the bits that are set, and a constant, in as few LUTs as a few tries find.

    Args:
        weights: of each input.
        offset: is added to the sum.
        width: bits of the sum, which is taken modulo ``2**width``.

    Returns:
        A network that reads the bits and gives ``width`` bits, the least significant first.
    """
    tries = (
        _tree(weights, offset, width, sizes, digits) for digits in (_binary, _fewest) for sizes in _SIZES
    )
    return min(tries, key=lambda network: (packed_luts(network), network.depth))


def _tree(
    weights: Sequence[int], offset: int, width: int, sizes: Sequence[int], digits: Digits
) -> LutNetwork:
    inputs = [f"b{position}" for position in range(len(weights))]
    builder = NetworkBuilder(inputs)
    columns: list[list[_Bit]] = [[] for _ in range(width)]
    for signal, weight in zip(inputs, weights, strict=True):
        for power, is_negative in digits(weight):
            if power < width:
                columns[power].append(_Bit(signal, is_negative))
                # A bit is subtracted as its inverse less one.
                offset -= is_negative << power
    for power in range(width):
        if offset >> power & 1:
            columns[power].insert(0, _Bit(CONSTANTS[1]))
    for power, column in enumerate(columns):
        above = columns[power + 1] if power + 1 < width else []
        turn = 0
        while len(column) > 1:
            ones, twos = _taken(len(column), len(above), sizes[turn % len(sizes)])
            turn += 1
            total = _counted(builder, _take(column, ones), _take(above, twos))
            for place, signal in enumerate(total):
                if power + place < width:
                    columns[power + place].append(_Bit(signal))
    outputs = [(f"s{power}", _counted(builder, column, [])[0]) for power, column in enumerate(columns)]
    return builder.network(outputs)


def _taken(ones: int, twos: int, size: int) -> tuple[int, int]:
    """How many bits of a column, and of the next one, a counter takes: at most six, their sum below eight."""
    if ones >= size:
        return size, 0
    return ones, min(twos, (7 - ones) // 2, LUT_INPUTS - ones, 2)


def _counted(builder: NetworkBuilder, ones: list[_Bit], twos: list[_Bit]) -> list[str]:
    """The bits of a counter's sum, at least one."""
    bits = [*ones, *twos]
    width = max((len(ones) + 2 * len(twos)).bit_length(), 1)

    def bit(place: int) -> str:
        def compute(*values: int) -> int:
            added = [value ^ bit.inverted for value, bit in zip(values, bits, strict=True)]
            return (sum(added[: len(ones)]) + 2 * sum(added[len(ones) :])) >> place & 1

        return builder.add([bit.signal for bit in bits], compute)

    return [bit(place) for place in range(width)]


def _take(bits: list[_Bit], count: int) -> list[_Bit]:
    taken = bits[:count]
    del bits[:count]
    return taken


def _binary(weight: int) -> Iterator[tuple[int, bool]]:
    return ((power, weight < 0) for power in range(abs(weight).bit_length()) if abs(weight) >> power & 1)


def _fewest(weight: int) -> Iterator[tuple[int, bool]]:
    """The non-adjacent form: no two digits stand side by side, and no other form has fewer."""
    size = abs(weight)
    # Twice the weight is the difference of these two numbers, which share no digit.
    plus, minus = 3 * size & ~size, size & ~(3 * size)
    for power in range(plus.bit_length()):
        if (plus | minus) >> (power + 1) & 1:
            yield power, bool(minus >> (power + 1) & 1) != (weight < 0)
