"""What a whole network has to compute: encoder, tables, votes and winner, as the model defines them."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.ir import Thermometer, WisardModel, codes_to_bits
from wnn2hdl.ir.encoder import Encoder
from wnn2hdl.ir.features import Words
from wnn2hdl.ir.models import LutGroupModel, SparseWisardModel, VotingModel
from wnn2hdl.ir.models.base import ZERO
from wnn2hdl.ir.wires import Bits
from wnn2hdl.verify.reference import class_bits, lookup, module, plain_sum, winning
from wnn2hdl.verify.specification import Claim, Samples, Specification

PART = "network"
SAMPLES = 10_240
"""Feature vectors that a network is simulated on: random ones, and ones beside thresholds."""


def network_specification(model: VotingModel) -> Specification:
    """The claim of a model whose tables vote for classes."""
    width = class_bits(model)
    encoder = model.encoder

    def answers(inputs: Samples) -> dict[str, Bits]:
        return {"class_bits": codes_to_bits(model.evaluate(encoder_bits(encoder, inputs["features"])), width)}

    claim = Claim(
        PART,
        {"features": features_width(encoder)},
        {"class_bits": width},
        f"proof__{PART}",
        answers,
        lambda: {"features": stimulus(encoder)},
    )
    return Specification({PART: claim}, module(claim.module, claim.inputs, claim.outputs, _lines(model)), "")


def features_width(encoder: Encoder) -> int:
    """Bits of the port ``features``."""
    if isinstance(encoder, Thermometer) and encoder.input is not None:
        return encoder.features * encoder.input.bits
    if isinstance(encoder, Words):
        return encoder.width
    raise InputError(
        "the model states no fixed-point format of its features",
        value=encoder.kind,
        hint="state one with --input",
    )


def encoder_bits(encoder: Encoder, features: Bits) -> Bits:
    """The bits that the model's encoder makes of the port ``features``, bool ``[samples, encoder.width]``."""
    if not isinstance(encoder, Thermometer):
        return features
    form = encoder.input
    assert form is not None
    digits = features.reshape(len(features), encoder.features, form.bits)
    weights = 1 << np.arange(form.bits, dtype=np.int64)
    if form.signed:
        weights[-1] = -weights[-1]
    return encoder.bits_of_words(digits @ weights)


def stimulus(encoder: Encoder) -> Bits:
    """Values of ``features``: half random, half with every feature at one of its thresholds or just below."""
    rng = np.random.default_rng(0)
    if not isinstance(encoder, Thermometer):
        return rng.random((SAMPLES, features_width(encoder))) < 0.5
    form = encoder.input
    assert form is not None
    words = rng.integers(form.lowest, form.highest + 1, size=(SAMPLES, encoder.features))
    for feature, levels in enumerate(encoder.levels):
        if levels:
            beside = rng.choice(np.array(levels), SAMPLES // 2) - rng.integers(0, 2, SAMPLES // 2)
            words[: SAMPLES // 2, feature] = np.clip(beside, form.lowest, form.highest)
    return codes_to_bits(words & (1 << form.bits) - 1, form.bits).reshape(SAMPLES, -1)


def _lines(model: VotingModel) -> list[str]:
    """Statements of the reference module."""
    lines, signals = _encoder(model.encoder)
    if isinstance(model, LutGroupModel):
        owners: Sequence[int] = model.groups.tolist()
        for number, layer in enumerate(model.layers):
            signals = _tables(lines, f"layer_{number}", layer.mapping.tolist(), layer.tables, signals)
    else:
        mapping, contents = _rams(model)
        owners = np.repeat(np.arange(len(model.classes)), model.rams).tolist()
        signals = _tables(lines, "ram", mapping, contents, signals)
    votes = [
        [s for s, voted in zip(signals, owners, strict=True) if voted == c] for c in range(len(model.classes))
    ]
    width = max(len(word) for word in votes).bit_length()
    for number, word in enumerate(votes):
        lines.append(f"  wire [{width - 1}:0] response_{number} = {plain_sum(word, width)};")
    return [*lines, *winning(len(votes), width, ties=model.ties)]


def _encoder(encoder: Encoder) -> tuple[list[str], list[str]]:
    """Lines and, for each bit of the encoder, its expression; only bits that are read cost anything."""
    if not isinstance(encoder, Thermometer):
        return [], [f"features[{position}]" for position in range(features_width(encoder))]
    form = encoder.input
    assert form is not None
    lines: list[str] = []
    signals: list[str] = []
    for feature, levels in enumerate(encoder.levels):
        low = feature * form.bits
        word = f"features[{low + form.bits - 1}:{low}]"
        shift = f" ^ {form.bits}'h{1 << (form.bits - 1):x}" if form.signed else ""
        lines.append(f"  wire [{form.bits - 1}:0] x_{feature} = {word}{shift};")
        for position, level in enumerate(levels):
            if level > form.highest:
                signals.append("1'b0")
                continue
            name = f"x_{feature}_{position}"
            lines.append(f"  wire {name} = x_{feature} >= {form.bits}'h{level - form.lowest:x};")
            signals.append(name)
    return lines, signals


def _tables(
    lines: list[str],
    prefix: str,
    mapping: Sequence[Sequence[int]],
    contents: NDArray[np.bool_],
    signals: Sequence[str],
) -> list[str]:
    """Add tables to the lines; their outputs."""
    outputs = []
    for number, (inputs, table) in enumerate(zip(mapping, contents, strict=True)):
        address = ["1'b0" if position == ZERO else signals[position] for position in inputs]
        made, answer = lookup(f"{prefix}_{number}", table, address)
        lines += [*made, f"  wire {prefix}_{number} = {answer};"]
        outputs.append(f"{prefix}_{number}")
    return outputs


def _rams(model: WisardModel | SparseWisardModel) -> tuple[list[list[int]], NDArray[np.bool_]]:
    """Mapping and contents of all RAMs, class by class."""
    mapping = [
        inputs
        for owner in range(len(model.classes))
        for inputs in model.mapping[owner if len(model.mapping) > 1 else 0].tolist()
    ]
    if isinstance(model, WisardModel):
        return mapping, (model.counts >= model.bleaching).reshape(len(mapping), -1)
    assert isinstance(model.bleaching, int)
    contents = np.zeros((len(mapping), 1 << model.address_bits), dtype=np.bool_)
    for ram in range(len(mapping)):
        addresses, counts = model.contents(*divmod(ram, model.rams))
        contents[ram, addresses[counts >= model.bleaching].astype(np.int64)] = True
    return mapping, contents
