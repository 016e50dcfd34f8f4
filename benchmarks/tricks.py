"""What somebody who wants to deceive can do to a build: ``python benchmarks/tricks.py build/NAME …``.

Each trick changes a copy of a build and writes the manifest's hashes again. `wnn2hdl verify` has to refuse
every copy in which a simulator or Vivado would read another circuit than the one that is proved, or in which
a file states what is not so. A few tricks do no harm; they say why, and have to pass.

The builds are ones of one or nine pixels in style ``cells``; a trick that finds nothing to change is skipped.
"""

import json
import re
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from wnn2hdl.build.design import Design
from wnn2hdl.build.emission import emit
from wnn2hdl.build.verification import inspect_build, verify_build
from wnn2hdl.emit import MANIFEST_NAME, write_manifest
from wnn2hdl.errors import Wnn2hdlError
from wnn2hdl.ir import WisardModel

Change = Callable[[Path], None]

MACROS = (
    *("SYNTHESIS", "YOSYS", "__ICARUS__", "VERILATOR", "XILINX_SIMULATOR", "MODEL_TECH", "VCS"),
    "COCOTB_SIM",
)
"""What tools define for themselves."""


@dataclass(frozen=True)
class Trick:
    """One way to deceive.

    Attributes:
        name: what is done.
        change: does it to a folder.
        harmless: why no harm is done; empty if there is some.
    """

    name: str
    change: Change
    harmless: str = ""


class NothingToChangeError(Exception):
    """The build has nothing that the trick would change."""


def findings(trick: Trick, build: Path) -> list[str] | None:
    """What `verify` says of a copy of a build on which the trick was played; None if it does not fit."""
    with tempfile.TemporaryDirectory(prefix="wnn2hdl-tricks-") as name:
        folder = Path(shutil.copytree(build, Path(name) / build.name))
        try:
            trick.change(folder)
        except NothingToChangeError:
            return None
        sign_again(folder)
        try:
            # Most tricks are seen at once; the rest takes simulation, proof and synthesis.
            return inspect_build(folder)[0] or verify_build(folder, _silent)[0]
        except Wnn2hdlError as error:
            return [error.line()]


def _silent(step: str, done: int, total: int) -> None:
    """No progress is shown."""


def sign_again(folder: Path) -> None:
    """Make the manifest fit the files."""
    if (folder / MANIFEST_NAME).exists():
        (folder / MANIFEST_NAME).unlink()
        names = sorted(path.name for path in folder.iterdir() if path.is_file())
        write_manifest(folder, names, versions={}, options={})


def verilog(old: str, new: str) -> Change:
    """Replace the first match of a pattern in the design's Verilog; ``\\g<name>`` stands for a group."""

    def change(folder: Path) -> None:
        path = folder / f"{_json(folder / 'design.json')['name']}.v"
        text = path.read_text(encoding="utf-8")
        changed = re.sub(old, new, text, count=1, flags=re.M | re.S)
        if changed == text:
            raise NothingToChangeError
        path.write_bytes(changed.encode())

    return change


def cell_contents(new: str) -> Change:
    """Write something else for the contents of the first LUT; ``\\g<wrong>`` are wrong ones."""

    def change(folder: Path) -> None:
        path = folder / f"{_json(folder / 'design.json')['name']}.v"
        found = re.search(r"(?P<width>\d+)'h(?P<digits>[0-9a-f]+)", path.read_text(encoding="utf-8"))
        if found is None:
            raise NothingToChangeError
        wrong = f"{found['width']}'h{int(found['digits'], 16) ^ (1 << int(found['width'])) - 1:x}"
        written = new.replace("RIGHT", found[0]).replace("WRONG", wrong)
        verilog(re.escape(found[0]), written.replace("\\", r"\\"))(folder)

    return change


def other_file(name: str, old: str, new: str) -> Change:
    """Replace the first match of a pattern in another file, ``*`` in its name standing for anything."""

    def change(folder: Path) -> None:
        path = next(folder.glob(name))
        text = path.read_text(encoding="utf-8")
        changed = re.sub(old, new, text, count=1, flags=re.M)
        if changed == text:
            raise NothingToChangeError
        path.write_text(changed, encoding="utf-8")

    return change


def new_file(name: str, text: str = "module LUT6; endmodule\n") -> Change:
    """Put a file beside the others."""

    def change(folder: Path) -> None:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")

    return change


def report(change_data: Callable[[dict[str, Any]], None]) -> Change:
    """Change `report.json`."""
    return lambda folder: _rewrite(folder / "report.json", change_data)


