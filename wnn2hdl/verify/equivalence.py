"""Are two Verilog modules equal on every input? Yosys reads them, ABC decides.

Yosys turns each module into an and-inverter graph (AIGER) by ``proc``, ``techmap``, ``aigmap`` and
``flatten``; ABC builds the miter of two graphs and runs its combinational equivalence checker ``&cec`` on it:
it simulates, guesses internal equivalences, proves or refutes each by SAT, merges, and ends with the outputs.
An answer of "undecided" is handed on, never taken for a yes.

What is not a function of the inputs is refused: undriven, doubly driven and looped wires by ``check
-assert``, registers of a combinational circuit by their count in the graph, latches by Yosys's AIGER writer;
and each ``x`` is made a free input (``setundef -anyseq``), which shows in the graph's count of inputs.

A pipeline of latency L answers L clock edges after its inputs. Its graph is unrolled over L + 1 cycles, and
its last outputs are compared as a function of its first inputs. Everything that must not matter is a
separate free input: what the registers hold at first, and the inputs of all later cycles. A path with a
register too few or too many, a register whose contents survive, or an enable makes the outputs depend on
these, and the circuits differ. All registers have to be clocked by the rising edge of the port ``clk``.
"""

import json
import re
import tempfile
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

from wnn2hdl.errors import CheckError, ToolError
from wnn2hdl.tools import find_yosys, run_abc
from wnn2hdl.tools.aiger import Aiger

_PRIMITIVE = re.compile(r"\b(LUT[1-6]|LUT6_2|MUXF[78]|CARRY4|INV|FD[RSCP]E|SRL16E|SRLC16E|SRLC32E|BUFG)\b")
_VERDICT = re.compile(r"Networks are (equivalent|NOT EQUIVALENT|UNDECIDED)")
_PORT_BIT = re.compile(r"^(input|output) (\d+) (\d+) (\S+)$", re.MULTILINE)
_ANSWER = re.compile(r"Eval result: \\(\w+) = \d+'([01x]+)\.")
_EVALUATION_SECONDS = 60.0

CLOCK = "clk"
"""The clock of circuits with registers."""

TO_GATES = ("opt_expr", "techmap", "opt_expr", "aigmap")
"""Commands that turn the logic of every module into ANDs and inverters."""

# Enables and synchronous resets become logic; a falling edge becomes an inverter at the clock.
_ONE_CLOCK = [
    "opt_clean",
    "dfflegalize -cell $_DFF_P_ 01",
    f"select -assert-none t:$_DFF_P_ w:{CLOCK} %co1:+$_DFF_P_[C] %d",
    "aigmap",
    "opt_clean",
]
_REGISTERS_AS_WIRES = "module \\$_DFF_P_ (input D, C, output Q); assign Q = D; endmodule\n"

CONFLICTS = 1_000_000
"""SAT conflicts allowed at a node; ABC's own limit of 1000 leaves some equal circuits undecided."""

UNDECIDED: Literal["undecided"] = "undecided"

Difference = dict[str, int] | Literal["undecided"] | None
"""Inputs on which two circuits differ, None if they are equal, or that it is not known."""


@dataclass(frozen=True)
class Circuit:
    """A Verilog module.

    Attributes:
        sources: Verilog texts, read in this order; of two modules of one name the first counts. Cells of the
            7-series library come before all: Yosys's models of them count, whatever a source defines.
        top: the module.
        latency: clock cycles from inputs to outputs; 0 if the module is combinational, otherwise it has the
            port `CLOCK`.
    """

    sources: tuple[str, ...]
    top: str
    latency: int = 0


