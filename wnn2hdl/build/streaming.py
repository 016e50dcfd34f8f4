"""Frames through the circuits of a video core: what has to come out of it."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.build.design import Design
from wnn2hdl.errors import InputError
from wnn2hdl.ir import CHANNELS, WINDOW_BITS, bits_to_codes, codes_to_bits
from wnn2hdl.ir.pixel_bits import CHANNEL_BITS
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
    """Pictures as frames that go through the core, one after the other; grey ones if its pixels are."""
    assert design.video is not None
    padded = [design.video.padded(picture) for picture in pictures]
    return Beats.of(
        [design.video.pixels(picture) for picture in padded],
        [design.video.answers(*framed_answers(design, picture)) for picture in padded],
        design.video.pixels_per_clock,
    )


def sample_frames(design: Design) -> Beats:
    """Frames of several sizes on which a core is simulated, of random cared-for pixels.

    Raises:
        InputError: its pixels are grey, and none that is grey is cared for.
    """
    assert design.video is not None
    pixels = _sample_pixels(design)
    rng = np.random.default_rng(_SEED)
    longest = design.video.max_width
    sizes = [(2, longest), *((height, min(width, longest)) for height, width in _SIZES)]
    return beats(design, [pixels[rng.integers(len(pixels), size=size)] for size in sizes])


def _sample_pixels(design: Design) -> NDArray[np.uint8]:
    """Cared-for pixels, uint8 ``[pixels, 3]``: of a core of grey pixels all that are grey."""
    assert design.video is not None
    claim = design.specification.claims["pixel"]
    if design.video.is_mono:
        greys = np.repeat(np.arange(1 << CHANNEL_BITS, dtype=np.uint8)[:, np.newaxis], len(CHANNELS), axis=1)
        cared = claim.cared({"rgb": pixel_bits(greys)}).all(axis=1)
        if not cared.any():
            raise InputError(
                "the care imagery has no grey pixel",
                value="--format mono",
                hint="give grey imagery with --care",
            )
        return greys[cared]
    assert claim.stimulus is not None
    return np.asarray(bits_to_pixels(claim.stimulus()["rgb"])[:, 0])
