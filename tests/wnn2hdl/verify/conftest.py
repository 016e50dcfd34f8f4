"""Hand-written circuits of random small models: what the compiler would emit, without the compiler."""

import sys
from types import ModuleType

import numpy as np
import pytest

from wnn2hdl.ir import BitSelect, EdgeFilter, Neighbourhood, Tap, WisardModel, codes_to_bits
from wnn2hdl.verify.specification import NeighbourhoodSpecification, PartName, Specification

ENCODER = BitSelect(("R7", "R6", "G7", "G6", "B7", "B5"))


def random_specification(seed: int, *, classes: int = 2, care: float = 1.0) -> Specification:
    """A model with random RAMs and the given share of its codes and windows cared for."""
    rng = np.random.default_rng(seed)
    rams, address_bits = 5, 3
    model = WisardModel(
        ENCODER,
        tuple(f"class {i}" for i in range(classes)),
        np.stack([rng.permutation(ENCODER.width)[:address_bits] for _ in range(rams)])[np.newaxis],
        rng.integers(0, 3, (classes, rams, 1 << address_bits)),
        bleaching=1,
    )
    windows = codes_to_bits(np.arange(512), 9)
    edge_filter = EdgeFilter("boundary", windows[:, 4] & ~windows.all(axis=1))
    if care == 1.0:
        return Specification.exact(model, edge_filter)
    return Specification(model, edge_filter, rng.random(64) < care, rng.random(512) < care)


def random_neighbourhood(seed: int, *, classes: int = 2, care: float = 1.0) -> NeighbourhoodSpecification:
    """Five random taps, two of them at one pixel, and random RAMs over them."""
    rng = np.random.default_rng(seed)
    names = [("R7", "G6"), ("G6", "B5"), ("R3",), ("R7", "B7", "G2"), ("B0", "G7")]
    places = [(1, 1), (1, 1), (0, 0), (0, 2), (2, 1)]
    taps = tuple(
        Tap.of(row, column, BitSelect(bits), rng.permutation(np.arange(1 << len(bits)) % 2 == 0))
        for bits, (row, column) in zip(names, places, strict=True)
    )
    model = WisardModel(
        Neighbourhood(3, taps),
        tuple(f"class {i}" for i in range(classes)),
        np.array([[[0, 1, 2], [2, 3, 4], [4, 0, 1]]]),
        rng.integers(0, 3, (classes, 3, 8)),
        bleaching=1,
    )
    return NeighbourhoodSpecification(model, rng.random(32) < care)


def emitted_neighbourhood(specification: NeighbourhoodSpecification, *, free: bool = True) -> str:
    """A circuit that equals the model where it is cared for, and answers ``free`` elsewhere."""
    width = specification.class_width
    text = f"module neighbourhood(input [215:0] window, output [{width - 1}:0] class_bits);\n"
    text += "  wire [4:0] code;\n"
    for i, tap in enumerate(specification.encoder.taps):
        low = 24 * (3 * tap.row + tap.column)
        bits = [f"window[{low + place}]" for place in tap.pixel.pixel_positions]
        text += sum_of_products(f"code[{i}]", bits, np.flatnonzero(tap.table).tolist())
    classes = specification.model.evaluate_all_codes()
    for bit in range(width):
        values = np.where(specification.care, classes >> bit & 1, free)
        code = [f"code[{i}]" for i in range(5)]
        text += sum_of_products(f"class_bits[{bit}]", code, np.flatnonzero(values).tolist())
    return text + "endmodule\n"


def sum_of_products(name: str, bits: list[str], codes: list[int]) -> str:
    """An assignment that is true for the given codes."""
    terms = [
        " & ".join(bit if code >> place & 1 else f"~{bit}" for place, bit in enumerate(bits))
        for code in codes
    ]
    # A chain of | is read by Yosys in cubic time.
    joined = ", ".join(terms) or "1'b0"
    return f"  assign {name} = |{{{joined}}};\n"


def emitted(specification: Specification, part: PartName, *, free: bool = True) -> str:
    """A circuit that equals the model where it is cared for, and answers ``free`` elsewhere."""
    if part == "pixel":
        bits = [f"rgb[{place}]" for place in specification.encoder.pixel_positions]
        classes = specification.model.evaluate_all_codes()
        body = ""
        for bit in range(specification.class_width):
            values = np.where(specification.pixel_care, classes >> bit & 1, free)
            body += sum_of_products(f"class_bits[{bit}]", bits, np.flatnonzero(values).tolist())
        width = specification.class_width
        return f"module pixel(input [23:0] rgb, output [{width - 1}:0] class_bits);\n{body}endmodule\n"
    if part == "edge":
        values = np.where(specification.window_care, specification.edge_filter.patterns, free)
        body = sum_of_products("edge_bit", [f"bits[{i}]" for i in range(9)], np.flatnonzero(values).tolist())
        return f"module edge_filter(input [8:0] bits, output edge_bit);\n{body}endmodule\n"
    if part == "match":
        return MATCH
    if part == "block_match":
        return "".join(emitted(specification, below, free=free) for below in ("block", "match")) + BLOCK_MATCH
    text = "".join(emitted(specification, below, free=free) for below in ("pixel", "edge"))
    text += "module block(input [215:0] window, output [8:0] bits, output edge_bit);\n"
    for pixel in range(9):
        text += f"  wire [{specification.class_width - 1}:0] class_{pixel};\n"
        text += f"  pixel pixel_{pixel} (.rgb(window[{24 * pixel} +: 24]), .class_bits(class_{pixel}));\n"
        text += f"  assign bits[{pixel}] = |class_{pixel};\n"
    return text + "  edge_filter edge_filter (.bits(bits), .edge_bit(edge_bit));\nendmodule\n"


BLOCK_MATCH = """\
module block_match(input [215:0] window, input [8:0] reference,
                   output [8:0] bits, output edge_bit, output [3:0] match_count);
  block block (.window(window), .bits(bits), .edge_bit(edge_bit));
  bit_match bit_match (.bits(bits), .reference(reference), .match_count(match_count));
endmodule
"""

MATCH = """\
module bit_match(input [8:0] bits, input [8:0] reference, output [3:0] match_count);
  wire [8:0] same = ~bits ^ reference;
  wire [1:0] low = same[0] + same[1] + same[2];
  wire [1:0] middle = same[3] + same[4] + same[5];
  wire [1:0] high = same[6] + same[7] + same[8];
  assign match_count = {2'd0, low} + {2'd0, middle} + {2'd0, high};
endmodule
"""


@pytest.fixture(scope="session")
def circuits() -> ModuleType:
    """The functions of this file."""
    return sys.modules[__name__]
