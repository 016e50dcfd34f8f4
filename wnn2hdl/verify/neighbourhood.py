"""What the classifier of a pixel and its neighbours has to compute."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import CHANNELS, PIXEL_BITS, Neighbourhood, WisardModel, codes_to_bits
from wnn2hdl.ir.care import CareSet, Everything
from wnn2hdl.ir.pixels import bits_to_pixels
from wnn2hdl.ir.wires import Bits
from wnn2hdl.verify import stimulus
from wnn2hdl.verify.reference import class_bits, lookup, module, winner
from wnn2hdl.verify.specification import Claim, Mask, Samples, Specification, flags_of

PART = "neighbourhood"


@dataclass(frozen=True, eq=False)
class Neighbours:
    """A model of a pixel and its neighbours, and the inputs on which a circuit must equal it.

    Attributes:
        model: the model.
        encoder: its encoder.
        care: bool ``[2**encoder.width]``, the codes of windows that matter.
    """

    model: WisardModel
    encoder: Neighbourhood
    care: NDArray[np.bool_]

    def answers(self, inputs: Samples) -> dict[str, Bits]:
        """``class_bits`` of ``window``."""
        bits = codes_to_bits(self.codes(inputs["window"]), self.encoder.width)
        return {"class_bits": codes_to_bits(self.model.evaluate(bits), class_bits(self.model))}

    def cared(self, inputs: Samples) -> NDArray[np.bool_]:
        """Which windows are cared for: bool ``[samples, 1]``."""
        return self.care[self.codes(inputs["window"])][:, np.newaxis]

    def codes(self, window: Bits) -> NDArray[np.uint32]:
        """Codes of windows: uint32 ``[samples]``."""
        size = self.encoder.size
        return self.encoder.codes(bits_to_pixels(window).reshape(-1, size, size, len(CHANNELS)))[:, 0, 0]


def neighbourhood_specification(
    model: WisardModel, encoder: Neighbourhood, care: Mapping[str, CareSet]
) -> Specification:
    """The claim of a model of neighbourhoods; where the care set is missing, everything matters."""
    flags = flags_of(care.get(PART, Everything(encoder.width)), encoder.width, PART)
    neighbours = Neighbours(model, encoder, flags)
    claim = Claim(
        PART,
        {"window": encoder.size**2 * PIXEL_BITS},
        {"class_bits": class_bits(model)},
        f"proof__{PART}",
        neighbours.answers,
        lambda: stimulus.neighbourhood(encoder, flags),
        neighbours.cared,
        masks={"class_bits": Mask("proof__care_neighbourhood", "window")},
    )
    reference = module(claim.module, claim.inputs, claim.outputs, [*_window_code(encoder), *winner(model)])
    return Specification({PART: claim}, reference, _care(claim, encoder, flags))


def _care(claim: Claim, encoder: Neighbourhood, flags: NDArray[np.bool_]) -> str:
    """``care_neighbourhood`` says whether a window is cared for."""
    lines, cared = lookup("n", flags, [f"code[{i}]" for i in range(encoder.width)])
    lines = [*_window_code(encoder), *lines, f"  assign cared = {cared};"]
    return module("proof__care_neighbourhood", claim.inputs, {"cared": 1}, lines)


def _window_code(encoder: Neighbourhood) -> list[str]:
    """Lines that make the wire ``code`` of a window: each tap's table at its pixel."""
    lines, bits = [], []
    for i, tap in enumerate(encoder.taps):
        low = PIXEL_BITS * (encoder.size * tap.row + tap.column)
        address = [f"window[{low + position}]" for position in tap.pixel.pixel_positions]
        tap_lines, bit = lookup(f"tap_{i}", tap.table, address)
        lines += tap_lines
        bits.append(bit)
    return [*lines, f"  wire [{encoder.width - 1}:0] code = {{{', '.join(reversed(bits))}}};"]
