"""The checker's check: break emitted Verilog in small ways and see whether the proof notices.

Whether a mutant differs from the model on a cared-for input is decided apart from the proof: Icarus runs it
on stimulus, with the models of the vendor's cells that ship with a build. The proof has to refute every
mutant that differs. Where the stimulus is every cared-for input, it must refute no other; where it is not,
Icarus runs the proof's counterexample too, and a refuted mutant that equals the model there is a false alarm.
"""

import re
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, pairwise, zip_longest
from pathlib import Path
from typing import TypeVar

import numpy as np

from wnn2hdl.emit import cells_model
from wnn2hdl.errors import Wnn2hdlError
from wnn2hdl.verify.compiled import run_compiled
from wnn2hdl.verify.equivalence import Circuit, find_differences
from wnn2hdl.verify.holding import held_in_care
from wnn2hdl.verify.specification import Claim, Samples, Specification, value_bits

_STATEMENT = re.compile(
    r"\b(?:assign|wire)\b[^=;]*=(?P<sum>[^;]*);|(?P<pins>(?:\.I\d\s*\([^()]*(?:\([^()]*\))?[^()]*\)[\s,]*)+)"
)
_OPERAND = re.compile(
    r"(?P<inverted>~\s*)?(?<![\w'$.\\\]])(?P<signal>(?:\\\S+ |[A-Za-z_][\w$]*)(?:\s*\[\d+\])?)(?![\w$]|\s*\[)"
)
_CONSTANT = re.compile(r"\b(?P<width>\d+)'(?P<base>[hbd])(?P<digits>[0-9a-fA-F]+)\b")
_BASES = {"h": 16, "b": 2, "d": 10}
_MODULE = re.compile(r"^module (?P<name>\w+)\s*\((?P<ports>.*?)\);(?P<body>.*?)^endmodule$", re.DOTALL | re.M)
_PORT = re.compile(r"(?P<way>input|output)\s+(?:wire\s+)?(?:\[(?P<high>\d+):0\]\s*)?(?P<name>\w+)")
_INSTANCE = re.compile(
    r"^ +(?:\(\*[^)]*\*\) *)*(?P<kind>\w+)(?: #\([^;]*?\))? (?P<name>\w+) \((?P<pins>\..*?)\);$",
    re.DOTALL | re.M,
)
_PIN = re.compile(r"\.(?P<name>\w+)\((?P<value>[^()]*)\)")
_NET = re.compile(r"(?<![\w'.])[A-Za-z_]\w*")

Item = TypeVar("Item")
Result = TypeVar("Result")

_SECONDS = 600.0
_ATTEMPTS = 20


@dataclass(frozen=True)
class Mutant:
    """A circuit with one fault.

    Attributes:
        fault: what was changed, for a reader.
        verilog: the changed text.
    """

    fault: str
    verilog: str


@dataclass(frozen=True)
class MutationReport:
    """How the proof fared.

    Attributes:
        mutants: how many were made.
        harmful: how many of them differ from the model on a cared-for input.
        missed: harmful mutants that the proof let through.
        false_alarms: mutants that it refuted though they equal the model on every input that was tried.
    """

    mutants: int
    harmful: int
    missed: tuple[Mutant, ...]
    false_alarms: tuple[Mutant, ...]

    @property
    def caught(self) -> int:
        """Harmful mutants that the proof refuted."""
        return self.harmful - len(self.missed)

    def __str__(self) -> str:
        return (
            f"{self.caught} of {self.harmful} harmful mutants caught, {len(self.false_alarms)} false alarms "
            f"among {self.mutants - self.harmful} harmless ones"
        )


def make_mutants(verilog: str, count: int, seed: int) -> list[Mutant]:
    """Different mutants of a Verilog text, the same for the same seed: single faults, then several at once.

    Faults, as many of each kind as there are: a bit of a constant or of a LUT's contents flipped; an operand
    inverted, replaced by 0 or 1 (which drops a literal or a term), or exchanged with the next one of its
    expression; and of the hierarchy: two inputs of an instance exchanged, an input tied to 0 or 1, the
    inputs of two instances exchanged, an instance made one of another module with the same ports.

    Args:
        verilog: the text; expressions stand in ``assign``, ``wire`` and at the inputs of LUT cells.
        count: how many; fewer are returned if the text has no more in it.
        seed: of the random choice.
    """
    rng = np.random.default_rng(seed)
    mutants = list(_mutants_of(verilog, rng, count))
    known = {verilog, *(mutant.verilog for mutant in mutants)}
    # A circuit of one LUT has few single faults; what is missing are faults of faulty circuits.
    for _ in range(_ATTEMPTS * count if mutants else 0):
        if len(mutants) == count:
            break
        first = mutants[rng.integers(len(mutants))]
        for second in _mutants_of(first.verilog, rng, 1):
            if second.verilog not in known:
                known.add(second.verilog)
                mutants.append(Mutant(f"{first.fault}; {second.fault}", second.verilog))
    return mutants