def design(change_data: Callable[[dict[str, Any]], None]) -> Change:
    """Change `design.json`, and write the Verilog that belongs to it where the compiler would."""

    def change(folder: Path) -> None:
        _rewrite(folder / "design.json", change_data)
        with suppress(Exception):
            emit(Design.load(folder), folder, sobel_threshold=128)

    return change


def circuit(change_circuit: Callable[[dict[str, Any]], None]) -> Change:
    """Change the first circuit in `design.json`, as `design`."""
    return design(lambda data: change_circuit(data["circuit"][0]))


def consistent_care(folder: Path) -> None:
    """Care for one code less, and say so everywhere."""

    def fewer(data: dict[str, Any]) -> None:
        care = data["circuit"][0]["care"][0]
        if care["kind"] != "codes":
            raise NothingToChangeError
        care["codes"].pop()
        for line, text in enumerate(data["header"]):
            data["header"][line] = re.sub(
                r"pixel holds (\d+)", lambda match: f"pixel holds {int(match[1]) - 1}", text
            )

    def counted(data: dict[str, Any]) -> None:
        data["care"]["codes"] -= 1

    design(fewer)(folder)
    _rewrite(folder / "report.json", counted)


def in_network(rename: Callable[[dict[str, Any]], None]) -> Change:
    """Change the LUT network of the first circuit."""
    return circuit(lambda data: rename(data["nodes"][0]["network"]))


def _renamed_cell(name: str) -> Change:
    def change(network: dict[str, Any]) -> None:
        old = network["cells"][0]["name"]
        network["cells"][0]["name"] = name
        network["outputs"] = [[port, name if cell == old else cell] for port, cell in network["outputs"]]

    return in_network(change)


def _renamed_input(name: str) -> Change:
    def change(network: dict[str, Any]) -> None:
        old, network["inputs"][0] = network["inputs"][0], name
        for cell in network["cells"]:
            if "inputs" in cell:
                cell["inputs"] = [name if pin == old else pin for pin in cell["inputs"]]

    return in_network(change)


def _renamed_node(name: str) -> Change:
    def change(data: dict[str, Any]) -> None:
        old, data["nodes"][0]["name"] = data["nodes"][0]["name"], name
        data["outputs"] = {
            port: [x.replace(old, name) for x in word] for port, word in data["outputs"].items()
        }

    return circuit(change)


def _renamed_port(data: dict[str, Any]) -> None:
    data["outputs"] = dict.fromkeys([_INJECTION], next(iter(data["outputs"].values())))


def _linked(folder: Path) -> None:
    path = next(folder.glob("*_tb.v"))
    elsewhere = folder.parent / "elsewhere.v"
    path.rename(elsewhere)
    path.symlink_to(elsewhere)


def _forgotten(folder: Path) -> None:
    path = next(folder.glob("*_tb.v"))
    path.unlink()


def _model(folder: Path) -> None:
    """Another threshold, with the digests of the model repaired."""

    def higher(data: dict[str, Any]) -> None:
        data["bleaching"] *= 4

    _rewrite(folder / "model.json", higher)
    digest = WisardModel.load(folder / "model.json").digest()
    old = _json(folder / "design.json")["model_sha256"]
    for name in ("design.json", "report.json"):
        path = folder / name
        path.write_text(path.read_text(encoding="utf-8").replace(old, digest), encoding="utf-8")
    with suppress(Wnn2hdlError):
        emit(Design.load(folder), folder, sobel_threshold=128)


def _top_left_out(data: dict[str, Any]) -> None:
    if len(data["circuit"]) == 1:
        raise NothingToChangeError
    data["circuit"].pop()


def _set(*path: str | int, to: Any) -> Callable[[dict[str, Any]], None]:
    """Set an entry of a JSON object."""

    def change(data: Any) -> None:
        *steps, last = path
        for step in steps:
            data = data[step]
        if data[last] == to:
            raise NothingToChangeError
        data[last] = to

    return change


def _dead_cell(network: dict[str, Any]) -> None:
    network["cells"].append({"name": "copy", "inputs": network["inputs"][:2], "init": "6"})


def _dead_instance(data: dict[str, Any]) -> None:
    if len(data["circuit"]) == 1:
        raise NothingToChangeError
    copy = next(node for node in data["circuit"][2]["nodes"] if node["kind"] == "instance") | {"name": "copy"}
    data["circuit"][2]["nodes"].append(copy)


def _other_edges(data: dict[str, Any]) -> None:
    if data["edges"] is None:
        raise NothingToChangeError
    data["edges"]["patterns"][0] ^= 1


