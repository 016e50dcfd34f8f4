"""What the circuits of a classifier that counts bits in squares have to compute.

They are those between the registers of a video core: ``planes``, the bits of each pixel, and ``context``, the
class by what was counted.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import PIXEL_BITS, Context, EdgeFilter, WisardModel, bits_to_codes, codes_to_bits
from wnn2hdl.ir.care import CareSet, Everything
from wnn2hdl.ir.pixels import bits_to_pixels
from wnn2hdl.ir.relational import pixel_codes
from wnn2hdl.ir.wires import Bits
from wnn2hdl.verify import stimulus
from wnn2hdl.verify.edge import Edges, window_care, window_care_module
from wnn2hdl.verify.reference import care_module, class_bits, module, pixel_code, winner
from wnn2hdl.verify.specification import Claim, Mask, Samples, Specification, flags_of

PLANES, CONTEXT = "planes", "context"

_CARE = "proof__care_context"


@dataclass(frozen=True, eq=False)
class Surroundings:
    """A model that counts around a pixel, and the inputs on which a circuit must equal it.

    Attributes:
        model: the model.
        encoder: its encoder.
        care: bool ``[2**encoder.width]``, the codes that matter.
    """

    model: WisardModel
    encoder: Context
    care: NDArray[np.bool_]

    def planes(self, inputs: Samples) -> dict[str, Bits]:
        """``plane_bits`` of ``rgb``."""
        pixels = bits_to_pixels(inputs["rgb"])[:, 0]
        names = self.encoder.planes
        return {"plane_bits": codes_to_bits(pixel_codes(names, pixels), len(names))}

    def classes(self, inputs: Samples) -> dict[str, Bits]:
        """``class_bits`` of ``counts``."""
        bits = codes_to_bits(self.codes(inputs), self.encoder.width)
        return {"class_bits": codes_to_bits(self.model.evaluate(bits), class_bits(self.model))}

    def cared(self, inputs: Samples) -> NDArray[np.bool_]:
        """Which ``counts`` have a code that is cared for: bool ``[samples, 1]``."""
        return self.care[self.codes(inputs)][:, np.newaxis]

    def codes(self, inputs: Samples) -> NDArray[np.uint32]:
        """Codes of ``counts``: uint32 ``[samples]``."""
        words = np.split(inputs["counts"], np.cumsum(self.encoder.widths)[:-1], axis=1)
        return self.encoder.compared([bits_to_codes(word) for word in words])

    def stimulus(self) -> dict[str, Bits]:
        """Cared-for ``counts``."""
        inputs = stimulus.counts(self.encoder)
        return {"counts": inputs["counts"][self.cared(inputs)[:, 0]]}


def context_specification(
    model: WisardModel, edges: EdgeFilter | None, encoder: Context, care: Mapping[str, CareSet]
) -> Specification:
    """The claims of a model that counts.

    Args:
        model: the model.
        edges: the edge filter on its classes; without one there is no claim about it.
        encoder: the model's.
        care: the care sets of the circuits ``context`` and ``edge``; where one is missing, everything
            matters.
    """
    flags = flags_of(care.get(CONTEXT, Everything(encoder.width)), encoder.width, CONTEXT)
    around = Surroundings(model, encoder, flags)
    planes = Claim(
        PLANES,
        {"rgb": PIXEL_BITS},
        {"plane_bits": len(encoder.planes)},
        f"proof__{PLANES}",
        around.planes,
        stimulus.pixels,
    )
    context = Claim(
        CONTEXT,
        {"counts": sum(encoder.widths)},
        {"class_bits": class_bits(model)},
        f"proof__{CONTEXT}",
        around.classes,
        around.stimulus,
        around.cared,
        masks={"class_bits": Mask(_CARE, "counts")},
    )
    plane_lines, bits = pixel_code(encoder.planes, "rgb")
    plane_lines.append(f"  assign plane_bits = {{{', '.join(reversed(bits))}}};")
    reference = [
        module(planes.module, planes.inputs, planes.outputs, plane_lines),
        module(context.module, context.inputs, context.outputs, [_code(encoder), *winner(model)]),
    ]
    care_text = [care_module(_CARE, context.inputs, "code", flags, [_code(encoder)])]
    claims = [planes, context]
    if edges is not None:
        edge = Edges(edges, window_care(care))
        claims.append(edge.claim())
        reference.append(edge.reference())
        care_text.append(window_care_module(edge.care))
    return Specification({claim.part: claim for claim in claims}, "\n".join(reference), "\n".join(care_text))


def _code(encoder: Context) -> str:
    """A line that makes the wire ``code`` of ``counts``: each sum against its threshold."""
    words = {}
    low = 0
    for sum_of, width in zip(encoder.sums, encoder.widths, strict=True):
        words[sum_of] = f"counts[{low + width - 1}:{low}]"
        low += width
    bits = [f"({words[count.plane, count.size]} >= {count.least})" for count in encoder.counts]
    return f"  wire [{encoder.width - 1}:0] code = {{{', '.join(reversed(bits))}}};"
