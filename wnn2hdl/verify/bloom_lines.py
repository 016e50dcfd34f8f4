"""Reference Verilog of Bloom filters, straight from the model: hashes, look-ups, and what fires."""

from collections.abc import Mapping, Sequence

import numpy as np

from wnn2hdl.ir import Thermometer
from wnn2hdl.ir.encoder import Encoder
from wnn2hdl.ir.linear import basis, combination
from wnn2hdl.ir.models import BloomWisardModel
from wnn2hdl.ir.models.base import ZERO
from wnn2hdl.verify.reference import lookup


def filter_lines(
    model: BloomWisardModel, signals: Sequence[str], forms: Mapping[int, str]
) -> tuple[list[str], list[str]]:
    """Lines of all filters, and the output of each, class by class.

    Args:
        model: the model.
        signals: the encoder's bits.
        forms: signals that are exclusive ors of these bits, by the mask of the bits. A hash of which a whole
            basis is among them is made from it, and from nothing else.
    """
    lines: list[str] = []
    outputs: list[list[str]] = [[] for _ in model.classes]
    for number, mapping in enumerate(model.mapping.tolist()):
        addresses: list[list[str]] = []
        for index, constants in enumerate(model.hashes.tolist()):
            bits = _hash(model, mapping, constants, signals, forms)
            addresses.append([f"hash_{number}_{index}[{place}]" for place in range(len(bits))])
            lines.append(f"  wire [{len(bits) - 1}:0] hash_{number}_{index};")
            lines += [f"  assign {name} = {value};" for name, value in zip(addresses[-1], bits, strict=True)]
        for owner, contents in enumerate(model.contents[:, number]):
            answers = []
            for index, address in enumerate(addresses):
                made, answer = lookup(f"entry_{owner}_{number}_{index}", contents, address)
                lines += made
                answers.append(answer)
            lines.append(f"  wire filter_{owner}_{number} = {' & '.join(answers)};")
            outputs[owner].append(f"filter_{owner}_{number}")
    return lines, [name for of_class in outputs for name in of_class]


def _hash(
    model: BloomWisardModel,
    mapping: list[int],
    constants: list[int],
    signals: Sequence[str],
    forms: Mapping[int, str],
) -> list[str]:
    """An expression for each bit of a hash, the least significant first."""
    size = model.contents.shape[2].bit_length() - 1
    rows: list[list[int]] = [
        [position for position, constant in zip(mapping, constants, strict=True) if constant >> place & 1]
        for place in range(size)
    ]
    reduced = [_reduced(model.encoder, row) for row in rows]
    masks = basis(mask for mask, _ in reduced)
    made = {1 << position: signal for position, signal in enumerate(signals)} | dict(forms)
    if not all(mask in made for mask in masks):
        return [
            " ^ ".join(signals[position] for position in row if position != ZERO) or "1'b0" for row in rows
        ]
    bits = []
    for mask, constant in reduced:
        chosen = combination(mask, masks)
        terms = [each for place, each in enumerate(masks) if chosen >> place & 1]
        if np.bitwise_xor.reduce(np.array([mask, *terms], dtype=object)):
            raise ValueError("a hash is no exclusive or of what it is said to be made from")
        bits.append(" ^ ".join([*(made[each] for each in terms), f"1'b{int(constant)}"]))
    return bits


def _reduced(encoder: Encoder, positions: Sequence[int]) -> tuple[int, bool]:
    """An exclusive or of the encoder's bits as a mask of different ones and a constant.

    Bits of a thermometer that no word or every word sets are constants, and of bits of one level the first
    stands for all.
    """
    mask, constant = 0, False
    flat: list[tuple[int, int]] = []
    if isinstance(encoder, Thermometer):
        flat = [(feature, level) for feature, levels in enumerate(encoder.levels) for level in levels]
    for position in positions:
        if position == ZERO:
            continue
        if not flat:
            mask ^= 1 << position
            continue
        assert isinstance(encoder, Thermometer)
        assert encoder.input is not None
        level = flat[position][1]
        if encoder.input.lowest < level <= encoder.input.highest:
            mask ^= 1 << flat.index(flat[position])
        else:
            constant ^= level <= encoder.input.lowest
    return mask, constant
