"""The checker's check: break emitted Verilog in small ways and see whether the proof notices.

Whether a mutant differs from the model on a cared-for input is decided apart from the proof: a simulator runs
it on every cared-for code. The proof has to refute exactly the mutants that differ.
"""

import re
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import WINDOW_CODES
from wnn2hdl.verify.compiled import CompiledSimulator, run_compiled
from wnn2hdl.verify.equivalence import find_differences
from wnn2hdl.verify.proof import held_in_care
from wnn2hdl.verify.reference import reference_name, reference_verilog
from wnn2hdl.verify.specification import Part, Samples, Specification, word_to_pixels

_STATEMENT = re.compile(
    r"\b(?:assign|wire)\b[^=;]*=(?P<sum>[^;]*);|(?P<pins>(?:\.I\d\s*\([^()]*(?:\([^()]*\))?[^()]*\)[\s,]*)+)"
)
_OPERAND = re.compile(
    r"(?P<inverted>~\s*)?(?<![\w'$.\\\]])(?P<signal>(?:\\\S+ |[A-Za-z_][\w$]*)(?:\s*\[\d+\])?)(?![\w$]|\s*\[)"
)
_CONSTANT = re.compile(r"\b(?P<width>\d+)'(?P<base>[hbd])(?P<digits>[0-9a-fA-F]+)\b")
_BASES = {"h": 16, "b": 2, "d": 10}
_MODULE = re.compile(r"^\s*module\s+(\\\S+|\w+)", re.MULTILINE)

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
        false_alarms: mutants it refuted though they equal the model on every cared-for input.
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

    Faults: a bit of a constant or of a LUT's contents flipped; an operand inverted, replaced by 0 or 1 (which
    drops a literal or a term), or exchanged with the next one of its expression.

    Args:
        verilog: the text; expressions stand in ``assign`` and at the inputs of LUT cells.
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
    specification: Specification,
    part: Literal["pixel", "edge"],
    mutants: list[Mutant],
    simulator: CompiledSimulator,
) -> MutationReport:
    """Let the proof judge mutants of a circuit, and a simulator judge the proof.

    Args:
        specification: the model and its care set.
        part: the circuit; its cared-for codes are few enough to simulate all of them.
        mutants: of `make_mutants`.
        simulator: who decides which mutants differ from the model.

    Raises:
        ToolError: a tool is missing or failed.
    """
    harmful = _differs(specification, part, mutants, simulator)
    reference = held_in_care(specification, part, reference_verilog(specification), reference_name(part))
    module = specification.part(part).module
    pairs = [(held_in_care(specification, part, mutant.verilog, module), reference) for mutant in mutants]
    refuted = [difference is not None for difference in find_differences(pairs, timeout=_SECONDS)]
    verdicts = list(zip(mutants, harmful, refuted, strict=True))
    return MutationReport(
        mutants=len(mutants),
        harmful=int(harmful.sum()),
        missed=tuple(mutant for mutant, bad, caught in verdicts if bad and not caught),
        false_alarms=tuple(mutant for mutant, bad, caught in verdicts if caught and not bad),
    )


def _mutants_of(verilog: str, rng: np.random.Generator, count: int) -> Iterator[Mutant]:
    """Up to ``count`` different mutants with one fault, in random order."""
    edits = [*_constant_faults(verilog), *_operand_faults(verilog)]
    known = {verilog}
    for place in rng.permutation(len(edits)):
        edit = edits[place]
        changed = f"{verilog[: edit.start]}{edit.text}{verilog[edit.end :]}"
        if len(known) <= count and changed not in known:
            known.add(changed)
            line = verilog.count("\n", 0, edit.start) + 1
            yield Mutant(f"line {line}: {edit.fault}", changed)


@dataclass(frozen=True)
class _Edit:
    """One fault: the characters from ``start`` to ``end`` become ``text``."""

    start: int
    end: int
    text: str
    fault: str


def _constant_faults(verilog: str) -> Iterator[_Edit]:
    for match in _CONSTANT.finditer(verilog):
        value = int(match["digits"], _BASES[match["base"]])
        for bit in range(int(match["width"])):
            changed = f"{match['width']}'h{value ^ 1 << bit:x}"
            yield _Edit(match.start(), match.end(), changed, f"bit {bit} of {match[0]} flipped")


def _operand_faults(verilog: str) -> Iterator[_Edit]:
    for statement in _STATEMENT.finditer(verilog):
        group = "sum" if statement["sum"] is not None else "pins"
        operands = list(_OPERAND.finditer(verilog, statement.start(group), statement.end(group)))
        for operand in operands:
            inverted = operand["signal"] if operand["inverted"] else f"~{operand['signal']}"
            for changed in (inverted, "1'h0", "1'h1"):
                yield _Edit(operand.start(), operand.end(), changed, f"{operand[0]} became {changed}")
        for left, right in pairwise(operands):
            between = verilog[left.end("signal") : right.start("signal")]
            yield _Edit(
                left.start("signal"),
                right.end("signal"),
                f"{right['signal']}{between}{left['signal']}",
                f"{left['signal']} and {right['signal']} exchanged",
            )


def _differs(
    specification: Specification,
    part: Literal["pixel", "edge"],
    mutants: list[Mutant],
    simulator: CompiledSimulator,
) -> NDArray[np.bool_]:
    """Whether each mutant differs from the model on a cared-for code; one simulation runs all of them."""
    ports = specification.part(part)
    (output, width), (port, input_width) = *ports.outputs.items(), *ports.inputs.items()
    outputs = {f"{output}_{number}": width for number in range(len(mutants))}
    header = [f"input [{input_width - 1}:0] {port}"]
    header += [f"output [{width - 1}:0] {name}" for name in outputs]
    texts, lines = [], [f"module mutants({', '.join(header)});"]
    for number, mutant in enumerate(mutants):
        texts.append(_renamed(mutant.verilog, number))
        lines.append(
            f"  {ports.module}_{number} mutant_{number} (.{port}({port}), .{output}({output}_{number}));"
        )
    with tempfile.TemporaryDirectory(prefix="wnn2hdl-") as name:
        path = Path(name) / "mutants.v"
        path.write_text("\n".join([*texts, *lines, "endmodule", ""]), encoding="utf-8")
        samples = _cared_samples(specification, part)
        answers, _ = run_compiled(Part("mutants", ports.inputs, outputs), [path], samples, simulator)
    expected = specification.evaluate(part, samples)[output]
    return np.array([bool((answers[name] != expected).any()) for name in outputs])


def _cared_samples(specification: Specification, part: Literal["pixel", "edge"]) -> Samples:
    if part == "edge":
        return {"bits": np.arange(WINDOW_CODES)[specification.window_care]}
    positions = specification.encoder.pixel_positions
    words = [
        sum((code >> bit & 1) << position for bit, position in enumerate(positions))
        for code in np.flatnonzero(specification.pixel_care).tolist()
    ]
    return {"rgb": np.concatenate([word_to_pixels(word, 1) for word in words])}


def _renamed(verilog: str, number: int) -> str:
    """The text with every module's name made its own by a number, so that many fit into one design."""
    for name in _MODULE.findall(verilog):
        if name.startswith("\\"):
            verilog = verilog.replace(f"{name} ", f"{name}_{number} ")
        else:
            verilog = re.sub(rf"(?<![\w$.\\]){name}(?![\w$])", f"{name}_{number}", verilog)
    return verilog
