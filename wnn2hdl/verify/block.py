"""What the circuits of the reference design have to compute: pixel, edge filter, matcher, and block.

The discriminators are those of the model, the edge filter is its 512-word RAM, the matcher counts equal bits
with a plain sum.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import (
    PIXEL_BITS,
    WINDOW_BITS,
    EdgeFilter,
    PixelEncoder,
    WisardModel,
    bits_to_codes,
    codes_to_bits,
    pixel_encoder,
)
from wnn2hdl.ir.care import CareSet, Everything
from wnn2hdl.ir.pixels import bits_to_pixels, pixel_bits, pixels_of_codes
from wnn2hdl.ir.relational import occurring
from wnn2hdl.ir.wires import Bits
from wnn2hdl.verify import stimulus
from wnn2hdl.verify.edge import EDGE_MASK, Edges, window_care, window_care_module
from wnn2hdl.verify.reference import class_bits, lookup, module, pixel_code, plain_sum, winner
from wnn2hdl.verify.specification import Claim, Samples, Specification, flags_of

WINDOW = WINDOW_BITS * PIXEL_BITS
COUNT = WINDOW_BITS.bit_length()


@dataclass(frozen=True, eq=False)
class Block:
    """The model, the edge filter and the inputs on which circuits must equal them.

    Attributes:
        model: a model of single pixels.
        encoder: its encoder.
        edges: the filter behind the nine pixels; None in a design without one.
        pixel_care: bool ``[2**encoder.width]``, the pixel codes that matter.
        window_care: bool ``[512]``, the binary windows on which the edge bit matters.
    """

    model: WisardModel
    encoder: PixelEncoder
    edges: EdgeFilter | None
    pixel_care: NDArray[np.bool_]
    window_care: NDArray[np.bool_]

    def pixel(self, inputs: Samples) -> dict[str, Bits]:
        """``class_bits`` of ``rgb``."""
        return {"class_bits": codes_to_bits(self._classes(inputs["rgb"])[:, 0], class_bits(self.model))}

    def edge(self, inputs: Samples) -> dict[str, Bits]:
        """``edge_bit`` of ``bits``."""
        assert self.edges is not None
        return Edges(self.edges, self.window_care).answers(inputs)

    def match(self, inputs: Samples) -> dict[str, Bits]:
        """``match_count`` of ``bits`` and ``reference_bits``."""
        same = (inputs["bits"] == inputs["reference_bits"]).sum(axis=1, dtype=np.int64)
        return {"match_count": codes_to_bits(same, COUNT)}

    def block(self, inputs: Samples) -> dict[str, Bits]:
        """``bits`` and ``edge_bit`` of ``window``."""
        bits = self._classes(inputs["window"]) != 0
        return {"bits": bits, **self.edge({"bits": bits})}

    def block_match(self, inputs: Samples) -> dict[str, Bits]:
        """``bits``, ``edge_bit`` and ``match_count`` of ``window`` and ``reference_bits``."""
        answers = self.block(inputs)
        matched = {"bits": answers["bits"], "reference_bits": inputs["reference_bits"]}
        return answers | self.match(matched)

    def cared(self, inputs: Samples) -> NDArray[np.bool_]:
        """Which pixels are cared for: bool ``[samples, pixels]``."""
        port = "rgb" if "rgb" in inputs else "window"
        return self.pixel_care[self.encoder.codes(bits_to_pixels(inputs[port]))]

    def edge_matters(self, answers: Samples) -> NDArray[np.bool_]:
        """On which samples the edge bit of a block matters, by its ``bits``: bool ``[samples]``."""
        return self.window_care[bits_to_codes(answers["bits"])]

    def hold(self, inputs: Samples) -> dict[str, Bits]:
        """Replace pixels outside the care set by one fixed pixel inside it."""
        held = dict(inputs)
        for port in {"rgb", "window"} & held.keys():
            pixels = bits_to_pixels(held[port]).copy()
            pixels[~self.pixel_care[self.encoder.codes(pixels)]] = self.cared_pixel()
            held[port] = pixel_bits(pixels)
        return held

    def cared_pixel(self) -> NDArray[np.uint8]:
        """A pixel of the lowest code in the care set that occurs: uint8 ``[3]``."""
        code = np.flatnonzero(self.pixel_care & occurring(self.encoder))[:1]
        return np.asarray(pixels_of_codes(self.encoder, code)[0])

    def _classes(self, pixels: Bits) -> NDArray[np.int64]:
        """Class indices, int64 ``[samples, pixels]``."""
        codes = self.encoder.codes(bits_to_pixels(pixels))
        bits = codes_to_bits(codes.reshape(-1), self.encoder.width)
        return self.model.evaluate(bits).reshape(codes.shape)


def block_specification(
    model: WisardModel, edges: EdgeFilter | None, care: Mapping[str, CareSet]
) -> Specification:
    """The claims of a model of single pixels.

    Args:
        model: the model.
        edges: the edge filter; without one there is no claim about circuits that have one.
        care: the care sets of the circuits ``pixel`` and ``edge``; where one is missing, everything matters.
    """
    encoder = pixel_encoder(model)
    block = Block(
        model,
        encoder,
        edges,
        flags_of(care.get("pixel", Everything(encoder.width)), encoder.width, "pixel"),
        window_care(care),
    )
    claims = [_pixel_claim(block), _match_claim(block)]
    reference = [_pixel(block), _match()]
    if edges is not None:
        edge = Edges(edges, block.window_care)
        claims += [edge.claim(), _block_claim(block), _block_match_claim(block)]
        reference += [edge.reference(), _block(block), _block_match()]
    return Specification({claim.part: claim for claim in claims}, "\n".join(reference), _care(block))


def _reference(part: str) -> str:
    return f"proof__{part}"


def _pixel_claim(block: Block) -> Claim:
    return Claim(
        "pixel",
        {"rgb": PIXEL_BITS},
        {"class_bits": class_bits(block.model)},
        _reference("pixel"),
        block.pixel,
        lambda: stimulus.pixel(block.encoder, block.pixel_care),
        block.cared,
        block.hold,
        ("rgb",),
    )


def _match_claim(block: Block) -> Claim:
    ports = {"bits": WINDOW_BITS, "reference_bits": WINDOW_BITS}
    return Claim("match", ports, {"match_count": COUNT}, _reference("match"), block.match, stimulus.match)


def _block_claim(block: Block) -> Claim:
    return Claim(
        "block",
        {"window": WINDOW},
        {"bits": WINDOW_BITS, "edge_bit": 1},
        _reference("block"),
        block.block,
        None,
        block.cared,
        block.hold,
        ("window",),
        EDGE_MASK,
        {"edge_bit": block.edge_matters},
    )


def _block_match_claim(block: Block) -> Claim:
    def draw() -> dict[str, Bits]:
        window = stimulus.block(block.model, block.encoder, block.pixel_care, block.window_care)
        return stimulus.with_references(window, block.block(window)["bits"])

    return Claim(
        "block_match",
        {"window": WINDOW, "reference_bits": WINDOW_BITS},
        {"bits": WINDOW_BITS, "edge_bit": 1, "match_count": COUNT},
        _reference("block_match"),
        block.block_match,
        draw,
        block.cared,
        block.hold,
        ("window",),
        EDGE_MASK,
        {"edge_bit": block.edge_matters},
    )


def _care(block: Block) -> str:
    """``care_pixel`` passes on a pixel whose code is cared for and replaces any other by one that is.

    So its output runs over all cared-for pixels and no others. ``care_window`` says whether a binary window
    is cared for.
    """
    code_lines, code = pixel_code(block.encoder.names, "free")
    pixel_lines, pixel_cared = lookup("n", block.pixel_care, code)
    pixel_lines[:0] = code_lines
    red, green, blue = block.cared_pixel()
    pixel_lines.append(f"  assign rgb = {pixel_cared} ? free : {{8'd{red}, 8'd{green}, 8'd{blue}}};")
    held = module("proof__care_pixel", {"free": PIXEL_BITS}, {"rgb": PIXEL_BITS}, pixel_lines)
    return held + window_care_module(block.window_care)


def _pixel(block: Block) -> str:
    lines, code = pixel_code(block.encoder.names, "rgb")
    lines += [f"  wire [{len(code) - 1}:0] code = {{{', '.join(reversed(code))}}};", *winner(block.model)]
    claim = _pixel_claim(block)
    return module(claim.module, claim.inputs, claim.outputs, lines)


def _match() -> str:
    count = plain_sum([f"same[{i}]" for i in range(WINDOW_BITS)], COUNT)
    lines = [
        f"  wire [{WINDOW_BITS - 1}:0] same = ~(bits ^ reference_bits);",
        f"  assign match_count = {count};",
    ]
    ports = {"bits": WINDOW_BITS, "reference_bits": WINDOW_BITS}
    return module(_reference("match"), ports, {"match_count": COUNT}, lines)


def _block(block: Block) -> str:
    lines = []
    for pixel in range(WINDOW_BITS):
        low = PIXEL_BITS * pixel
        lines += [
            f"  wire [{class_bits(block.model) - 1}:0] class_{pixel};",
            f"  {_reference('pixel')} pixel_{pixel} "
            f"(.rgb(window[{low + PIXEL_BITS - 1}:{low}]), .class_bits(class_{pixel}));",
            f"  assign bits[{pixel}] = |class_{pixel};",
        ]
    lines.append(f"  {_reference('edge')} edges (.bits(bits), .edge_bit(edge_bit));")
    outputs = {"bits": WINDOW_BITS, "edge_bit": 1}
    return module(_reference("block"), {"window": WINDOW}, outputs, lines)


def _block_match() -> str:
    lines = [
        f"  {_reference('block')} classifiers (.window(window), .bits(bits), .edge_bit(edge_bit));",
        f"  {_reference('match')} matcher "
        "(.bits(bits), .reference_bits(reference_bits), .match_count(match_count));",
    ]
    inputs = {"window": WINDOW, "reference_bits": WINDOW_BITS}
    outputs = {"bits": WINDOW_BITS, "edge_bit": 1, "match_count": COUNT}
    return module(_reference("block_match"), inputs, outputs, lines)
