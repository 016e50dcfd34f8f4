"""What the classifier of a pixel and its neighbours has to compute, as a whole and in two parts.

The parts are those between the registers of a video core: ``taps``, what is seen of each pixel, and
``decision``, the class by what is seen of the pixels of a window.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import (
    CHANNELS,
    PIXEL_BITS,
    EdgeFilter,
    Neighbourhood,
    Tap,
    WisardModel,
    bits_to_codes,
    codes_to_bits,
)
from wnn2hdl.ir.care import CareSet, Everything
from wnn2hdl.ir.pixels import bits_to_pixels
from wnn2hdl.ir.wires import Bits
from wnn2hdl.verify import stimulus
from wnn2hdl.verify.edge import Edges, window_care, window_care_module
from wnn2hdl.verify.reference import care_module, class_bits, lookup, module, winner
from wnn2hdl.verify.specification import Claim, Mask, Samples, Specification, flags_of

PART, TAPS, DECISION = "neighbourhood", "taps", "decision"

_CARE_WINDOW, _CARE_CODE = f"proof__care_{PART}", f"proof__care_{DECISION}"


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
        return self.classes({"code": codes_to_bits(self.codes(inputs["window"]), self.encoder.width)})

    def classes(self, inputs: Samples) -> dict[str, Bits]:
        """``class_bits`` of ``code``."""
        return {"class_bits": codes_to_bits(self.model.evaluate(inputs["code"]), class_bits(self.model))}

    def seen(self, inputs: Samples) -> dict[str, Bits]:
        """``tap_bits`` of ``rgb``."""
        pixels = bits_to_pixels(inputs["rgb"])[:, 0]
        columns = [tap.table[tap.pixel.codes(pixels)] for tap in self.encoder.tables]
        return {"tap_bits": np.stack(columns, axis=1)}

    def cared(self, inputs: Samples) -> NDArray[np.bool_]:
        """Which windows are cared for: bool ``[samples, 1]``."""
        return self.care[self.codes(inputs["window"])][:, np.newaxis]

    def codes(self, window: Bits) -> NDArray[np.uint32]:
        """Codes of windows: uint32 ``[samples]``."""
        size = self.encoder.size
        return self.encoder.codes(bits_to_pixels(window).reshape(-1, size, size, len(CHANNELS)))[:, 0, 0]


def neighbourhood_specification(
    model: WisardModel, edges: EdgeFilter | None, encoder: Neighbourhood, care: Mapping[str, CareSet]
) -> Specification:
    """The claims of a model of neighbourhoods.

    Args:
        model: the model.
        edges: the edge filter on its classes; without one there is no claim about it.
        encoder: the model's.
        care: the care sets of the circuits ``neighbourhood`` or ``decision``, whose codes are the same, and
            ``edge``; where one is missing, everything matters.
    """
    allowed = care.get(PART) or care.get(DECISION) or Everything(encoder.width)
    flags = flags_of(allowed, encoder.width, PART)
    neighbours = Neighbours(model, encoder, flags)
    claim = Claim(
        PART,
        {"window": encoder.size**2 * PIXEL_BITS},
        {"class_bits": class_bits(model)},
        f"proof__{PART}",
        neighbours.answers,
        lambda: stimulus.neighbourhood(encoder, flags),
        neighbours.cared,
        masks={"class_bits": Mask(_CARE_WINDOW, "window")},
    )
    taps = Claim(
        TAPS,
        {"rgb": PIXEL_BITS},
        {"tap_bits": len(encoder.tables)},
        f"proof__{TAPS}",
        neighbours.seen,
        lambda: stimulus.taps(encoder),
    )
    decision = Claim(
        DECISION,
        {"code": encoder.width},
        claim.outputs,
        f"proof__{DECISION}",
        neighbours.classes,
        lambda: {"code": codes_to_bits(np.flatnonzero(flags), encoder.width)},
        lambda inputs: flags[bits_to_codes(inputs["code"])][:, np.newaxis],
        masks={"class_bits": Mask(_CARE_CODE, "code")},
    )
    tap_lines, bits = _tap_bits(encoder.tables, "rgb", [0] * len(encoder.tables))
    reference = [
        module(claim.module, claim.inputs, claim.outputs, [*_window_code(encoder), *winner(model)]),
        module(taps.module, taps.inputs, taps.outputs, [*tap_lines, f"  assign tap_bits = {bits};"]),
        module(decision.module, decision.inputs, claim.outputs, winner(model)),
    ]
    cared = [
        care_module(_CARE_WINDOW, claim.inputs, "code", flags, _window_code(encoder)),
        care_module(_CARE_CODE, decision.inputs, "code", flags),
    ]
    claims = [claim, taps, decision]
    if edges is not None:
        edge = Edges(edges, window_care(care))
        claims.append(edge.claim())
        reference.append(edge.reference())
        cared.append(window_care_module(edge.care))
    return Specification({part.part: part for part in claims}, "\n".join(reference), "\n".join(cared))


def _window_code(encoder: Neighbourhood) -> list[str]:
    """Lines that make the wire ``code`` of a window: each tap's table at its pixel."""
    lines, bits = _tap_bits(
        encoder.taps,
        "window",
        [PIXEL_BITS * (encoder.size * tap.row + tap.column) for tap in encoder.taps],
    )
    return [*lines, f"  wire [{encoder.width - 1}:0] code = {bits};"]


def _tap_bits(taps: Sequence[Tap], word: str, lows: Sequence[int]) -> tuple[list[str], str]:
    """Lines, and the answers of taps side by side, whose pixels lie in a word from these bits on."""
    lines, bits = [], []
    for i, (tap, low) in enumerate(zip(taps, lows, strict=True)):
        address = [f"{word}[{low + position}]" for position in tap.pixel.pixel_positions]
        tap_lines, bit = lookup(f"tap_{i}", tap.table, address)
        lines += tap_lines
        bits.append(bit)
    return lines, f"{{{', '.join(reversed(bits))}}}"
