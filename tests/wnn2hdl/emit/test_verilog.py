# amaranth: UnusedElaboratable=no
"""The emitted Verilog: how it reads, that it is clean, and that it is what the component is."""

import re
import shutil
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from amaranth.back import rtlil
from amaranth.hdl import ClockDomain, Module
from amaranth.lib.memory import Memory
from amaranth.lib.wiring import In, Out
from hypothesis import given, settings
from hypothesis import strategies as st

from hdl_templates import sobel
from hdl_templates.hierarchy import Part
from tests.random_circuits import circuits, random_inputs
from wnn2hdl.elaborate import component
from wnn2hdl.emit import CELLS_FILE, cells_model, vectors, verilog
from wnn2hdl.emit import testbench as write_testbench
from wnn2hdl.errors import ToolError
from wnn2hdl.ir import BitSelect, Lut, LutNetwork, Mux, Style
from wnn2hdl.ir.circuit import Circuit, Instance
from wnn2hdl.ir.identifiers import RESERVED
from wnn2hdl.ir.nodes import ArgMax, Match, Register, Sum, Table, Threshold
from wnn2hdl.ir.wires import Bits, Port, Slice
from wnn2hdl.lower import deforestation
from wnn2hdl.tools import find_yosys, lint_icarus, lint_verilator, run_icarus, run_verilator
from wnn2hdl.verify import equivalence

needs_simulator = pytest.mark.skipif(shutil.which("iverilog") is None, reason="Icarus is not installed")

ENCODER = BitSelect(("R7", "R6", "G5", "B4"))
BIT_NAMES = tuple(f"bit{i}" for i in range(9))
A, B = Port("a", 8), Port("b", 8)


def pixel(*cells: Lut | Mux, **outputs: str) -> Circuit:
    table = Table(
        "decision",
        tuple(Slice("rgb", position) for position in ENCODER.pixel_positions),
        LutNetwork(ENCODER.names, cells, tuple(outputs.items())),
    )
    drivers = {"class_bits": (Slice("decision", 0, len(outputs)),)}
    return Circuit("pixel", "Pixel classifier.", (Port("rgb", 24),), (table,), drivers)


def edge() -> Circuit:
    cells = (Lut("n0", ("bit1", "bit4", "bit5"), sum(1 << a for a in range(8) if a & 2 and a & 5 != 5)),)
    bits = Port("bits", 9)
    table = Table("filter", bits.word, LutNetwork(BIT_NAMES, cells, (("edge_bit", "n0"),)))
    return Circuit("edge", "Edge filter.", (bits,), (table,), {"edge_bit": (Slice("filter"),)})


# (R7 & ~R6) | G5
TWO_CLASSES = pixel(Lut("n0", ("R7", "R6", "G5"), 0b1111_0010), class_bit0="n0")
FOUR_CLASSES = pixel(
    Lut("n0", ("R7", "R6", "G5"), 0b1011_0011),
    Lut("n1", ("B4", "n0"), 0b0110),
    Lut("n2", ("G5",), 0b01),
    Lut("n4", ("R7", "B4"), 0b0100),
    Mux("n3", "n0", "n4", "n2"),
    class_bit0="n3",
    class_bit1="n1",
)


def node(*nodes: Match | ArgMax | Threshold | Sum, name: str = "arithmetic") -> Circuit:
    drivers = {f"{x.name}_bits": (Slice(x.name, 0, x.drives[x.name]),) for x in nodes}
    return Circuit(name, "Nodes side by side.", (A, B), nodes, drivers)


def pipeline() -> Circuit:
    """Two stages around an instance that has its own register; two ports carry the same bits."""
    stage = Circuit(
        "stage",
        "A registered sum.",
        (A,),
        (Sum("ones", A.word), Register("held", (Slice("ones", 0, 4),))),
        {"count": (Slice("held", 0, 4),)},
    )
    nodes = (
        Register("held_a", A.word),
        Instance("first", stage, {"a": (Slice("held_a", 0, 8),)}),
        Register("other", B.word, 2),
        ArgMax("best", ((Slice("first.count", 0, 4),), (Slice("other", 0, 4),)), "last"),
        Register("answer", (Slice("best"), Slice("other", 2, 3)), 3),
    )
    word = (Slice("answer", 0, 4),)
    return Circuit(
        "pipeline", "A pipeline.", (A, B), nodes, {"q": word, "again": word, "low": (Slice("answer"),)}
    )


