"""Encoders in hardware: thermometer bits from words of fixed-point numbers.

All thresholds of a feature are made together, see `wnn2hdl.lower.thresholds`.
"""

import numpy as np

from wnn2hdl.errors import InputError
from wnn2hdl.ir import Thermometer, TruthTable
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.encoder import Encoder
from wnn2hdl.ir.features import ThermometerBits, Words
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.ir.nodes import Table
from wnn2hdl.ir.wires import Port, Slice
from wnn2hdl.lower.thresholds import compare


def features_port(encoder: Encoder) -> Port:
    """The port ``features``: the words of all features side by side, feature 0 in the lowest bits.

    Raises:
        InputError: the encoder reads pixels, or numbers of no stated format.
    """
    if isinstance(encoder, Words | ThermometerBits):
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
    carries = {position: Slice("bits", place) for place, position in enumerate(read)}
    return Circuit("encoder", summary, (features,), tuple(nodes), {"bits": tuple(bits)}, carries=carries)


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
        distinct = sorted(level for level in set(levels) if 0 < level < 1 << form.bits)
        word = [Slice("features", feature * form.bits + bit) for bit in range(form.bits)]
        tables, bits = (
            compare(word, distinct, signed=form.signed, name=f"x{feature}") if distinct else ([], [])
        )
        nodes += tables
        made |= {(feature, level): bit for level, bit in zip(distinct, bits, strict=True)}
        for level in set(levels) - set(distinct):
            # All words are at least that, or none is.
            values = np.full((2, 1), level <= 0)
            nodes.append(
                Table(
                    f"x{feature}_{'all' if level <= 0 else 'none'}",
                    (word[0],),
                    TruthTable.exact(("i0",), ("o",), values),
                )
            )
            made[feature, level] = Slice(nodes[-1].name)
    return [made[place] for place in places]


def _format(encoder: Thermometer) -> FixedPoint:
    if encoder.input is None:
        raise InputError(
            "the thermometer reads real numbers, and hardware reads words",
            hint="state the format of the words with --input, as in --input Q3.12",
        )
    return encoder.input
