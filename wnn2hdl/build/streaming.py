"""Frames through the circuits of a video core: what has to come out of it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.build.design import Design
from wnn2hdl.evaluation.squares import vote
from wnn2hdl.ir import CHANNELS, WINDOW_BITS, Context, Neighbourhood, bits_to_codes, codes_to_bits
from wnn2hdl.ir.context import box_sums
from wnn2hdl.ir.pixel_bits import CHANNEL_BITS
from wnn2hdl.ir.pixels import bits_to_pixels, pixel_bits
from wnn2hdl.ir.video import Beats
from wnn2hdl.ir.window import framed_window_codes
from wnn2hdl.ir.wires import Bits
from wnn2hdl.verify.specification import Samples

_SEED = 0
_SIZES = ((12, 17), (1, 5), (5, 1), (3, 2), (12, 17))
"""Heights and widths of the sample frames, behind one with the longest lines.

The last is as high as the core is told, so that it ends without another frame; those before end by the next.
"""


@dataclass(frozen=True, eq=False)
class Framed:
    """What the circuits of a video core make of a picture, as a frame.

    Attributes:
        classes: of each pixel, uint8 ``[height, width]``.
        edges: whether it is an edge, bool of the same shape; None of a core without edges.
        samples: what each circuit is given, and what it answers, pixel by pixel, by the circuit's name.
    """

    classes: NDArray[np.uint8]
    edges: NDArray[np.bool_] | None
    samples: Mapping[str, tuple[Samples, Samples]]


def framed_answers(design: Design, picture: NDArray[np.uint8]) -> Framed:
    """What the circuits of a video core answer for a picture.

    Args:
        design: the design of the core.
        picture: uint8 ``[height, width, 3]``.
    """
    shape = picture.shape[:2]
    samples: dict[str, tuple[Samples, Samples]] = {}

    def answer(part: str, inputs: Samples) -> Samples:
        samples[part] = inputs, design.parts[part].evaluate(inputs)
        return samples[part][1]

    rgb = {"rgb": pixel_bits(picture.reshape(-1, len(CHANNELS)))}
    around = design.surroundings
    if around is None:
        found = answer("pixel", rgb)["class_bits"]
    elif isinstance(around, Neighbourhood):
        seen = answer("taps", rgb)["tap_bits"].reshape(*shape, -1)
        found = answer("decision", {"code": _codes(around, seen)})["class_bits"]
    else:
        seen = answer("planes", rgb)["plane_bits"].reshape(*shape, -1)
        found = answer("context", {"counts": _counts(around, seen)})["class_bits"]
    classes = bits_to_codes(found).reshape(shape).astype(np.uint8)
    edges = None
    if "edge" in design.parts:
        bits = codes_to_bits(framed_window_codes(classes != 0).ravel(), WINDOW_BITS)
        edges = np.asarray(answer("edge", {"bits": bits})["edge_bit"].reshape(shape))
    return Framed(classes, edges, samples)


def _codes(neighbourhood: Neighbourhood, seen: Bits) -> Bits:
    """The codes of the windows around all pixels, bool ``[pixels, taps]``.

    Args:
        neighbourhood: the encoder.
        seen: what its tables answer for each pixel, bool ``[height, width, tables]``.
    """
    halo, (height, width) = neighbourhood.halo, seen.shape[:2]
    padded = np.pad(seen, ((halo, halo), (halo, halo), (0, 0)), mode="edge")
    columns = [
        padded[tap.row : tap.row + height, tap.column : tap.column + width, source].ravel()
        for tap, source in zip(neighbourhood.taps, neighbourhood.sources, strict=True)
    ]
    return np.stack(columns, axis=1)


def _counts(context: Context, seen: Bits) -> Bits:
    """What is counted around all pixels, bool ``[pixels, bits of all sums]``.

    Args:
        context: the encoder.
        seen: its planes, bool ``[height, width, planes]``.
    """
    words = []
    for (plane, size), width in zip(context.sums, context.widths, strict=True):
        framed = np.pad(seen[..., context.planes.index(plane)], size // 2, mode="edge")
        words.append(codes_to_bits(box_sums(framed, size).ravel(), width))
    return np.concatenate(words, axis=1)


def beats(design: Design, pictures: Sequence[NDArray[np.uint8]]) -> Beats:
    """Pictures as frames that go through the core, one after the other; grey ones if its pixels are."""
    assert design.video is not None
    padded = [design.video.padded(picture) for picture in pictures]
    framed = [framed_answers(design, picture) for picture in padded]
    return Beats.of(
        [design.video.pixels(picture) for picture in padded],
        [design.video.answers(answers.classes, answers.edges) for answers in framed],
        design.video.pixels_per_clock,
        [] if design.video.square is None else [_majorities(design, answers.classes) for answers in framed],
    )


def _majorities(design: Design, classes: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The majority of each square of a picture of classes, uint8 ``[rows, columns]``."""
    assert design.video is not None
    assert design.video.square is not None
    side, count = design.video.square, len(design.picture_model.classes)
    return vote(classes, None, side=side, share=1.0, seed=0, count=count)[::side, ::side]


def sample_frames(design: Design) -> Beats:
    """Frames of several sizes on which a core is simulated, of random cared-for pixels."""
    assert design.video is not None
    pixels = _sample_pixels(design)
    rng = np.random.default_rng(_SEED)
    longest = design.video.max_width
    sizes = [(2, longest), *((height, min(width, longest)) for height, width in _SIZES)]
    return beats(design, [pixels[rng.integers(len(pixels), size=size)] for size in sizes])


def _sample_pixels(design: Design) -> NDArray[np.uint8]:
    """Cared-for pixels, uint8 ``[pixels, 3]``: of a core of grey pixels all that are grey.

    Of models that look around a pixel those that the circuit of single pixels tells apart.
    """
    assert design.video is not None
    claims = design.specification.claims
    claim = next(claims[part] for part in ("pixel", "taps", "planes") if part in claims)
    if design.video.is_mono:
        greys = np.repeat(np.arange(1 << CHANNEL_BITS, dtype=np.uint8)[:, np.newaxis], len(CHANNELS), axis=1)
        return greys[claim.cared({"rgb": pixel_bits(greys)}).all(axis=1)]
    assert claim.stimulus is not None
    return np.asarray(bits_to_pixels(claim.stimulus()["rgb"])[:, 0])