def unread() -> Circuit:
    """Outputs of nodes of which nothing, or not all, is read."""
    inner = node(Match("same", A.word, B.word), Sum("ones", A.word), name="inner")
    nodes = (
        Instance("part", inner, {"a": A.word, "b": B.word}),
        Sum("sum", (Slice("part.ones_bits", 0, 4),), (1, 2, 3, 4)),
        Threshold("never", A.word, 256),
        Threshold("ever", A.word, 0),
    )
    drivers = {"y": (Slice("sum", 1, 2),), "constants": (Slice("never"), Slice("ever"), Slice("ever"))}
    return Circuit("unread", "Partly read.", (A, B), nodes, drivers)


BLOCK = deforestation.block(TWO_CLASSES, edge())
CIRCUITS: dict[str, Circuit] = {
    "pixel": TWO_CLASSES,
    "four_classes": FOUR_CLASSES,
    "constant": pixel(class_bit0="0"),
    "pass_through": pixel(class_bit0="G5"),
    "edge": edge(),
    "match": deforestation.match(),
    "block": BLOCK,
    "block_match": deforestation.block_match(BLOCK, deforestation.match()),
    "arithmetic": node(
        Sum("weighted", A.word, (1, 2, 3, 4, 5, 6, 7, 8)),
        Match("same", A.word, B.word),
        Match("one", (Slice("a"),), (Slice("b"),)),
        Threshold("reached", A.word, 77),
        ArgMax("first", (A.word, B.word, (Slice("a", 2, 3),)), "first"),
        ArgMax("last", (A.word, B.word, (Slice("a", 2, 3),)), "last"),
    ),
    "wide_match": Circuit(
        "wide_match",
        "Match of forty bits.",
        (Port("x", 40), Port("y", 40)),
        (Match("same", Port("x", 40).word, Port("y", 40).word),),
        {"match_count": (Slice("same", 0, 6),)},
    ),
    "unread": unread(),
    "pipeline": pipeline(),
}
STYLES: tuple[Style, ...] = ("cells", "equations")
SOBEL = sobel.Parameters().create()


def emitted(
    circuit: Circuit, style: Style = "cells", *, prefix: str = "my_", header: Sequence[str] = ()
) -> str:
    return verilog(component(circuit, style=style), prefix=prefix, header=header)


def test_a_block_reads_like_written_by_hand() -> None:
    text = emitted(CIRCUITS["block_match"], "equations", header=["made from a test", ""])
    assert text.startswith("// made from a test\n//\n")
    assert re.findall(r"^module (\w+)", text, re.MULTILINE) == [
        "my_pixel",
        "my_edge",
        "my_block",
        "my_match_3",
        "my_compress_3_3_to_4",
        "my_match",
        "my_block_match",
    ]
    assert "// Pixel classifier. Combinational.\nmodule my_pixel (\n    input  wire [23:0] rgb,\n" in text
    assert "    wire R7 = rgb[23];\n    wire R6 = rgb[22];\n    wire G5 = rgb[13];\n" in text
    assert "    assign class_bits = (R7 & ~R6) | G5;\n" in text
    assert "    assign edge_bit = bits[4] & (~bits[1] | ~bits[5]);\n" in text
    assert "    my_pixel pixel_8 (.rgb(window[215:192]), .class_bits(pixel_8_class_bits));\n" in text
    assert "    my_edge edges (.bits(bits), .edge_bit(edge_bit));\n" in text
    assert not re.search(r"\\|\$\d|always|src =", text)
    assert max(map(len, text.splitlines())) <= 120