def check_proof(
    specification: Specification, part: str, module: str, mutants: Sequence[Mutant], stimulus: Samples
) -> MutationReport:
    """Let the proof judge mutants of a circuit, and Icarus judge the proof.

    Args:
        specification: the model and its care set.
        part: the circuit.
        module: its module in the mutants' texts.
        mutants: of `make_mutants`.
        stimulus: cared-for inputs of the circuit.

    Raises:
        ToolError: a tool is missing.
    """
    claim = specification.claims[part]
    reference = held_in_care(specification, claim, Circuit((specification.reference,), claim.module))
    held = [held_in_care(specification, claim, Circuit((mutant.verilog,), module)) for mutant in mutants]
    verdicts = _one_by_one(
        held, lambda some: find_differences([(x, reference) for x in some], timeout=_SECONDS)
    )
    harmful = _differ(claim, module, mutants, stimulus)
    for number, found in enumerate(verdicts):
        if isinstance(found, dict) and not harmful[number]:
            inputs = claim.hold(
                {port: value_bits(found[port], width) for port, width in claim.inputs.items()}
            )
            harmful[number] = _differ(claim, module, [mutants[number]], inputs)[0]
    judged = list(zip(mutants, harmful, [found is not None for found in verdicts], strict=True))
    return MutationReport(
        mutants=len(mutants),
        harmful=sum(harmful),
        missed=tuple(mutant for mutant, bad, caught in judged if bad and not caught),
        false_alarms=tuple(mutant for mutant, bad, caught in judged if caught and not bad),
    )


def _one_by_one(
    items: Sequence[Item], judge: Callable[[Sequence[Item]], Sequence[Result]]
) -> list[Result | Wnn2hdlError]:
    """What a tool says of each item, all in one run; an item that it refuses has the error in its place."""
    if not items:
        return []
    try:
        return list(judge(items))
    except Wnn2hdlError as error:
        if len(items) == 1:
            return [error]
    middle = len(items) // 2
    return _one_by_one(items[:middle], judge) + _one_by_one(items[middle:], judge)


def _differ(claim: Claim, module: str, mutants: Sequence[Mutant], samples: Samples) -> list[bool]:
    """Whether each mutant differs from the model on a sample, or answers with undefined bits there."""
    expected = claim.answers(samples)
    matters = {port: judge(expected) for port, judge in claim.matters.items()}
    everywhere = np.ones(len(next(iter(samples.values()))), dtype=np.bool_)

    def simulate(some: Sequence[Mutant]) -> list[bool]:
        outputs = [
            (number, port, f"{port}_{number}") for number in range(len(some)) for port in claim.outputs
        ]
        together = replace(claim, outputs={name: claim.outputs[port] for _, port, name in outputs})
        with tempfile.TemporaryDirectory(prefix="wnn2hdl-") as name:
            path = Path(name) / "mutants.v"
            path.write_text(_side_by_side(claim, module, some) + cells_model(), encoding="utf-8")
            answers, _ = run_compiled(together, "mutants", [path], samples, "icarus", timeout=_SECONDS)
        differs = [False] * len(some)
        for number, port, output in outputs:
            wrong = (answers[output] != expected[port]).any(axis=1) & matters.get(port, everywhere)
            differs[number] |= bool(wrong.any())
        return differs

    return [isinstance(found, Wnn2hdlError) or found for found in _one_by_one(mutants, simulate)]


def _side_by_side(claim: Claim, module: str, mutants: Sequence[Mutant]) -> str:
    """A module ``mutants`` with the inputs of the claim and the outputs of every mutant, numbered."""
    header = [f"input [{width - 1}:0] {port}" for port, width in claim.inputs.items()]
    texts, lines = [], []
    for number, mutant in enumerate(mutants):
        pins = [f".{port}({port})" for port in claim.inputs]
        for port, width in claim.outputs.items():
            header.append(f"output [{width - 1}:0] {port}_{number}")
            pins.append(f".{port}({port}_{number})")
        texts.append(_renamed(mutant.verilog, number))
        lines.append(f"  {module}_{number} mutant_{number} ({', '.join(pins)});")
    return "\n".join([*texts, f"module mutants({', '.join(header)});", *lines, "endmodule", ""])


def _renamed(verilog: str, number: int) -> str:
    """The text with every module's name made its own by a number, so that many fit into one design."""
    names = re.findall(r"^\s*module\s+(\w+)", verilog, re.M)
    return re.sub(rf"(?<![\w$.])({'|'.join(names)})(?![\w$])", rf"\1_{number}", verilog)


def _mutants_of(verilog: str, rng: np.random.Generator, count: int) -> Iterator[Mutant]:
    """Up to ``count`` different mutants with one fault, in random order, the kinds of faults by turns."""
    kinds = [list(faults(verilog)) for faults in (_constant_faults, _operand_faults, _hierarchy_faults)]
    shuffled = [[edits[place] for place in rng.permutation(len(edits))] for edits in kinds]
    known = {verilog}
    for edit in (edit for turn in zip_longest(*shuffled) for edit in turn if edit is not None):
        changed = _applied(verilog, edit)
        if len(known) <= count and changed not in known:
            known.add(changed)
            line = verilog.count("\n", 0, edit.places[0].start) + 1
            yield Mutant(f"line {line}: {edit.fault}", changed)


