"""What a gate network has to compute: all outputs of its and-inverter graph."""

import numpy as np

from wnn2hdl.ir.models import LogicModel
from wnn2hdl.ir.wires import Bits
from wnn2hdl.verify.specification import Claim, Samples, Specification

PART = "network"
INPUTS, OUTPUTS = "inputs", "outputs"

MOST_SAMPLES, FEWEST_SAMPLES = 4096, 128
_BITS = 1 << 27
"""Bits of all samples of all gates, about."""


def gates_specification(model: LogicModel) -> Specification:
    """The claim of a gate network, whose reference is the network itself."""

    def answers(inputs: Samples) -> dict[str, Bits]:
        return {OUTPUTS: model.evaluate(inputs[INPUTS])}

    claim = Claim(
        PART,
        {INPUTS: model.width},
        {OUTPUTS: len(model.outputs)},
        f"proof__{PART}",
        answers,
        lambda: {INPUTS: stimulus(model)},
        gates=model,
    )
    return Specification({PART: claim}, "", "")


def stimulus(model: LogicModel) -> Bits:
    """All inputs where these are few; else corners and random ones, fewer of larger networks.

    Corners are all inputs 0, all 1, and in up to half of the samples one that is not as all others.
    """
    size = 1 + model.width + len(model.gates) + len(model.outputs)
    count = min(MOST_SAMPLES, max(FEWEST_SAMPLES, _BITS // size))
    if 1 << min(model.width, 30) <= count:
        return (np.arange(1 << model.width)[:, np.newaxis] >> np.arange(model.width) & 1).astype(np.bool_)
    bits = np.random.default_rng(0).random((count, model.width)) < 0.5
    corners = min(model.width, count // 4 - 1)
    chosen = np.linspace(0, model.width - 1, corners).astype(np.int64)
    single = np.zeros((corners + 1, model.width), dtype=np.bool_)
    single[1 + np.arange(corners), chosen] = True
    bits[: 2 * len(single)] = np.concatenate([single, ~single])
    return bits