def test_vendor_cells_are_instances_that_stay() -> None:
    text = emitted(FOUR_CLASSES)
    lut = "LUT3 #(.INIT(8'hb3)) n0_cell (.I0(R7), .I1(R6), .I2(G5), .O(n0));"
    assert f'    wire n0;\n    (* DONT_TOUCH = "yes" *) {lut}\n' in text
    assert '(* DONT_TOUCH = "yes" *) MUXF7 n3_cell (.I0(n0), .I1(n4), .S(n2), .O(n3));' in text


def test_registers_have_a_clock_start_values_and_no_reset() -> None:
    text = emitted(CIRCUITS["pipeline"])
    assert "// A pipeline. Latency 5 cycles.\nmodule my_pipeline (\n    input  wire clk,\n" in text
    kept = '(* keep = "true", shreg_extract = "no" *) '
    assert f"    {kept}output reg  [3:0] q,\n    output wire [3:0] again,\n" in text
    assert len(re.findall(r"\breg\b", text)) == text.count(f"{kept}reg") + text.count(f"{kept}output reg")
    assert "    initial q = 4'h0;\n    always @(posedge clk) q <= " in text
    assert "    assign again = q;\n    assign low = q[0];\n" in text
    assert "my_stage first (.clk(clk), .a(held_a), .count(first_count));" in text
    assert not re.search(r"\b(rst|reset)", text)


@pytest.mark.parametrize("name", ["four_classes", "arithmetic", "pipeline"])
@pytest.mark.parametrize("style", STYLES)
def test_the_same_component_gives_the_same_bytes(name: str, style: Style) -> None:
    assert emitted(CIRCUITS[name], style, header=["x"]) == emitted(CIRCUITS[name], style, header=["x"])


@pytest.mark.parametrize("name", CIRCUITS)
def test_ports_stand_in_the_order_of_declaration(name: str) -> None:
    circuit = CIRCUITS[name]
    top = emitted(circuit).rpartition("\nmodule ")[2].partition(");")[0]
    ports = re.findall(
        r"^    (?:\(\*.*\*\) )?(?:input|output) \s*\w+\s+(?:\[\d+:0\] )?(\w+)", top, re.MULTILINE
    )
    clock = ["clk"] if circuit.latency else []
    assert ports == [*clock, *(port.name for port in (*circuit.inputs, *circuit.outputs))]


@pytest.mark.parametrize("name", CIRCUITS)
def test_no_name_is_a_word_of_an_hdl_or_of_c(name: str) -> None:
    text = emitted(CIRCUITS[name])
    modules = re.findall(r"^module (\w+)", text, re.MULTILINE)
    declared = r"^    (?:\(\*.*\*\) )?(?:wire|reg|(?:in|out)put \s*\w+)\s+(?:\[\d+:0\] )?(\w+)"
    nets = re.findall(declared, text, re.MULTILINE)
    instances = re.findall(r"(\w+) \(\.", text)
    assert modules
    assert nets
    assert [word for word in (*modules, *nets, *instances) if word.lower() in RESERVED] == []


class Remembering(Part):
    """A memory."""

    module_name = "memory"
    clocked = True

    def __init__(self) -> None:
        super().__init__({"address": In(4), "data": Out(8)})

    def elaborate(self, platform: object) -> Module:
        m = Module()
        m.submodules.memory = memory = Memory(shape=8, depth=16, init=range(16))
        port = memory.read_port()
        m.d.comb += [port.addr.eq(self.address), self.data.eq(port.data)]
        return m


def test_a_memory_that_nothing_writes_is_refused() -> None:
    with pytest.raises(NotImplementedError, match="for which there is no Verilog"):
        verilog(Remembering(), prefix="my_", header=[])


def read_before_declared(text: str) -> list[str]:
    """Nets of any module that a statement reads above their declaration."""
    early = []
    for module in text.split("endmodule"):
        seen: set[str] = set()
        declared = set(re.findall(r"^    (?:wire|reg) (?:\[\d+:0\] )?(\w+)", module, re.MULTILINE))
        for statement in module.split(";\n"):
            name = re.match(r"\s*(?:wire|reg) (?:\[\d+:0\] )?(\w+)", statement)
            seen |= {name[1]} if name else set()
            early += [word for word in re.findall(r"\w+", statement) if word in declared - seen]
    return early


