"""Checking emitted Verilog against the model and counting what it costs, at the same time."""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from wnn2hdl.build import remembered
from wnn2hdl.build.design import IP, Design
from wnn2hdl.build.emission import SOBEL, Files, baseline_module
from wnn2hdl.build.simulating import simulate_apart, simulate_parts, simulated_inputs
from wnn2hdl.build.streaming import sample_frames
from wnn2hdl.files import read_text
from wnn2hdl.progress import Progress
from wnn2hdl.synth import Job, Synthesis, synthesise_all
from wnn2hdl.tools import in_parallel
from wnn2hdl.verify.equivalence import Circuit
from wnn2hdl.verify.holding import sides
from wnn2hdl.verify.proof import MODEL, Proof, Status, method, prove, prove_netlists
from wnn2hdl.verify.specification import Specification

_MANY = 1 << 16
"""Vectors above which a circuit is simulated in its own process."""


@dataclass(frozen=True)
class ProvedClaim:
    """What was to be proved of a part, and what came of it."""

    part: str
    statement: str
    status: Status


@dataclass(frozen=True, eq=False)
class Checked:
    """What checks and synthesis found.

    Attributes:
        syntheses: by part, ``sobel`` among them.
        proof_seconds: wall clock of the proofs of Verilog and netlists together.
        vectors: how many vectors each part was simulated on.
        simulated_before: parts whose simulation passed before, on the same vectors.
        proved_before: parts of which the same Verilog and the same netlist were proved before.
        method: what proved it.
        seconds: when each of the checks and syntheses, which run side by side, was done.
        claims: all that was to be proved of the Verilog, the pieces of a circuit ahead of it.
        unproved: names of what a limit left unproved: parts, and ``PART netlist`` for a mapped netlist.
        failure: why the circuit is not the model; None if no difference was found.
    """

    syntheses: Mapping[str, Synthesis]
    proof_seconds: float
    vectors: Mapping[str, int]
    simulated_before: tuple[str, ...]
    proved_before: tuple[str, ...]
    method: str
    seconds: Mapping[str, float]
    claims: tuple[ProvedClaim, ...]
    unproved: tuple[str, ...]
    failure: str | None

    @property
    def status(self) -> str:
        """``proved``, ``failed`` or ``UNPROVED``."""
        if self.failure:
            return "failed"
        return "UNPROVED" if self.unproved else "proved"


def check(design: Design, files: Files, progress: Progress, *, afresh: bool) -> Checked:
    """Simulate in Amaranth, prove, synthesise, and prove what was synthesised.

    All but the last run side by side; Ctrl-C ends all of them.

    Args:
        design: the design.
        files: its emitted files.
        progress: reports each check that is done.
        afresh: simulate and prove also what is remembered to have passed before.

    Raises:
        InputError: an emitted file is missing or no text any more.
        ToolError: an outside program is missing or failed.
    """
    simulations = _Simulations(design, files, afresh=afresh)
    counted = synthesis_jobs(design, files)
    specification = design.specification
    emitted = {
        part: Circuit((counted[part].verilog,), counted[part].top, circuit.latency)
        for part, circuit in design.parts.items()
    }
    claimed = {part: circuit for part, circuit in emitted.items() if part in specification.claims}
    verilog = Proofs(
        {part: sides(specification, specification.claims[part], claimed[part]) for part in claimed},
        afresh=afresh,
    )
    jobs: dict[str, Callable[[], Any]] = {**simulations.jobs, "synthesise": partial(synthesise_all, counted)}
    if verilog.due:
        pieces = specification.composition.pieces if specification.composition else {}
        jobs["prove"] = partial(
            prove, specification, {part: emitted[part] for part in (*pieces, *verilog.due)}
        )
    names, results, seconds = list(jobs), dict[str, Any](), dict[str, float]()
    started = time.perf_counter()
    progress("simulating, proving, counting", 0, len(jobs))
    for position, result in in_parallel(lambda job: job(), jobs.values()):
        results[names[position]] = result
        seconds[names[position]] = time.perf_counter() - started
        progress("simulating, proving, counting", len(results), len(jobs))
    vectors, mismatch = simulations.outcome(results)
    verilog.note(results.get("prove", {}))
    syntheses: dict[str, Synthesis] = results["synthesise"]
    pairs = {
        part: (circuit, replace(circuit, sources=(syntheses[part].netlist_verilog,)))
        for part, circuit in emitted.items()
    }
    netlists = Proofs(pairs, afresh=afresh)
    if netlists.due:
        widths = {part: circuit.widths for part, circuit in design.parts.items()}
        graphs = set(pairs) if specification.is_of_network else set[str]()
        netlists.note(prove_netlists({part: pairs[part] for part in netlists.due}, widths, graphs))
    failures = [
        mismatch,
        refutation(verilog.found, "Verilog"),
        refutation(netlists.found, "mapped netlist"),
    ]
    return Checked(
        syntheses,
        verilog.seconds + netlists.seconds,
        vectors,
        tuple(simulations.passed),
        tuple(part for part in emitted if part not in {*verilog.due, *netlists.due}),
        method(specification),
        seconds,
        _claims(specification, verilog.found),
        (*undecided(specification, verilog.found), *_undecided_netlists(netlists.found)),
        next((text for text in failures if text), None),
    )