@dataclass(frozen=True)
class _Graph:
    """The ports of an and-inverter graph.

    Attributes:
        inputs: port and bit of each input of the graph.
        outputs: the same for its outputs; Yosys names none that is constant.
        size: how many outputs there are.
        free: how many inputs follow that may not matter.
    """

    inputs: dict[int, tuple[str, int]]
    outputs: dict[int, tuple[str, int]]
    size: int
    free: int = 0

    def fits(self, other: "_Graph") -> bool:
        """Whether inputs and outputs of the same place belong to the same port."""
        named_by_both = self.outputs.keys() & other.outputs.keys()
        return (
            self.inputs == other.inputs
            and self.size == other.size
            and all(self.outputs[place] == other.outputs[place] for place in named_by_both)
        )


def find_differences(
    pairs: Sequence[tuple[Circuit, Circuit]], *, timeout: float, conflicts: int = CONFLICTS, nodes: int = 0
) -> list[Difference]:
    """For each pair, an input on which the two circuits differ.

    All pairs share one process of Yosys and one of ABC, and each circuit is read once.

    Args:
        pairs: circuits with equal ports.
        timeout: seconds for each of the two processes.
        conflicts: how many conflicts SAT may run into at a node.
        nodes: of a binary decision diagram that is tried before SAT; none is where this is 0.

    Returns:
        For each pair the values of the input ports, None where the circuits are equal on every input, or
        `UNDECIDED` where it took more conflicts.

    Raises:
        CheckError: a combinational circuit has registers, or a circuit reads undefined values: it is no
            function of its inputs.
        ToolError: Yosys cannot read a circuit, the ports differ, or a tool gave up.
    """
    with tempfile.TemporaryDirectory(prefix="wnn2hdl-") as place:
        folder = Path(place)
        circuits = list(dict.fromkeys(circuit for pair in pairs for circuit in pair))
        graphs = dict(zip(circuits, _write_graphs(circuits, folder, timeout), strict=True))
        numbers = {circuit: number for number, circuit in enumerate(circuits)}
        script, equal = [], set[int]()
        for number, (left, right) in enumerate(pairs):
            if not graphs[left].fits(graphs[right]):
                raise ToolError("two circuits to compare have different ports", value=(left.top, right.top))
            files = [f"{numbers[left]}.aig", f"{numbers[right]}.aig"]
            free = graphs[left].free, graphs[right].free
            if any(free):
                shared = len(graphs[left].inputs)
                for side, (name, more) in enumerate(zip(files, ((0, free[1]), (free[0], 0)), strict=True)):
                    files[side] = f"{number}_{side}.aig"
                    Aiger.read(folder / name).widened(shared, *more).write(folder / files[side])
            if nodes and _same_diagram(files, nodes, folder, timeout):
                equal.add(number)
                continue
            # -n: by place, not by name, so that the counterexample's bits stand in the inputs' order.
            script.append(f"miter -n {' '.join(files)}; &get; &cec -m -C {conflicts}")
            script.append(f"write_cex {number}.cex")
        found = run_abc("\n".join(script) + "\n", timeout=timeout, cwd=folder) if script else ""
        verdicts = _VERDICT.findall(found)
        for number in sorted(equal):
            verdicts.insert(number, "equivalent")
        if len(verdicts) != len(pairs):
            raise ToolError("ABC did not say whether two circuits are equal", value=verdicts)
        return [
            _difference(verdict, folder / f"{number}.cex", graphs[left])
            for number, (verdict, (left, _)) in enumerate(zip(verdicts, pairs, strict=True))
        ]


