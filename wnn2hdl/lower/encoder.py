"""Encoders in hardware: thermometer bits from words of fixed-point numbers.

All thresholds of a feature are made together. A word of few bits is one table of all of them. A wider word is
compared from its low end, six bits a look-up table, and thresholds share the comparisons of equal low parts;
trailing zeros of a threshold are not looked at, so that one that is a bit test costs nothing.
"""

import numpy as np

from wnn2hdl.errors import InputError
from wnn2hdl.ir import LUT_INPUTS, Thermometer, TruthTable
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.encoder import Encoder
from wnn2hdl.ir.features import FixedPoint, Words
from wnn2hdl.ir.nodes import Table
from wnn2hdl.ir.wires import Port, Slice

JOINT_BITS = 12
"""The widest word whose thresholds are one table."""


def features_port(encoder: Encoder) -> Port:
    """The port ``features``: the words of all features side by side, feature 0 in the lowest bits.

    Raises:
        InputError: the encoder reads pixels, or numbers of no stated format.
    """
    if isinstance(encoder, Words):
        return Port("features", encoder.width)
    if isinstance(encoder, Thermometer):
        return Port("features", encoder.features * _format(encoder).bits)
    raise InputError("the model reads pixels, not features", value=encoder.kind, hint="choose another target")


def encoder_circuit(encoder: Encoder, read: tuple[int, ...]) -> Circuit:
    """The circuit ``encoder``: ``features`` to ``bits``, of the encoder's bits those that are read.

    Args:
        encoder: of features.
        read: positions of the encoder's bits, ascending; output bit ``i`` is ``read[i]``.
    """
    features = features_port(encoder)
    nodes: list[Table] = []
    if isinstance(encoder, Thermometer):
        bits = _thermometer(encoder, read, nodes)
    else:
        bits = [Slice("features", position) for position in read]
    summary = f"Encoder of {len(read)} bits."
    return Circuit("encoder", summary, (features,), tuple(nodes), {"bits": tuple(bits)})


def _thermometer(encoder: Thermometer, read: tuple[int, ...], nodes: list[Table]) -> list[Slice]:
    form = _format(encoder)
    wanted: dict[int, list[int]] = {}
    places: list[tuple[int, int]] = []
    flat = [(feature, level) for feature, levels in enumerate(encoder.levels) for level in levels]
    for position in read:
        feature, level = flat[position]
        # Words of two's complement are compared with their sign bit inverted, as unsigned numbers.
        places.append((feature, level - form.lowest))
        wanted.setdefault(feature, []).append(level - form.lowest)
    made: dict[tuple[int, int], Slice] = {}
    for feature, levels in wanted.items():
        distinct = sorted(set(levels))
        word = [Slice("features", feature * form.bits + bit) for bit in range(form.bits)]
        if form.bits <= JOINT_BITS:
            nodes.append(_joint(f"x{feature}", word, distinct, form))
            made |= {(feature, level): Slice(f"x{feature}", i) for i, level in enumerate(distinct)}
        else:
            chain = _Chain(feature, word, form, nodes)
            made |= {(feature, level): chain.at_least(level) for level in distinct}
    return [made[place] for place in places]


def _joint(name: str, word: list[Slice], levels: list[int], form: FixedPoint) -> Table:
    """All thresholds of one feature as one table."""
    codes = np.arange(1 << form.bits)
    values = codes ^ (1 << (form.bits - 1) if form.signed else 0)
    answers = values[:, np.newaxis] >= np.array(levels)
    inputs = tuple(f"b{bit}" for bit in range(form.bits))
    return Table(name, tuple(word), TruthTable.exact(inputs, tuple(f"ge{x}" for x in levels), answers))


class _Chain:
    """The thresholds of a wide word, each a chain of tables from the low end."""

    def __init__(self, feature: int, word: list[Slice], form: FixedPoint, nodes: list[Table]) -> None:
        self.feature, self.word, self.form, self.nodes = feature, word, form, nodes
        self.known: dict[tuple[int, int, int], Slice] = {}

    def at_least(self, level: int) -> Slice:
        """One bit: whether the word, its sign bit inverted, is at least ``level``, above 0."""
        low = (level & -level).bit_length() - 1
        bits, below = self.form.bits, None
        # The last table reads the sign bit; those before it take what is left in sixes.
        ends = list(range(bits, low, -(LUT_INPUTS - 1)))[::-1]
        if len(ends) > 1 and ends[0] - low == 1:
            # The lowest table takes six bits, not one alone.
            ends = ends[1:]
        start = low
        for end in ends:
            below = self._part(
                start, end, level >> start & (1 << (end - start)) - 1, level & (1 << start) - 1, below
            )
            start = end
        assert below is not None
        return below

    def _part(self, start: int, end: int, digits: int, lower: int, below: Slice | None) -> Slice:
        key = (start, end, digits << start | lower)
        if key in self.known:
            return self.known[key]
        word = [*self.word[start:end], *([below] if below is not None else [])]
        width = end - start
        codes = np.arange(1 << len(word))
        part = codes & (1 << width) - 1
        if end == self.form.bits and self.form.signed:
            part = part ^ 1 << (width - 1)
        carry = codes >> width & 1 if below is not None else np.ones_like(codes)
        answers = (part > digits) | (part == digits) & (carry == 1)
        name = f"x{self.feature}_{start}_{end}_{digits << start | lower:x}"
        names = tuple(f"b{start + i}" for i in range(width)) + (("carry",) if below is not None else ())
        if len(word) == 1 and answers.tolist() == [False, True]:
            self.known[key] = word[0]
            return word[0]
        self.nodes.append(Table(name, tuple(word), TruthTable.exact(names, ("ge",), answers[:, np.newaxis])))
        self.known[key] = Slice(name)
        return self.known[key]


def _format(encoder: Thermometer) -> FixedPoint:
    if encoder.input is None:
        raise InputError(
            "the thermometer reads real numbers, and hardware reads words",
            hint="state the format of the words with --input, as in --input Q3.12",
        )
    return encoder.input