def synthesise_parts(design: Design, files: Files, progress: Progress) -> dict[str, Synthesis]:
    """Count what each circuit of a design takes, and the Sobel baseline."""
    jobs = synthesis_jobs(design, files)
    finished: list[str] = []

    def done(name: str) -> None:
        finished.append(name)
        progress("synthesising", len(finished), len(jobs))

    progress("synthesising", 0, len(jobs))
    return synthesise_all(jobs, done=done)


def synthesis_jobs(design: Design, files: Files) -> dict[str, Job]:
    """What is counted: circuits, the core around them without and with registers, and Sobel."""
    text = read_text(files.verilog, "Verilog")
    whole = (design.circuit.name, IP) if design.has_memories else ()
    jobs = {part: Job(text, design.module(part)) for part in (*design.parts, *whole)}
    jobs[SOBEL] = Job(read_text(files.sobel, "Verilog"), baseline_module(design), baseline=True)
    return jobs


class _Simulations:
    """The simulations of a design: remembered ones are left out, long ones get their own process."""

    def __init__(self, design: Design, files: Files, *, afresh: bool) -> None:
        claims = design.specification.claims
        counts: dict[str, int] = {}
        self.keys: dict[str, remembered.Key] = {}
        for part, circuit in design.parts.items():
            claim = claims.get(part)
            inputs = None if claim is None else simulated_inputs(design, claim)
            if claim is not None and inputs is not None:
                answers = claim.answers(inputs)
                counts[part] = len(next(iter(inputs.values())))
                self.keys[part] = remembered.simulation_key(circuit, design.style, inputs, answers)
        if design.video is not None:
            core, beats = design.top, sample_frames(design)
            counts[core.name] = len(beats)
            self.keys[core.name] = remembered.simulation_key(
                core,
                design.style,
                {"pixels": beats.pixels, "starts": beats.starts, "ends": beats.ends},
                {"answers": beats.answers, "squares": np.array(beats.voted())},
                design.video,
            )
        if design.engine is not None:
            small = design.engine.small()
            rounds = small.sample_rounds()
            counts[design.top.name] = len(rounds)
            self.keys[design.top.name] = remembered.simulation_key(
                design.top,
                design.style,
                {"sizes": np.array([*small.template, *small.segment, small.lanes, small.columns])},
                {"words": np.array([answer.words for answer in small.answers(rounds)])},
            )
        self.passed = {
            part: counts[part] for part, key in self.keys.items() if not afresh and remembered.passed(key)
        }
        parts = [part for part in counts if part not in self.passed]
        self.jobs: dict[str, Callable[[], Any]] = {
            f"simulate {part}": partial(simulate_apart, files.verilog.parent, [part])
            for part in parts
            if counts[part] >= _MANY
        }
        short = [part for part in parts if counts[part] < _MANY]
        if short:
            self.jobs["simulate"] = partial(simulate_parts, design, short)

    def outcome(self, results: Mapping[str, Any]) -> tuple[dict[str, int], str | None]:
        """The vectors of each part, and the first mismatch in words; None if there is none."""
        vectors, failure = dict(self.passed), None
        for name in self.jobs:
            simulated, mismatch = results[name]
            vectors |= simulated
            failure = failure or mismatch
        for part in vectors:
            remembered.remember(self.keys[part])
        return {part: vectors[part] for part in self.keys if part in vectors}, failure


class Proofs:
    """Proofs of one kind, by circuit: remembered ones are left out.

    Attributes:
        due: the circuits to prove.
        found: the outcome for each of them.
    """

    def __init__(self, pairs: Mapping[str, tuple[Circuit, Circuit]], *, afresh: bool) -> None:
        self.keys = {part: remembered.proof_key(*pair) for part, pair in pairs.items()}
        self.due = [part for part, key in self.keys.items() if afresh or not remembered.passed(key)]
        self.found: Mapping[str, Proof] = {}

    @property
    def seconds(self) -> float:
        """Wall clock of the call that proved what was due."""
        return max((proof.seconds for proof in self.found.values()), default=0.0)

    def note(self, found: Mapping[str, Proof]) -> None:
        """Take the outcomes of what was due, and remember the successes."""
        self.found = found
        for part, proof in found.items():
            if part in self.keys and proof.status == "proved":
                remembered.remember(self.keys[part])


def _claims(specification: Specification, found: Mapping[str, Proof]) -> tuple[ProvedClaim, ...]:
    """All claims about a design; what was not proved now was proved before."""
    pieces = specification.composition.pieces if specification.composition else {}
    stated = {part: piece.statement for part, piece in pieces.items()}
    stated |= dict.fromkeys(specification.claims, MODEL)
    return tuple(
        ProvedClaim(part, statement, found[part].status if part in found else "proved")
        for part, statement in stated.items()
    )


def undecided(specification: Specification, found: Mapping[str, Proof]) -> list[str]:
    """The claims that are open, and of one that rests on pieces the pieces that are open."""
    undecided = [part for part, proof in found.items() if proof.status == "undecided"]
    claims = [part for part in undecided if part in specification.claims]
    pieces = [part for part in undecided if part not in specification.claims]
    return pieces if claims and pieces else claims


def _undecided_netlists(found: Mapping[str, Proof]) -> list[str]:
    return [f"{part} netlist" for part, proof in found.items() if proof.status == "undecided"]


def refutation(proofs: Mapping[str, Proof], what: str) -> str | None:
    """In words, the first difference that proofs found; None if they found none."""
    for part, proof in proofs.items():
        if proof.counterexample is not None:
            return f"the {what} of the {part} differs from the model {proof.counterexample}"
    return None
