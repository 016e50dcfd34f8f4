"""Frames through the circuits of a video core: what has to come out of it."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.build.design import Design
from wnn2hdl.ir import CHANNELS, WINDOW_BITS, bits_to_codes, codes_to_bits
from wnn2hdl.ir.pixels import bits_to_pixels, pixel_bits
from wnn2hdl.ir.video import Beats
from wnn2hdl.ir.window import framed_window_codes

_SEED = 0
_SIZES = ((12, 17), (1, 5), (5, 1), (3, 2), (12, 17))
"""Heights and widths of the sample frames, behind one with the longest lines.

The last is as high as the core is told, so that it ends without another frame; those before end by the next.
"""


def framed_answers(
    design: Design, picture: NDArray[np.uint8]
) -> tuple[NDArray[np.uint8], NDArray[np.bool_] | None]:
    """What the circuits of a video core answer for a picture.

    Args:
        design: the design of the core.
        picture: uint8 ``[height, width, 3]``.

    Returns:
        The class of each pixel, uint8 ``[height, width]``, and whether it is an edge, bool of the same shape;
        None of a core without edges.
    """
    shape = picture.shape[:2]
    rgb = pixel_bits(picture.reshape(-1, len(CHANNELS)))
    codes = bits_to_codes(design.parts["pixel"].evaluate({"rgb": rgb})["class_bits"])
    classes = np.asarray(codes.reshape(shape), dtype=np.uint8)
    if "edge" not in design.parts:
        return classes, None
    bits = codes_to_bits(framed_window_codes(classes != 0).ravel(), WINDOW_BITS)
    return classes, np.asarray(design.parts["edge"].evaluate({"bits": bits})["edge_bit"].reshape(shape))


def beats(design: Design, pictures: Sequence[NDArray[np.uint8]]) -> Beats:
    """Pictures as frames that go through the core, one after the other."""
    assert design.video is not None
    return Beats.of(
        [design.video.pixels(picture) for picture in pictures],
        [design.video.answers(*framed_answers(design, picture)) for picture in pictures],
    )


def sample_frames(design: Design) -> Beats:
    """Frames of several sizes on which a core is simulated, of random cared-for pixels."""
    assert design.video is not None
    stimulus = design.specification.claims["pixel"].stimulus
    assert stimulus is not None
    pixels = bits_to_pixels(stimulus()["rgb"])[:, 0]
    rng = np.random.default_rng(_SEED)
    longest = design.video.max_width
    sizes = [(2, longest), *((height, min(width, longest)) for height, width in _SIZES)]
    return beats(design, [pixels[rng.integers(len(pixels), size=size)] for size in sizes])
