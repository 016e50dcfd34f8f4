# amaranth: UnusedElaboratable=no
# A part of which the text is known already is made for its ports alone.
"""Match and count: in how many places two binary words agree."""

from dataclasses import replace

from amaranth.hdl import Cat, Module, Value

from hdl_templates.adder import sum_network
from hdl_templates.builder import NetworkBuilder
from hdl_templates.compressor import Columns, MatchCompressor, add_columns
from hdl_templates.hierarchy import place
from hdl_templates.ports import named
from wnn2hdl.ir import LutNetwork

PAIRS = 3
"""Pairs of bits that one 6-input LUT compares: the first stage takes two LUTs for three pairs."""


def draw_match(m: Module, bits: Value, reference: Value, *, name: str, platform: object) -> Value:
    """Compare three pairs at a time, then add up; combinational, latency 0 cycles.

    Args:
        m: the module under construction.
        bits: a word of at least 2 bits.
        reference: a word of as many bits.
        name: what the names of the instances begin with.
        platform: the platform of ``m``.

    Returns:
        In how many places the words agree, ``width.bit_length()`` bits.
    """
    width = len(bits)
    columns: Columns = {0: [], 1: []}
    for first in range(0, width, PAIRS):
        last = min(first + PAIRS, width)
        if last - first == 1:
            same = ~(bits[first] ^ reference[first])
            columns[0].append(named(m, f"{name}_same_{first}", same, platform))
            continue
        unit = MatchCompressor(pairs=last - first)
        place(m, f"{name}_compare_{first // PAIRS}", unit, platform)
        m.d.comb += [unit.bits.eq(bits[first:last]), unit.reference_bits.eq(reference[first:last])]
        columns[0].append(unit.total[0])
        columns[1].append(unit.total[1])
    return Cat(add_columns(m, columns, width.bit_length(), name=name, platform=platform))


def match_network(width: int) -> LutNetwork:
    """The same as look-up tables, between which registers can be put.

    Args:
        width: bits of each word.

    Returns:
        A network that reads one word and then the other, and gives ``width.bit_length()`` bits.
    """
    bits, reference = ([f"{name}{place}" for place in range(width)] for name in "ab")
    builder = NetworkBuilder([*bits, *reference])
    counted, weights = [], []
    for first in range(0, width, PAIRS):
        pins = [*bits[first : first + PAIRS], *reference[first : first + PAIRS]]
        for power in range((len(pins) // 2).bit_length()):
            counted.append(builder.add(pins, lambda *values, power=power: _matches(values) >> power & 1))
            weights.append(1 << power)
    total = sum_network(tuple(weights), 0, sum(weights).bit_length())
    signals = dict(zip(total.inputs, counted, strict=True)) | {
        cell.name: f"add_{cell.name}" for cell in total.cells
    }
    added = [
        replace(cell, name=signals[cell.name], inputs=tuple(signals[name] for name in cell.inputs))
        for cell in total.luts
    ]
    compared = builder.network([])
    outputs = tuple((name, signals.get(signal, signal)) for name, signal in total.outputs)
    return LutNetwork(compared.inputs, (*compared.cells, *added), outputs)


def _matches(values: tuple[int, ...]) -> int:
    """In how many places the first half of some bits agrees with the second."""
    half = len(values) // 2
    return sum(x == y for x, y in zip(values[:half], values[half:], strict=True))