def _fewer_windows(data: dict[str, Any]) -> None:
    if len(data["circuit"]) == 1 or data["circuit"][1]["care"][0]["kind"] != "codes":
        raise NothingToChangeError
    data["circuit"][1]["care"][0]["codes"].pop()


def _wrong_contents(network: dict[str, Any]) -> None:
    cell = network["cells"][0]
    cell["init"] = f"{int(cell['init'], 16) ^ (1 << (1 << len(cell['inputs']))) - 1:x}"


def _json(path: Path) -> dict[str, Any]:
    data: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return data


def _rewrite(path: Path, change: Callable[[dict[str, Any]], None]) -> None:
    data = _json(path)
    change(data)
    path.write_text(json.dumps(data, indent=1), encoding="utf-8")


_LUT = r"^ *(?:\(\* DONT_TOUCH = \"yes\" \*\) )?LUT(?P<inputs>\d) (?P<rest>#\(.*?\)) (?P<cell>\w+) \("
_CELL = r"^ *\(\* DONT_TOUCH = \"yes\" \*\) LUT"
_BODY = r"^\);$"
_LAST = r"endmodule\s*\Z"
_INJECTION = "t0; initial force x = 1; //"

TEXT = (
    *(
        Trick(f"`ifdef {macro}", cell_contents(f"\n`ifdef {macro}\nWRONG\n`else\nRIGHT\n`endif\n"))
        for macro in MACROS
    ),
    Trick("`ifndef YOSYS", cell_contents("\n`ifndef YOSYS\nWRONG\n`else\nRIGHT\n`endif\n")),
    *(
        Trick(
            f"/* {word} translate_off */",
            cell_contents(f"RIGHT /* {word} translate_off */ ^ 1 /* {word} translate_on */"),
        )
        for word in ("synthesis", "synopsys", "pragma")
    ),
    Trick("// synthesis translate_off", cell_contents("RIGHT // synthesis translate_off\n^ 1\n")),
    Trick("a local defparam", verilog(_BODY, ");\n    defparam t0_cell.INIT = 1;")),
    Trick("a hierarchical defparam", verilog(_LAST, "    defparam pixel_0.t0_cell.INIT = 1;\nendmodule\n")),
    Trick(
        "a defparam from another module",
        verilog(_LAST, "endmodule\nmodule x;\n    defparam t.t0_cell.INIT = 1;\nendmodule\n"),
    ),
    Trick("a hierarchical assignment", verilog(_LAST, "    assign pixel_0.R7 = 1'b0;\nendmodule\n")),
    Trick("a force", verilog(_LAST, "    initial force class_bits = 1'b0;\nendmodule\n")),
    Trick("an initial block", verilog(_LAST, "    reg r; initial r = 0;\nendmodule\n")),
    Trick("a delay of a wire", verilog(r"    wire (?P<net>[RGB]\d) =", r"    wire #1000 \g<net> =")),
    Trick("a delay of an assignment", verilog(r"    assign ", "    assign #1000 ")),
    Trick(
        "an incomplete sensitivity list",
        verilog(
            r"wire (?P<net>[RGB]\d) = (?P<bit>rgb\[\d+\]);",
            r"reg \g<net>; always @(rgb[0]) \g<net> = \g<bit>;",
        ),
    ),
    Trick("a select out of range", verilog(r"rgb\[\d+\]", "rgb[32]")),
    Trick("a negative select", verilog(r"rgb\[\d+\]", "rgb[-1]")),
    Trick(
        "a second cell model at the end",
        verilog(
            _LAST,
            "endmodule\nmodule LUT6 #(parameter INIT = 0) (output O, input I0, I1, I2, I3, I4, I5);\n"
            "    assign O = 0;\nendmodule\n",
        ),
    ),
    Trick("a second module of the same name", verilog(r"\Z", "\nmodule px_pixel; endmodule\n")),
    Trick("an unconnected copy of a cell", verilog(_CELL, "    LUT1 copy ();\n    LUT")),
    Trick("LUT6_2 in place of LUT6", verilog(r"LUT\d #", "LUT6_2 #")),
    Trick("another attribute", verilog("DONT_TOUCH", "black_box")),
    Trick("full_case", verilog(_BODY, ") /* synthesis full_case */;")),
    Trick("`include", verilog(r"\A", '`include "x.v"\n')),
    Trick("`define", verilog(r"\A", "`define INIT X\n")),
    Trick("`default_nettype", verilog(r"\A", "`default_nettype wire\n")),
    Trick("`timescale", verilog(r"\A", "`timescale 1s/1s\n")),
    Trick("`celldefine", verilog(r"\A", "`celldefine\n")),
    Trick("`line", verilog(r"\A", '`line 1 "x.v" 0\n')),
    Trick("a wired net", verilog(r"    wire (?P<net>[RGB]\d) =", r"    wand \g<net> =")),
    Trick("a weak net", verilog(r"    assign ", "    assign (weak0, weak1) ")),
    Trick("an undefined bit", verilog(r"= rgb\[\d+\]", "= 1'bz")),
    Trick("a bind", verilog(r"\Z", "\nbind px_pixel x y ();\n")),
    Trick("a generate block", verilog(_BODY, ");\n    generate if (1) wire g; endgenerate")),
    Trick("a specify block", verilog(_BODY, ");\n    specify (rgb => class_bits) = 9; endspecify")),
    Trick("an escaped name", verilog(r"wire (?P<net>[RGB]\d)", r"wire \\\g<net> ")),
    Trick(
        "a comment that hides a line", verilog(r"^(?P<line>    wire [RGB]\d[^\n]*)", r"    /* \g<line> */")
    ),
    Trick("lines that end by CR LF", verilog("\n(?=    wire [RGB])", "\r\n")),
    Trick("a line that ends by CR", verilog("\n(?=    wire [RGB])", "\r")),
    Trick("a form feed for the end of a line", verilog("\n(?=module)", "\f")),
    Trick("a vertical tab for the end of a line", verilog("\n(?=module)", "\v")),
    Trick("NEL for the end of a line", verilog("\n(?=module)", "\x85")),
    Trick("a line separator for the end of a line", verilog("\n(?=module)", "\u2028")),
    Trick("a byte order mark", verilog(r"\A", "\ufeff")),
    Trick("a NUL at the end", verilog(r"\Z", "\0")),
    Trick("a backslash at the end of a comment", verilog(r"Combinational\.$", r"Combinational.\\")),
    Trick("a command in a comment", verilog(r"// Mode", "// synthesis translate_off")),
    Trick("a lie in a comment", verilog(r"// Mode [^\n]*", "// Mode exact: equal on every input.")),
    Trick("wrong contents of a cell", cell_contents("WRONG")),
)

