"""What a whole network has to compute: encoder, tables, votes and winner, as the model defines them."""

from itertools import pairwise

import numpy as np

from wnn2hdl.ir import Thermometer, ThermometerBits, codes_to_bits
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.encoder import Encoder
from wnn2hdl.ir.models import NetworkModel
from wnn2hdl.ir.wires import Bits
from wnn2hdl.verify.network_lines import encoder_lines, features_width, owners_of, positions_read, table_lines
from wnn2hdl.verify.network_pieces import Pieces
from wnn2hdl.verify.reference import class_bits, module, plain_sum, winning
from wnn2hdl.verify.specification import Claim, Mask, Samples, Specification

PART = "network"
SAMPLES = 10_240
"""Feature vectors that a network is simulated on: random ones, and ones beside thresholds."""

_FEWEST_SAMPLES = 512
_WORK = 1 << 20
"""Tables and bits of the encoder times vectors, above which there are fewer vectors down to the fewest."""


def network_specification(model: NetworkModel, circuit: Circuit | None = None) -> Specification:
    """The claim of a model whose tables vote for classes.

    Args:
        model: the model.
        circuit: the network made from it, if it is to be proved piece by piece.

    Raises:
        InputError: the model states no format of its features.
        ValueError: the circuit is not made of the pieces of the model's.
    """
    width = class_bits(model)
    encoder = model.encoder

    def answers(inputs: Samples) -> dict[str, Bits]:
        return {"class_bits": codes_to_bits(model.evaluate(encoder_bits(encoder, inputs["features"])), width)}

    masks, care = {}, ""
    if isinstance(encoder, ThermometerBits):
        masks = {"class_bits": Mask(f"proof__care_{PART}", "features")}
        care = module(masks["class_bits"].module, {"features": encoder.width}, {"cared": 1}, _falls(encoder))
    size = len(owners_of(model)) + len(positions_read(model))
    samples = min(SAMPLES, max(_FEWEST_SAMPLES, _WORK // size))
    claim = Claim(
        PART,
        {"features": features_width(encoder)},
        {"class_bits": width},
        f"proof__{PART}",
        answers,
        lambda: {"features": stimulus(encoder, samples)},
        masks=masks,
    )
    reference = module(claim.module, claim.inputs, claim.outputs, _lines(model))
    if circuit is None:
        return Specification({PART: claim}, reference, care)
    pieces = Pieces(model, circuit)
    return Specification({PART: claim}, reference + pieces.composition.reference, care, pieces.composition)


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


def stimulus(encoder: Encoder, samples: int = SAMPLES) -> Bits:
    """Values of ``features``: half random, half with every feature at one of its thresholds or just below.

    Of thermometer bits all are random, but occur together.
    """
    rng = np.random.default_rng(0)
    if isinstance(encoder, ThermometerBits):
        reached = rng.integers(0, encoder.levels + 1, (samples, encoder.thermometers))
        return np.concatenate([reached > level for level in range(encoder.levels)], axis=1)
    if not isinstance(encoder, Thermometer):
        return rng.random((samples, features_width(encoder))) < 0.5
    form = encoder.input
    assert form is not None
    words = rng.integers(form.lowest, form.highest + 1, size=(samples, encoder.features))
    for feature, levels in enumerate(encoder.levels):
        if levels:
            beside = rng.choice(np.array(levels), samples // 2) - rng.integers(0, 2, samples // 2)
            words[: samples // 2, feature] = np.clip(beside, form.lowest, form.highest)
    return codes_to_bits(words & (1 << form.bits) - 1, form.bits).reshape(samples, -1)


def _lines(model: NetworkModel) -> list[str]:
    """Statements of the reference module."""
    lines, signals = encoder_lines(model.encoder, positions_read(model))
    made, fires = table_lines(model, signals)
    lines += made
    votes = [
        [fires[voter] for voter, voted in enumerate(owners_of(model)) if voted == c]
        for c in range(len(model.classes))
    ]
    width = max(len(word) for word in votes).bit_length()
    for number, word in enumerate(votes):
        lines.append(f"  wire [{width - 1}:0] response_{number} = {plain_sum(word, width)};")
    return [*lines, *winning(len(votes), width, ties=model.ties)]


def _falls(encoder: ThermometerBits) -> list[str]:
    """Statements of the module that knows which bits can occur together."""
    lines = ["  wire hole_0 = 1'b0;"]
    for bits in encoder.falling:
        for before, after in pairwise(bits):
            last = len(lines) - 1
            lines.append(f"  wire hole_{last + 1} = hole_{last} | features[{after}] & ~features[{before}];")
    return [*lines, f"  assign cared = ~hole_{len(lines) - 1};"]