@dataclass(frozen=True)
class _Place:
    """The characters from ``start`` to ``end`` become ``text``."""

    start: int
    end: int
    text: str


@dataclass(frozen=True)
class _Edit:
    """One fault: changes at places that follow each other in the text."""

    fault: str
    places: tuple[_Place, ...]


def _applied(verilog: str, edit: _Edit) -> str:
    for place in reversed(edit.places):
        verilog = f"{verilog[: place.start]}{place.text}{verilog[place.end :]}"
    return verilog


def _exchanged(left: re.Match[str], right: re.Match[str], group: str) -> tuple[_Place, _Place]:
    return (
        _Place(*left.span(group), right[group]),
        _Place(*right.span(group), left[group]),
    )


def _constant_faults(verilog: str) -> Iterator[_Edit]:
    for match in _CONSTANT.finditer(verilog):
        value = int(match["digits"], _BASES[match["base"]])
        for bit in range(int(match["width"])):
            changed = f"{match['width']}'h{value ^ 1 << bit:x}"
            yield _Edit(f"bit {bit} of {match[0]} flipped", (_Place(*match.span(), changed),))


def _operand_faults(verilog: str) -> Iterator[_Edit]:
    for statement in _STATEMENT.finditer(verilog):
        group = "sum" if statement["sum"] is not None else "pins"
        operands = list(_OPERAND.finditer(verilog, statement.start(group), statement.end(group)))
        for operand in operands:
            inverted = operand["signal"] if operand["inverted"] else f"~{operand['signal']}"
            for changed in (inverted, "1'h0", "1'h1"):
                yield _Edit(f"{operand[0]} became {changed}", (_Place(*operand.span(), changed),))
        for left, right in pairwise(operands):
            yield _Edit(
                f"{left['signal']} and {right['signal']} exchanged", _exchanged(left, right, "signal")
            )


def _hierarchy_faults(verilog: str) -> Iterator[_Edit]:
    ports = {
        module["name"]: {
            port["name"]: (port["way"], int(port["high"] or 0) + 1)
            for port in _PORT.finditer(module["ports"])
        }
        for module in _MODULE.finditer(verilog)
    }
    for module in _MODULE.finditer(verilog):
        driven_outside = {name for name, (way, _) in ports[module["name"]].items() if way == "input"}
        instances = [
            instance
            for instance in _INSTANCE.finditer(verilog, *module.span("body"))
            if instance["kind"] in ports
        ]
        for instance in instances:
            yield from _connection_faults(verilog, instance, ports[instance["kind"]])
            for other, its_ports in ports.items():
                if other != instance["kind"] and its_ports == ports[instance["kind"]]:
                    place = _Place(*instance.span("kind"), other)
                    yield _Edit(f"{instance['name']} became a {other}", (place,))
        for left, right in combinations(instances, 2):
            loops = _driven_between(verilog, left, right, driven_outside)
            if left["kind"] == right["kind"] and not loops:
                wired = ports[left["kind"]]
                pairs = zip(_inputs(verilog, left, wired), _inputs(verilog, right, wired), strict=True)
                swaps = [_exchanged(one, other, "value") for one, other in pairs]
                places = (*(first for first, _ in swaps), *(second for _, second in swaps))
                yield _Edit(f"{left['name']} and {right['name']} exchanged", places)


def _connection_faults(
    verilog: str, instance: re.Match[str], ports: Mapping[str, tuple[str, int]]
) -> Iterator[_Edit]:
    inputs = _inputs(verilog, instance, ports)
    for pin in inputs:
        width = ports[pin["name"]][1]
        for digit in "01":
            place = _Place(*pin.span("value"), f"{{{width}{{1'b{digit}}}}}")
            yield _Edit(f"{pin['name']} of {instance['name']} tied to {digit}", (place,))
    for left, right in combinations(inputs, 2):
        if ports[left["name"]] == ports[right["name"]]:
            fault = f"{left['name']} and {right['name']} of {instance['name']} exchanged"
            yield _Edit(fault, _exchanged(left, right, "value"))


def _inputs(
    verilog: str, instance: re.Match[str], ports: Mapping[str, tuple[str, int]]
) -> list[re.Match[str]]:
    pins = _PIN.finditer(verilog, *instance.span("pins"))
    return [pin for pin in pins if ports[pin["name"]][0] == "input"]


def _driven_between(verilog: str, left: re.Match[str], right: re.Match[str], inputs: set[str]) -> bool:
    """Whether the right one reads what is driven at or after the left one: exchanged, they would loop."""
    between = (left.start(), right.start())
    driven = set(re.findall(r"\b(?:wire|assign)\s+(?:\[\d+:0\]\s*)?(\w+)\s*=", verilog[slice(*between)]))
    for instance in _INSTANCE.finditer(verilog, *between):
        driven |= set(_NET.findall(instance["pins"]))
    return bool((driven - inputs) & set(_NET.findall(right["pins"])))
