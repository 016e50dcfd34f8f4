"""The emitted Verilog: how it reads, that it is clean, and that it computes what the component computes."""

import re
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from amaranth.hdl import Module
from amaranth.lib.wiring import Component, In, Out

from wnn2hdl import elaborate
from wnn2hdl.emit import testbench as write_testbench
from wnn2hdl.emit import vectors, vendor_cells_model, verilog
from wnn2hdl.ir import BitSelect, Cover, Cube, Lut, LutNetwork, Mux
from wnn2hdl.tools import lint_icarus, lint_verilator, run_icarus

ENCODER = BitSelect(("R7", "R6", "G5", "B4"))
PIXEL = Cover(ENCODER.names, ("class_bit0",), (Cube(0b11, 0b01, 1), Cube(0b0100, 0b0100, 1)))
EDGE = Cover(
    tuple(f"bit{i}" for i in range(9)), ("edge_bit",), (Cube(0b10010, 0b10000, 1), Cube(0b110000, 0b10000, 1))
)
NETWORK = LutNetwork(
    ENCODER.names,
    (
        Lut("n0", ("R7", "R6", "G5"), 0b1011_0011),
        Lut("n1", ("B4", "n0"), 0b0110),
        Lut("n2", ("G5",), 0b01),
        Mux("n3", "n0", "n1", "n2"),
    ),
    (("class_bit0", "n3"), ("class_bit1", "n1")),
)
THREE_CLASSES = Cover(
    ENCODER.names, ("class_bit0", "class_bit1"), (Cube(0b11, 0b01, 3), Cube(0b1100, 0b1000, 2))
)
needs_simulator = pytest.mark.skipif(shutil.which("iverilog") is None, reason="Icarus is not installed")

DESIGNS: dict[str, Callable[[], Component]] = {
    "pixel": lambda: elaborate.pixel(ENCODER, PIXEL),
    "cells": lambda: elaborate.pixel(ENCODER, NETWORK, class_count=4, style="cells"),
    "equations": lambda: elaborate.pixel(ENCODER, NETWORK, class_count=4),
    "constant": lambda: elaborate.pixel(ENCODER, Cover(ENCODER.names, ("class_bit0",), ())),
    "pass_through": lambda: elaborate.pixel(ENCODER, LutNetwork(ENCODER.names, (), (("class_bit0", "G5"),))),
    "edge_filter": lambda: elaborate.edge_filter(EDGE),
    "bit_match": elaborate.match,
    "wide_match": lambda: elaborate.match(40),
    "sobel": elaborate.sobel,
    "block": lambda: elaborate.block(ENCODER, PIXEL, EDGE),
    "block_match": lambda: elaborate.block_match(ENCODER, PIXEL, EDGE),
    "three_classes": lambda: elaborate.block(ENCODER, THREE_CLASSES, EDGE, class_count=3),
}


def stimulus(component: Component, count: int) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(3)
    words = {"rgb": (24,), "window": (24,) * 9, "bits": (9,), "reference": (9,)}
    if component.parameters.__class__.__module__.endswith("sobel"):
        words["window"] = (8,) * 9
    if component.parameters.__class__.__module__.endswith("bit_match"):
        words["bits"] = words["reference"] = (1,) * component.parameters.width
    return {
        name: np.stack([rng.integers(0, 1 << bits, count) for bits in words[name]], axis=-1)
        for name, member in component.signature.members.items()
        if member.flow == In
    }


