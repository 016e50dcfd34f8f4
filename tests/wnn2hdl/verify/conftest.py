"""Hand-written circuits of random small models: what the compiler would emit, without the compiler."""

import sys
import tempfile
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from wnn2hdl.ir import BitSelect, EdgeFilter, Neighbourhood, Tap, WisardModel, codes_to_bits
from wnn2hdl.ir.care import Codes
from wnn2hdl.tools import find_yosys
from wnn2hdl.verify.block import Block
from wnn2hdl.verify.equivalence import Circuit
from wnn2hdl.verify.neighbourhood import Neighbours
from wnn2hdl.verify.specification import Specification
from wnn2hdl.verify.specify import specify

ENCODER = BitSelect(("R7", "R6", "G7", "G6", "B7", "B5"))

PARTS = ("pixel", "edge", "match", "block", "block_match")


def random_block(seed: int, *, classes: int = 2, care: float = 1.0) -> Block:
    """A model with random RAMs, and the given share of its codes and windows cared for."""
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
    edges = EdgeFilter("boundary", windows[:, 4] & ~windows.all(axis=1))
    if care == 1.0:
        return Block(model, ENCODER, edges, np.ones(64, dtype=np.bool_), np.ones(512, dtype=np.bool_))
    return Block(model, ENCODER, edges, rng.random(64) < care, rng.random(512) < care)


def random_neighbours(seed: int, *, classes: int = 2, care: float = 1.0) -> Neighbours:
    """Five random taps, two of them at one pixel, and random RAMs over them."""
    rng = np.random.default_rng(seed)
    names = [("R7", "G6"), ("G6", "B5"), ("R3",), ("R7", "B7", "G2"), ("B0", "G7")]
    places = [(1, 1), (1, 1), (0, 0), (0, 2), (2, 1)]
    taps = tuple(
        Tap.of(row, column, BitSelect(bits), rng.permutation(np.arange(1 << len(bits)) % 2 == 0))
        for bits, (row, column) in zip(names, places, strict=True)
    )
    encoder = Neighbourhood(3, taps)
    model = WisardModel(
        encoder,
        tuple(f"class {i}" for i in range(classes)),
        np.array([[[0, 1, 2], [2, 3, 4], [4, 0, 1]]]),
        rng.integers(0, 3, (classes, 3, 8)),
        bleaching=1,
    )
    return Neighbours(model, encoder, rng.random(32) < care)


def specification(of: Block | Neighbours) -> Specification:
    """What circuits have to compute that are cared for as stated."""
    if isinstance(of, Neighbours):
        return specify(of.model, None, {"neighbourhood": Codes(of.care)})
    return specify(of.model, of.edges, {"pixel": Codes(of.pixel_care), "edge": Codes(of.window_care)})


def exact(of: Block | Neighbours) -> Specification:
    """The same, cared for everywhere."""
    return specify(of.model, None if isinstance(of, Neighbours) else of.edges, {})


def emitted(of: Block | Neighbours, part: str, *, free: bool = True) -> str:
    """Verilog that equals the model where it is cared for, and answers ``free`` elsewhere."""
    if isinstance(of, Neighbours):
        return _neighbourhood(of, free)
    if part == "pixel":
        return _pixel(of, free)
    if part == "edge":
        assert of.edges is not None
        values = np.where(of.window_care, of.edges.patterns, free)
        body = sum_of_products("edge_bit", [f"bits[{i}]" for i in range(9)], np.flatnonzero(values).tolist())
        return f"module edge_filter(input [8:0] bits, output edge_bit);\n{body}endmodule\n"
    if part == "match":
        return MATCH
    if part == "block_match":
        return "".join(emitted(of, below, free=free) for below in ("block", "match")) + BLOCK_MATCH
    text = "".join(emitted(of, below, free=free) for below in ("pixel", "edge"))
    text += "module block(input [215:0] window, output [8:0] bits, output edge_bit);\n"
    for pixel in range(9):
        text += f"  wire [{class_width(of) - 1}:0] class_{pixel};\n"
        text += f"  pixel pixel_{pixel} (.rgb(window[{24 * pixel} +: 24]), .class_bits(class_{pixel}));\n"
        text += f"  assign bits[{pixel}] = |class_{pixel};\n"
    return text + "  edge_filter edge_filter (.bits(bits), .edge_bit(edge_bit));\nendmodule\n"