def evaluate(
    circuit: Circuit, inputs: Mapping[str, int], widths: Mapping[str, int], outputs: Sequence[str]
) -> dict[str, int]:
    """What a circuit answers on one input that stands still, by Yosys's constant evaluation of its Verilog.

    Args:
        circuit: the circuit.
        inputs: values of the input ports.
        widths: widths of the input ports, in bits.
        outputs: names of the output ports wanted.

    Raises:
        ToolError: Yosys cannot read the circuit, or an output is undefined.
    """
    settings = " ".join(f"-set {port} {widths[port]}'h{value:x}" for port, value in inputs.items())
    with tempfile.TemporaryDirectory(prefix="wnn2hdl-") as name:
        folder = Path(name)
        script = [*read_cells([circuit]), *read([circuit], folder)[0], "flatten", "opt_clean"]
        if circuit.latency:
            (folder / "wires.v").write_text(_REGISTERS_AS_WIRES, encoding="utf-8")
            script += [
                "opt_expr",
                "techmap",
                "dfflegalize -cell $_DFF_P_ 01",
                "techmap -map wires.v",
                "opt_clean",
            ]
        script.append(f"eval {settings} " + " ".join(f"-show {port}" for port in outputs))
        log = find_yosys().run("\n".join(script) + "\n", timeout=_EVALUATION_SECONDS, cwd=folder)
    answers = {port: bits for port, bits in _ANSWER.findall(log) if port in outputs}
    if len(answers) != len(outputs) or any("x" in bits for bits in answers.values()):
        raise ToolError("Yosys cannot evaluate the circuit", value=circuit.top, output=log)
    return {port: int(answers[port], 2) for port in outputs}


def _write_graphs(circuits: Sequence[Circuit], folder: Path, timeout: float) -> list[_Graph]:
    """Write the graph of circuit ``i`` to ``i.aig``; return their ports."""
    script = read_cells(circuits)
    for number, (circuit, reading) in enumerate(zip(circuits, read(circuits, folder), strict=True)):
        script += reading
        # Mapping each module once, and merging its equal gates, before it is flattened into its nine
        # instances is what makes this quick: flattening takes the longest, a time for each gate.
        script += ["check -assert", "setundef -anyseq", *TO_GATES]
        script += ["opt_merge", "opt_clean", "rename -hide", "flatten -noscopeinfo", *one_clock(circuit)]
        script += [f"write_aiger -map {number}.map {number}.aig"]
    find_yosys().run("\n".join(script) + "\n", timeout=timeout, cwd=folder)
    graphs = [
        _checked(folder / f"{number}.aig", folder / f"{number}.map", circuit)
        for number, circuit in enumerate(circuits)
    ]
    return [
        _unrolled(folder / f"{number}.aig", graphs[number], circuit.latency)
        if circuit.latency
        else graphs[number]
        for number, circuit in enumerate(circuits)
    ]


def _unrolled(path: Path, graph: _Graph, cycles: int) -> _Graph:
    """Put the unrolled graph in the place of a pipeline's."""
    first = tuple(place for place, (port, _) in sorted(graph.inputs.items()) if port != CLOCK)
    aiger = Aiger.read(path).unrolled(cycles, first)
    aiger.write(path)
    inputs = {position: graph.inputs[place] for position, place in enumerate(first)}
    return replace(graph, inputs=inputs, free=aiger.inputs - len(first))


def structure(circuit: Circuit, commands: Sequence[str], *, timeout: float) -> dict[str, Any]:
    """The top module of a circuit in Yosys's JSON.

    Args:
        circuit: the circuit.
        commands: what Yosys does with it after it is read.
        timeout: seconds.

    Raises:
        ToolError: Yosys cannot read the circuit, or a command failed.
    """
    with tempfile.TemporaryDirectory(prefix="wnn2hdl-") as name:
        folder = Path(name)
        script = [*read_cells([circuit]), *read([circuit], folder)[0], *commands, "write_json circuit.json"]
        find_yosys().run("\n".join(script) + "\n", timeout=timeout, cwd=folder)
        modules = json.loads((folder / "circuit.json").read_text(encoding="utf-8"))["modules"]
    found: dict[str, Any] = modules[circuit.top]
    return found


def one_clock(circuit: Circuit) -> list[str]:
    """Commands that turn all registers of a flattened pipeline into ones at the rising edge of `CLOCK`."""
    return _ONE_CLOCK if circuit.latency else []