def answers(component: Component, inputs: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    squeezed = [values[:, 0] if values.shape[1] == 1 else values for values in inputs.values()]
    computed = component.parameters.compute(*squeezed)
    if isinstance(computed, dict):
        return computed
    (output,) = [name for name, member in component.signature.members.items() if member.flow == Out]
    return {output: computed}


def test_a_block_reads_like_written_by_hand() -> None:
    text = verilog(DESIGNS["block_match"](), name="block_match", header=["made from a test", ""])
    assert text.startswith("// made from a test\n//\n")
    assert re.findall(r"^module (\w+)", text, re.MULTILINE) == [
        "pixel",
        "edge_filter",
        "block",
        "match_3",
        "compress_3_3_to_4",
        "bit_match",
        "block_match",
    ]
    assert "    wire R7 = rgb[23];\n" in text
    assert "    assign class_bits = (R7 & ~R6) | G5;\n" in text
    assert "    assign edge_bit = (~bits[1] & bits[4]) | (bits[4] & ~bits[5]);\n" in text
    assert "    pixel pixel_8 (.rgb(window[215:192]), .class_bits(pixel_8_class_bits));\n" in text
    assert "    edge_filter edges (.bits(bits), .edge_bit(edge_bit));\n" in text
    assert not re.search(r"\\|\$\d|always|src =", text)
    assert max(map(len, text.splitlines())) <= 120


def test_vendor_cells_are_instances_that_stay() -> None:
    text = verilog(DESIGNS["cells"](), name="pixel", header=[])
    lut = "LUT3 #(.INIT(8'hb3)) n0_cell (.I0(R7), .I1(R6), .I2(G5), .O(n0));"
    assert f'    wire n0;\n    (* DONT_TOUCH = "yes" *) {lut}\n' in text
    assert '(* DONT_TOUCH = "yes" *) MUXF7 n3_cell (.I0(n0), .I1(n1), .S(n2), .O(n3));' in text


@pytest.mark.parametrize("name", ["cells", "bit_match"])
def test_the_same_component_gives_the_same_bytes(name: str) -> None:
    assert verilog(DESIGNS[name](), name=name, header=["x"]) == verilog(
        DESIGNS[name](), name=name, header=["x"]
    )


def test_a_component_with_state_is_refused() -> None:
    class Register(Component):
        def __init__(self) -> None:
            super().__init__({"d": In(1), "q": Out(1)})

        def elaborate(self, platform: object) -> Module:
            m = Module()
            m.d.sync += self.q.eq(self.d)
            return m

    with pytest.raises(NotImplementedError, match="is not combinational"):
        verilog(Register(), name="register", header=[])


def read_before_declared(text: str) -> list[str]:
    """Wires of any module that a statement reads above their declaration."""
    early = []
    for module in text.split("endmodule"):
        seen: set[str] = set()
        declared = set(re.findall(r"^    wire (?:\[\d+:0\] )?(\w+)", module, re.MULTILINE))
        for statement in module.split(";\n"):
            name = re.match(r"\s*wire (?:\[\d+:0\] )?(\w+)", statement)
            seen |= {name[1]} if name else set()
            early += [word for word in re.findall(r"\w+", statement) if word in declared - seen]
    return early


@needs_simulator
@pytest.mark.simulator
@pytest.mark.parametrize("name", DESIGNS)
def test_the_verilog_is_clean_and_computes_what_the_golden_model_does(name: str, tmp_path: Path) -> None:
    component = DESIGNS[name]()
    inputs = stimulus(component, 500)
    design, bench, cells = (tmp_path / file for file in (f"{name}.v", f"{name}_tb.v", "cells_sim.v"))
    text = verilog(component, name=name, header=["x"])
    assert read_before_declared(text) == []
    design.write_text(text)
    cells.write_text(vendor_cells_model())
    bench.write_text(
        write_testbench(component, name=name, count=500, vectors_file="vectors.hex", sources=[f"{name}.v"])
    )
    (tmp_path / "vectors.hex").write_text(vectors(component, inputs, answers(component, inputs)))
    sources = [design, cells] if name == "cells" else [design]
    for files, top in ((sources, name), ([*sources, bench], f"{name}_tb")):
        assert lint_icarus(files, top, timeout=60) == []
        assert lint_verilator(files, top, timeout=60) == []
    assert run_icarus([*sources, bench], f"{name}_tb", cwd=tmp_path, timeout=60).output.startswith(
        f"PASS: {name}, 500 vectors"
    )