OTHERS = (
    Trick("xilinx_cells_sim.v changed", other_file("xilinx_cells_sim.v", r"INIT\[", "~INIT[")),
    Trick("sobel.v changed", other_file("sobel.v", r"assign \w+ = ", r"\g<0>~")),
    Trick("testbench changed", other_file("*_tb.v", "!==", "===")),
    Trick("vectors changed", other_file("*_vectors.hex", r"^.", "f")),
    Trick("vectors cut off", other_file("*_vectors.hex", r"\n[^\n]*\n\Z", "\n")),
    Trick("testbench missing, in the manifest too", _forgotten),
    *(
        Trick(f"a file {name} more", new_file(name))
        for name in ("extra.v", "bind.sv", "EXTRA.V", "defines.vh", "px.xdc", "run.tcl", "lib/cells.v")
    ),
    Trick("a file notes.txt more", new_file("notes.txt"), "no tool takes it for a source"),
    Trick("a link to the same bytes", _linked, "every tool reads the bytes that were checked"),
    Trick("model.json changed, its digests repaired", _model),
)

REPORT = (
    Trick("fewer LUTs", report(lambda data: data["parts"][data["target"]].update(luts=0))),
    Trick("a shorter delay", report(lambda data: data["parts"][data["target"]].update(delay_ps=1))),
    Trick("more LUTs of the baseline", report(lambda data: data["parts"]["sobel"].update(luts=999))),
    Trick("a part that is none", report(lambda data: data["parts"].update(x=data["parts"]["sobel"]))),
    Trick("a part left out", report(lambda data: data["parts"].pop(data["target"]))),
    Trick("a larger care set", report(lambda data: data["care"].update(codes=256 * 16))),
    Trick("a smaller utilisation", report(lambda data: data["utilisation"].update(sobel={"luts": 50.0}))),
    Trick("another target", report(lambda data: data.update(target="neighbourhood"))),
    Trick("another mode", report(_set("mode", to="exact"))),
    Trick("a proof that failed", report(lambda data: data["proof"].update(status="simulated"))),
    Trick("another model", report(lambda data: data["hashes"].update(model="0" * 64))),
    Trick("other classes", report(lambda data: data["model"].update(classes=["x", "y"]))),
    Trick("other figures of others", report(lambda data: data["published"][0].update(luts=210))),
    Trick("a threshold of the baseline that is none", report(_set("options", "sobel_threshold", to=9999))),
    Trick("a threshold that is a text", report(_set("options", "sobel_threshold", to="128"))),
    Trick("another threshold", report(_set("options", "sobel_threshold", to=127))),
    Trick("other versions", report(lambda data: data["tools"].update(wnn2hdl="99"))),
    Trick("a better accuracy", report(_set("accuracy", to=1.0)), "verify says that it finds no accuracy"),
)