def circuit(of: Block | Neighbours, part: str, *, free: bool = True) -> Circuit:
    """`emitted`, ready to be proved."""
    return as_circuit(part, emitted(of, part, free=free))


def as_circuit(part: str, text: str) -> Circuit:
    """A text that holds the module of a part."""
    return Circuit((text,), {"edge": "edge_filter", "match": "bit_match"}.get(part, part))


def mapped(circuit: Circuit) -> Circuit:
    """The netlist of 7-series cells that Yosys maps a circuit to."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "source.v").write_text(circuit.sources[0], encoding="utf-8")
        find_yosys().run(
            f"read_verilog source.v\nsynth_xilinx -family xc7 -flatten -noiopad -top {circuit.top}\n"
            "write_verilog -noattr netlist.v\n",
            timeout=60,
            cwd=folder,
        )
        return replace(circuit, sources=((folder / "netlist.v").read_text(encoding="utf-8"),))


def class_width(of: Block | Neighbours) -> int:
    """Bits of a class index."""
    return (len(of.model.classes) - 1).bit_length()


def sum_of_products(name: str, bits: list[str], codes: list[int]) -> str:
    """An assignment that is true for the given codes."""
    terms = [
        " & ".join(bit if code >> place & 1 else f"~{bit}" for place, bit in enumerate(bits))
        for code in codes
    ]
    # A chain of | is read by Yosys in cubic time.
    joined = ", ".join(terms) or "1'b0"
    return f"  assign {name} = |{{{joined}}};\n"


def _pixel(of: Block, free: bool) -> str:
    assert isinstance(of.encoder, BitSelect)
    bits = [f"rgb[{place}]" for place in of.encoder.pixel_positions]
    classes = of.model.evaluate_all_codes()
    body = ""
    for bit in range(class_width(of)):
        values = np.where(of.pixel_care, classes >> bit & 1, free)
        body += sum_of_products(f"class_bits[{bit}]", bits, np.flatnonzero(values).tolist())
    ports = f"input [23:0] rgb, output [{class_width(of) - 1}:0] class_bits"
    return f"module pixel({ports});\n{body}endmodule\n"


def _neighbourhood(of: Neighbours, free: bool) -> str:
    text = f"module neighbourhood(input [215:0] window, output [{class_width(of) - 1}:0] class_bits);\n"
    text += "  wire [4:0] code;\n"
    for i, tap in enumerate(of.encoder.taps):
        low = 24 * (3 * tap.row + tap.column)
        bits = [f"window[{low + place}]" for place in tap.pixel.pixel_positions]
        text += sum_of_products(f"code[{i}]", bits, np.flatnonzero(tap.table).tolist())
    classes = of.model.evaluate_all_codes()
    for bit in range(class_width(of)):
        values = np.where(of.care, classes >> bit & 1, free)
        code = [f"code[{i}]" for i in range(5)]
        text += sum_of_products(f"class_bits[{bit}]", code, np.flatnonzero(values).tolist())
    return text + "endmodule\n"


BLOCK_MATCH = """\
module block_match(input [215:0] window, input [8:0] reference_bits,
                   output [8:0] bits, output edge_bit, output [3:0] match_count);
  block block (.window(window), .bits(bits), .edge_bit(edge_bit));
  bit_match bit_match (.bits(bits), .reference_bits(reference_bits), .match_count(match_count));
endmodule
"""

MATCH = """\
module bit_match(input [8:0] bits, input [8:0] reference_bits, output [3:0] match_count);
  wire [8:0] same = ~bits ^ reference_bits;
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
