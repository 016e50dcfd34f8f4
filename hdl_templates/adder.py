"""Sums of weighted bits by a tree of counters, each a few LUTs."""

from collections.abc import Iterator, Sequence
from functools import cache

from hdl_templates.builder import NetworkBuilder
from wnn2hdl.ir import CONSTANTS, LUT_INPUTS, LutNetwork
from wnn2hdl.ir.packing import packed_luts

_SIZES = ((6,), (5, 6), (3,), (5,), (5, 3), (6, 3), (3, 6))
"""Bits of one column that counters take, one counter after the other; which is best depends on how many there
are, since two outputs of a counter of five bits share a LUT6_2 and those of six do not."""


@cache
def sum_network(weights: tuple[int, ...], offset: int = 0) -> LutNetwork:
    """The sum of the weights of the bits that are set, and a constant, in as few LUTs as a few tries find.

    Args:
        weights: of each input, at least 1.
        offset: is added to the sum, at least 0.

    Returns:
        A network that reads the bits and gives as many bits as the largest sum needs, the least significant
        first.
    """
    tries = (_tree(weights, offset, sizes) for sizes in _SIZES)
    return min(tries, key=lambda network: (packed_luts(network), network.depth))


def _tree(weights: Sequence[int], offset: int, sizes: Sequence[int]) -> LutNetwork:
    inputs = [f"b{position}" for position in range(len(weights))]
    builder = NetworkBuilder(inputs)
    width = (sum(weights) + offset).bit_length()
    columns: list[list[str]] = [[] for _ in range(width)]
    for signal, weight in ((CONSTANTS[1], offset), *zip(inputs, weights, strict=True)):
        for power in _powers(weight):
            columns[power].append(signal)
    for power, column in enumerate(columns):
        above = columns[power + 1] if power + 1 < width else []
        turn = 0
        while len(column) > 1:
            ones, twos = _taken(len(column), len(above), sizes[turn % len(sizes)])
            turn += 1
            total = _counted(builder, _take(column, ones), _take(above, twos))
            for place, signal in enumerate(total):
                if power + place < width:
                    columns[power + place].append(signal)
    outputs = [(f"s{power}", column[0] if column else CONSTANTS[0]) for power, column in enumerate(columns)]
    return builder.network(outputs)


def _taken(ones: int, twos: int, size: int) -> tuple[int, int]:
    """How many bits of a column, and of the next one, a counter takes: at most six, their sum below eight."""
    if ones >= size:
        return size, 0
    return ones, min(twos, (7 - ones) // 2, LUT_INPUTS - ones, 2)


def _counted(builder: NetworkBuilder, ones: list[str], twos: list[str]) -> list[str]:
    """The bits of a counter's sum."""
    width = (len(ones) + 2 * len(twos)).bit_length()

    def bit(place: int) -> str:
        return builder.add(
            [*ones, *twos],
            lambda *bits: (sum(bits[: len(ones)]) + 2 * sum(bits[len(ones) :])) >> place & 1,
        )

    return [bit(place) for place in range(width)]


def _take(bits: list[str], count: int) -> list[str]:
    taken = bits[:count]
    del bits[:count]
    return taken


def _powers(weight: int) -> Iterator[int]:
    return (power for power in range(weight.bit_length()) if weight >> power & 1)