def write_bench(
    folder: Path, part: Part, name: str, inputs: Mapping[str, Bits], expected: Mapping[str, Bits]
) -> list[Path]:
    """The files that simulate a component in a folder, the testbench last."""
    files = [folder / CELLS_FILE, folder / f"{name}.v", folder / f"{name}_tb.v"]
    files[0].write_text(cells_model())
    text = verilog(part, prefix="my_", header=["x"])
    assert read_before_declared(text) == []
    files[1].write_text(text)
    count = len(next(iter(expected.values())))
    files[2].write_text(
        write_testbench(part, name=name, count=count, vectors_file="vectors.hex", sources=[f"{name}.v"])
    )
    (folder / "vectors.hex").write_text(vectors(part, inputs, expected))
    return files


def check_clean(files: Sequence[Path], name: str) -> None:
    """No tool warns of the design alone or of the design in its testbench."""
    for sources, top in ((files[:-1], name), (files, f"{name}_tb")):
        assert lint_icarus(sources, top, timeout=60) == []
        assert lint_verilator(sources, top, timeout=60) == []


@needs_simulator
@pytest.mark.simulator
@pytest.mark.parametrize("style", STYLES)
@pytest.mark.parametrize("name", CIRCUITS)
def test_the_verilog_is_clean_and_computes_what_the_circuit_evaluates(
    name: str, style: Style, tmp_path: Path
) -> None:
    circuit = CIRCUITS[name]
    inputs = random_inputs(circuit, 300)
    top = f"my_{circuit.name}"
    part = component(circuit, style=style)
    files = write_bench(tmp_path, part, top, inputs, circuit.evaluate(inputs))
    check_clean(files, top)
    assert run_icarus(files, f"{top}_tb", cwd=tmp_path, timeout=60).output == f"PASS: {top}, 300 vectors\n"


@needs_simulator
@pytest.mark.simulator
def test_the_baseline_is_clean_and_computes_what_its_golden_model_does(tmp_path: Path) -> None:
    greys = np.random.default_rng(3).integers(0, 256, (300, 9), dtype=np.uint8)
    inputs = {"window": np.unpackbits(greys, axis=1, bitorder="little").astype(np.bool_)}
    expected = {"edge_bit": SOBEL.parameters.compute(greys)[:, np.newaxis]}
    files = write_bench(tmp_path, sobel.Parameters().create(), "my_sobel", inputs, expected)
    check_clean(files, "my_sobel")
    assert "PASS" in run_icarus(files, "my_sobel_tb", cwd=tmp_path, timeout=60).output


@pytest.mark.slow
@needs_simulator
@pytest.mark.simulator
@pytest.mark.skipif(shutil.which("g++") is None, reason="no C++ compiler")
def test_a_pipeline_runs_in_verilator_too(tmp_path: Path) -> None:
    circuit = CIRCUITS["pipeline"]
    inputs = random_inputs(circuit, 300)
    part = component(circuit, style="cells")
    files = write_bench(tmp_path, part, "my_pipeline", inputs, circuit.evaluate(inputs))
    assert "PASS" in run_verilator(files, "my_pipeline_tb", cwd=tmp_path, timeout=300).output


@needs_simulator
@pytest.mark.simulator
def test_two_builds_with_different_prefixes_stand_in_one_project(tmp_path: Path) -> None:
    other = deforestation.block(pixel(class_bit0="B4"), edge())
    sources = [tmp_path / name for name in (CELLS_FILE, "one.v", "two.v", "top.v")]
    sources[0].write_text(cells_model())
    sources[1].write_text(emitted(BLOCK, prefix="one_"))
    sources[2].write_text(emitted(other, prefix="two_"))
    sources[3].write_text(
        "module top (input wire [215:0] window, output wire [8:0] x, y, output wire p, q);\n"
        "    one_block one (.window(window), .bits(x), .edge_bit(p));\n"
        "    two_block two (.window(window), .bits(y), .edge_bit(q));\nendmodule\n"
    )
    assert lint_icarus(sources, "top", timeout=60) == []
    assert [line for line in lint_verilator(sources, "top", timeout=60) if "DECLFILENAME" not in line] == []


