# amaranth: UnusedElaboratable=no
# A part of which the text is known already is made for its ports alone.
"""Counting ones with 6-input LUTs: compressors, and the tree of them that adds up columns of bits.

Each output of a compressor is a function of at most six bits, so one LUT6. A synthesiser that flattens the
tree restructures it and loses that (measured with Yosys 0.70: 511 LUTs for the match count of 220 bits, not
291); the compressors are therefore modules that keep their hierarchy.
"""

from amaranth.hdl import Cat, Module, Value
from amaranth.lib.wiring import In, Out

from hdl_templates.hierarchy import Part, place
from hdl_templates.ports import named
from wnn2hdl.ir import LUT_INPUTS

Columns = dict[int, list[Value]]
"""Bits to be added: ``columns[k]`` holds bits of weight ``2**k``."""


class Compressor(Part):
    """The number of ones among up to six bits, some of weight two; combinational, latency 0 cycles.

    Args:
        ones: bits of weight 1, at least 2.
        twos: bits of weight 2; ``ones + twos`` is at most 6.
        width: bits of the sum that are wanted, at most as many as it has.

    Members:
        one: In, the bits of weight 1.
        two: In, the bits of weight 2; absent without any.
        total: Out, ``width`` bits of the sum. One LUT for each.
    """

    keep_hierarchy = True

    def __init__(self, *, ones: int, twos: int, width: int) -> None:
        if not (ones >= 2 and twos >= 0 and ones + twos <= LUT_INPUTS):
            raise ValueError(f"a compressor adds 2 to {LUT_INPUTS} bits, not {ones} and {twos}")
        if not 1 <= width <= (ones + 2 * twos).bit_length():
            raise ValueError(f"the sum of {ones} and {twos} bits does not have {width} bits")
        self.ones, self.twos, self.width = ones, twos, width
        self.module_name = f"compress_{ones}_{twos}_to_{width}"
        members = {"one": In(ones), "two": In(twos), "total": Out(width)}
        super().__init__({name: member for name, member in members.items() if name != "two" or twos})

    def elaborate(self, platform: object) -> Module:
        """Full adders, as equations."""
        m = Module()
        columns: Columns = {0: list(self.one)}
        if self.twos:
            columns[1] = list(self.two)
        m.d.comb += self.total.eq(Cat(_full_adders(m, columns, self.width, platform)))
        return m


class MatchCompressor(Part):
    """How many of up to three pairs of bits are equal; combinational, latency 0 cycles.

    Args:
        pairs: how many pairs, 2 or 3.

    Members:
        bits: In, one bit of each pair.
        reference_bits: In, the other.
        total: Out, 2 bits, the number of equal pairs. One LUT for each.
    """

    keep_hierarchy = True

    def __init__(self, *, pairs: int) -> None:
        if pairs not in (2, 3):
            raise ValueError(f"a match compressor compares 2 or 3 pairs, not {pairs}")
        self.pairs = pairs
        self.module_name = f"match_{pairs}"
        super().__init__({"bits": In(pairs), "reference_bits": In(pairs), "total": Out(2)})

    def elaborate(self, platform: object) -> Module:
        """XNOR and a full adder, as equations."""
        m = Module()
        same = [
            named(m, f"same_{i}", ~(self.bits[i] ^ self.reference_bits[i]), platform)
            for i in range(self.pairs)
        ]
        m.d.comb += self.total.eq(Cat(_full_adders(m, {0: same}, 2, platform)))
        return m


def add_columns(m: Module, columns: Columns, width: int, *, name: str, platform: object) -> list[Value]:
    """Add up columns of bits with compressors, placed as submodules of ``m``.

    Columns are worked off from the least significant one, each with the compressor that removes most bits
    per LUT: 6:3 and (5, 1):3 remove one bit per LUT, smaller ones less.

    Args:
        m: the module under construction.
        columns: the bits; emptied.
        width: bits of the sum; what lies above is known to be 0.
        name: what the names of the instances begin with.
        platform: the platform of ``m``.

    Returns:
        The bits of the sum, least significant first.
    """
    total: list[Value] = []
    number = 0
    for weight in range(width):
        column = columns.pop(weight, [])
        while len(column) > 1:
            above = columns.setdefault(weight + 1, [])
            ones, twos = _choose(len(column), len(above) if weight + 1 < width else 0)
            outputs = min((ones + 2 * twos).bit_length(), width - weight)
            unit = Compressor(ones=ones, twos=twos, width=outputs)
            place(m, f"{name}_add_{number}", unit, platform)
            number += 1
            m.d.comb += unit.one.eq(Cat(_take(column, ones)))
            if twos:
                m.d.comb += unit.two.eq(Cat(_take(above, twos)))
            column.append(unit.total[0])
            for position in range(1, outputs):
                columns.setdefault(weight + position, []).append(unit.total[position])
        total.append(column[0] if column else Value.cast(0)[0])
    return total


def _choose(ones: int, twos: int) -> tuple[int, int]:
    """How many of a column of ``ones`` bits, and of the ``twos`` bits of the next, to compress at once."""
    if ones >= LUT_INPUTS:
        return LUT_INPUTS, 0
    if ones == 5:
        return 5, min(twos, 1)
    if ones == 4:
        return 4, 2 if twos >= 2 else 0
    if ones == 3 and twos == 3:
        return 3, 3
    return ones, min(twos, 2)


def _take(bits: list[Value], count: int) -> list[Value]:
    taken = bits[:count]
    del bits[:count]
    return taken


def _full_adders(m: Module, columns: Columns, width: int, platform: object) -> list[Value]:
    """The sum of few bits, its intermediate sums and carries named."""
    total: list[Value] = []
    number = 0
    for weight in range(width):
        column = columns.pop(weight, [])
        while len(column) > 1:
            addends = _take(column, 3)
            a, b = addends[:2]
            if len(addends) == 3:
                c = addends[2]
                parity, carry = a ^ b ^ c, a & b | a & c | b & c
            else:
                parity, carry = a ^ b, a & b
            column.append(named(m, f"sum_{number}", parity, platform))
            if weight + 1 < width:
                columns.setdefault(weight + 1, []).append(named(m, f"carry_{number}", carry, platform))
            number += 1
        total.append(column[0] if column else Value.cast(0)[0])
    return total
