# amaranth: UnusedElaboratable=no
# A part of which the text is known already is made for its ports alone.
"""Match and count: in how many places two binary words agree."""

from amaranth.hdl import Cat, Module, Value

from hdl_templates.compressor import Columns, MatchCompressor, add_columns
from hdl_templates.hierarchy import place
from hdl_templates.ports import named

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