def reference(part: Part, name: str) -> str:
    """Amaranth's own drawing of a component, as a module that Yosys wrote.

    It is the component without an `Emission`: submodules that Amaranth connects, look-ups where the emitted
    text has cells or equations, no names; so it shares neither the writer nor what the writer reads.
    """
    text = rtlil.convert(
        part, name=name, emit_src=False, missing_domain=lambda domain: ClockDomain(domain, reset_less=True)
    )
    script = f"read_rtlil <<EOT\n{text}\nEOT\nproc\nflatten\nopt_clean\nwrite_verilog -noattr"
    log = find_yosys().run(script, timeout=60)
    return re.search(rf"^module {name}\(.*?^endmodule$", log, re.MULTILINE | re.DOTALL)[0]  # type: ignore[index]


def differences(parts: Mapping[str, Callable[[], Part]]) -> dict[str, equivalence.Difference]:
    """For each component an input on which its emitted text differs from Amaranth's drawing of it."""
    pairs = [
        (
            equivalence.Circuit((reference(part(), "golden"),), "golden"),
            equivalence.Circuit((verilog(part(), prefix="my_", header=[]),), f"my_{part().module_name}"),
        )
        for part in parts.values()
    ]
    return dict(zip(parts, equivalence.find_differences(pairs, timeout=300), strict=True))


def test_the_emitted_text_is_proved_equal_to_the_drawing_of_amaranth() -> None:
    parts: dict[str, Callable[[], Part]] = {"sobel": lambda: sobel.Parameters().create()}
    for name, circuit in CIRCUITS.items():
        for style in STYLES:
            if not circuit.latency:
                parts[f"{name} {style}"] = partial(component, circuit, style=style)
    assert {name: found for name, found in differences(parts).items() if found} == {}


@pytest.mark.slow
@settings(max_examples=8, deadline=None)
@given(
    st.lists(
        circuits(("table", "threshold", "sum", "match", "argmax", "instance")),
        min_size=3,
        max_size=3,
    )
)
def test_random_circuits_are_proved_equal_to_the_drawing_of_amaranth(random: list[Circuit]) -> None:
    parts: dict[str, Callable[[], Part]] = {
        str(i): partial(component, circuit, style="cells") for i, circuit in enumerate(random)
    }
    assert {name: found for name, found in differences(parts).items() if found} == {}


def prove_pipeline(text: str, folder: Path) -> None:
    (folder / "golden.v").write_text(reference(component(CIRCUITS["pipeline"], style="cells"), "golden"))
    (folder / "emitted.v").write_text(text)
    # The state of each is made of the last five samples, so an induction over six steps decides.
    script = """
        read_verilog +/xilinx/cells_sim.v golden.v emitted.v
        hierarchy
        setattr -mod -unset keep_hierarchy *
        proc; flatten; opt_clean
        miter -equiv -flatten golden my_pipeline miter
        sat -verify -tempinduct -maxsteps 8 -prove trigger 0 miter
    """
    find_yosys().run(script, timeout=120, cwd=folder)


def test_a_pipeline_is_proved_equal_to_the_drawing_of_amaranth(tmp_path: Path) -> None:
    prove_pipeline(emitted(CIRCUITS["pipeline"]), tmp_path)


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("answer_2 <= answer_1", "answer_2 <= {answer_1[3:1], 1'h0}"),
        ("initial count = 4'h0", "initial count = 4'h1"),
        ("posedge clk) other <= other_1", "posedge clk) other <= b"),
    ],
)
def test_the_proof_of_a_pipeline_finds_faults(right: str, wrong: str, tmp_path: Path) -> None:
    text = emitted(CIRCUITS["pipeline"])
    assert right in text
    with pytest.raises(ToolError):
        prove_pipeline(text.replace(right, wrong), tmp_path)
