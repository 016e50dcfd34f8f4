"""What the edge filter behind a classifier has to compute: it is its RAM of 512 words."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import WINDOW_BITS, EdgeFilter, bits_to_codes
from wnn2hdl.ir.care import CareSet, Everything
from wnn2hdl.ir.wires import Bits
from wnn2hdl.verify import stimulus
from wnn2hdl.verify.reference import care_module, lookup, module
from wnn2hdl.verify.specification import Claim, Mask, Samples, flags_of

PART = "edge"

REFERENCE = f"proof__{PART}"
"""The module of the reference."""

CARE = "proof__care_window"
"""The module that says whether a binary window is cared for."""

EDGE_MASK = {"edge_bit": Mask(CARE, "bits")}
"""Where the edge bit matters."""


def window_care(care: Mapping[str, CareSet]) -> NDArray[np.bool_]:
    """The binary windows that matter, bool ``[512]``; all of them without a care set of the filter."""
    return flags_of(care.get(PART, Everything(WINDOW_BITS)), WINDOW_BITS, "edge filter")


@dataclass(frozen=True, eq=False)
class Edges:
    """An edge filter, and the windows on which a circuit must equal it.

    Attributes:
        filter: the filter.
        care: bool ``[512]``, the binary windows that matter.
    """

    filter: EdgeFilter
    care: NDArray[np.bool_]

    def answers(self, inputs: Samples) -> dict[str, Bits]:
        """``edge_bit`` of ``bits``."""
        return {"edge_bit": self.filter.evaluate(bits_to_codes(inputs["bits"]))[:, np.newaxis]}

    def claim(self) -> Claim:
        """The claim of the circuit ``edge``."""
        return Claim(
            PART,
            {"bits": WINDOW_BITS},
            {"edge_bit": 1},
            REFERENCE,
            self.answers,
            lambda: stimulus.edge(self.care),
            lambda inputs: self.care[bits_to_codes(inputs["bits"])][:, np.newaxis],
            masks=EDGE_MASK,
        )

    def reference(self) -> str:
        """The module `REFERENCE`."""
        lines, answer = lookup("n", self.filter.patterns, [f"bits[{i}]" for i in range(WINDOW_BITS)])
        lines.append(f"  assign edge_bit = {answer};")
        return module(REFERENCE, {"bits": WINDOW_BITS}, {"edge_bit": 1}, lines)


def window_care_module(care: NDArray[np.bool_]) -> str:
    """The module `CARE`, for cared-for windows bool ``[512]``."""
    return care_module(CARE, {"bits": WINDOW_BITS}, "bits", care)