DESIGN = (
    Trick("wrong contents of a LUT, Verilog and all", in_network(_wrong_contents)),
    Trick("a cell that nothing reads, Verilog and all", in_network(_dead_cell)),
    Trick("an instance that nothing reads, Verilog and all", design(_dead_instance)),
    Trick("the top circuit left out", design(_top_left_out)),
    Trick("another target", design(_set("target", to="match"))),
    Trick("a target that is none", design(_set("target", to="x"))),
    Trick("exact mode for domain mode", design(_set("mode", to="exact"))),
    Trick("domain mode for exact mode", design(_set("mode", to="domain"))),
    Trick("a smaller care set", circuit(lambda data: data["care"][0].update(kind="codes", codes=[0]))),
    Trick("a smaller care set of windows", design(_fewer_windows)),
    Trick("an empty care set", circuit(lambda data: data["care"][0].update(kind="codes", codes=[]))),
    Trick("no care set", circuit(lambda data: data.update(care=[]))),
    Trick(
        "impossible bits that are possible",
        circuit(lambda data: data["care"][0].update(kind="implied", falling=[[0, 1, 2]])),
    ),
    Trick(
        "a care set of a huge word",
        circuit(lambda data: data["care"][0].update(width=216, kind="everything")),
    ),
    Trick(
        "a smaller care set that is stated everywhere",
        consistent_care,
        "the build says for how many codes it is proved, and it is proved for these",
    ),
    Trick("other edge patterns under a rule's name", design(_other_edges)),
    *(
        Trick(f"the name {name!r}", design(_set("name", to=name)))
        for name in ("x;y", "x y", "x\ny", "module", "x__y", "*/", "é", "x" * 5000, "../x", "sobel", 7)
    ),
    *(
        Trick(f"the comment {line!r}", design(_set("header", 0, to=line)))
        for line in (
            "x\nmodule y; endmodule",
            "x \\",
            "x\u2028module y",
            "synthesis translate_off",
            "*/ module y",
            "x\x0cmodule y",
            "x" * 5000,
            7,
        )
    ),
    *(
        Trick(f"the summary {line!r}", circuit(_set("summary", to=line)))
        for line in (
            "x\nmodule y; endmodule",
            "synthesis translate_off",
            "pragma translate_off",
            "x \\",
            "Proved.",
        )
    ),
    *(
        Trick(f"the cell {name!r}", _renamed_cell(name))
        for name in (_INJECTION, "always", "t0\n", "\\t0 ", "")
    ),
    *(Trick(f"the input {name!r}", _renamed_input(name)) for name in (_INJECTION, "wire", "R7[0]", "R7 ")),
    *(Trick(f"the node {name!r}", _renamed_node(name)) for name in (_INJECTION, "end", "a b", "$and")),
    Trick("the output port of another name", circuit(_renamed_port)),
    Trick("contents that are not a number", in_network(lambda data: data["cells"][0].update(init="1'h0"))),
    Trick(
        "contents that are too wide", in_network(lambda data: data["cells"][0].update(init="1" + "0" * 99))
    ),
    Trick("another style", design(_set("style", to="equations"))),
    Trick("a circuit that is there twice", design(lambda data: data["circuit"].append(data["circuit"][-1]))),
    Trick("a newer format", design(_set("version", to=99))),
)

TRICKS = {
    "Verilog": TEXT,
    "other files": OTHERS,
    "report.json": REPORT,
    "design.json": DESIGN,
}


def play(build: Path) -> Iterator[tuple[str, Trick, list[str]]]:
    """Play all tricks that fit a build: where, which, and what `verify` says."""
    for where, tricks in TRICKS.items():
        for trick in tricks:
            said = findings(trick, build)
            if said is not None:
                yield where, trick, said


if __name__ == "__main__":
    for folder in map(Path, sys.argv[1:]):
        refused = harmless = wrong = 0
        for where, trick, said in play(folder):
            right = bool(said) != bool(trick.harmless)
            wrong += not right
            refused += bool(said)
            harmless += right and not said
            verdict = said[0] if said else f"passed: {trick.harmless or 'NOT REFUSED'}"
            print(f"{'' if right else '!!! '}{where}: {trick.name[:60]}: {verdict}", flush=True)
        print(f"{folder}: {refused} refused, {harmless} harmless, {wrong} wrong")