def read(circuits: Sequence[Circuit], folder: Path) -> list[list[str]]:
    """Write the sources; return for each circuit the commands that read it into an empty design.

    The commands are to be run in this order: texts that several circuits share are read once.

    Args:
        circuits: the circuits.
        folder: where Yosys will run.
    """
    left = Counter(circuit.sources for circuit in circuits)
    numbers: dict[tuple[str, ...], int] = {}
    scripts: list[list[str]] = []
    for circuit in circuits:
        left[circuit.sources] -= 1
        saved = numbers.get(circuit.sources)
        if saved is None:
            saved = numbers[circuit.sources] = len(numbers)
            script = [
                "design -reset",
                *(f"design -copy-from cells ={cell}" for cell in sorted(_cells(circuit))),
            ]
            for position, text in enumerate(circuit.sources):
                name = f"{saved}_{position}.v"
                (folder / name).write_text(text, encoding="utf-8")
                script.append(f"read_verilog -nooverwrite {name}")
            if left[circuit.sources]:
                script.append(f"design -save read_{saved}")
        else:
            script = [f"design -load read_{saved}"]
            if not left[circuit.sources]:
                # Of a network of 2,000 tables a text takes hundreds of megabytes.
                script.append(f"design -delete read_{saved}")
        # A module that asks a synthesiser to keep it would not be flattened.
        script += [f"hierarchy -check -top {circuit.top}", "setattr -mod -unset keep_hierarchy *", "proc"]
        scripts.append(script)
    return scripts


def read_cells(circuits: Sequence[Circuit]) -> list[str]:
    """Commands, ahead of `read`, that keep the models of 7-series cells at hand where they are needed."""
    needed = any(_cells(circuit) for circuit in circuits)
    return ["read_verilog +/xilinx/cells_sim.v", "design -stash cells"] if needed else []


def _cells(circuit: Circuit) -> set[str]:
    """Names of the 7-series cells that a circuit mentions."""
    return {cell for source in circuit.sources for cell in _PRIMITIVE.findall(source)}


def _checked(graph: Path, ports: Path, circuit: Circuit) -> _Graph:
    """Refuse a graph that is not a function of the circuit's inputs (AIGER header: ``aig M I L O A``)."""
    header = graph.read_bytes().split(b"\n", 1)[0].split()
    inputs, registers, outputs = (int(field) for field in header[2:5])
    named: dict[str, dict[int, tuple[str, int]]] = {"input": {}, "output": {}}
    for direction, place, bit, port in _PORT_BIT.findall(ports.read_text(encoding="utf-8")):
        named[direction][int(place)] = (port, int(bit))
    if registers and not circuit.latency:
        raise CheckError("the circuit has registers, so it is not combinational", value=circuit.top)
    if inputs != len(named["input"]):
        raise CheckError("the circuit reads an undefined value (x)", value=circuit.top)
    return _Graph(named["input"], named["output"], outputs)


def _same_diagram(files: Sequence[str], nodes: int, folder: Path, timeout: float) -> bool:
    """Whether the miter of two graphs is 0 as a binary decision diagram; False if that takes more nodes."""
    # -r: without reordering, which takes long; the order in which the graph reads its inputs will do.
    script = f"miter -n {' '.join(files)}; collapse -B {nodes} -r; strash; &get; &cec -m\n"
    try:
        found = _VERDICT.findall(run_abc(script, timeout=timeout, cwd=folder))
    except ToolError as error:
        if "Collapsing has failed" not in str(error):
            raise
        return False
    return found == ["equivalent"]


def _difference(verdict: str, path: Path, graph: _Graph) -> Difference:
    if verdict == "equivalent":
        return None
    if verdict == "UNDECIDED":
        return UNDECIDED
    bits = path.read_text(encoding="utf-8")
    values: dict[str, int] = {}
    for place, (port, bit) in graph.inputs.items():
        values[port] = values.get(port, 0) | int(bits[place]) << bit
    return values
