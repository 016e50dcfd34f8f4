"""Checking emitted Verilog against the model and counting what it costs, at the same time."""

import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from wnn2hdl.build.circuits import COUNTED, PARTS, SOBEL, Circuits
from wnn2hdl.build.design import Design
from wnn2hdl.build.simulating import simulate_apart
from wnn2hdl.files import write_text
from wnn2hdl.progress import Progress
from wnn2hdl.synth import Job, Synthesis, synthesise_all, synthesise_job
from wnn2hdl.tools import in_parallel
from wnn2hdl.verify.proof import METHOD, Proof, prove, prove_netlists
from wnn2hdl.verify.specification import PartName

_PROVE = "prove"


@dataclass(frozen=True, eq=False)
class Checked:
    """What checks and synthesis found.

    Attributes:
        syntheses: by part, ``sobel`` among them.
        status: ``proved`` or ``failed``.
        method: of the proof.
        proof_seconds: wall clock of the proofs of Verilog and netlists together.
        vectors: how many vectors each part was simulated on.
        seconds: when each of the checks and syntheses, which run side by side, was done.
        failure: why the circuit is not the model; None if it is.
    """

    syntheses: Mapping[str, Synthesis]
    status: str
    method: str
    proof_seconds: float
    vectors: Mapping[str, int]
    seconds: Mapping[str, float]
    failure: str | None


def check(design: Design, circuits: Circuits, progress: Progress) -> Checked:
    """Simulate in Amaranth, prove, synthesise, and prove what was synthesised.

    All but the last run side by side, in processes of their own; Ctrl-C ends all of them.

    Raises:
        ToolError: an outside program is missing or failed.
    """
    parts = PARTS[design.target]
    # The matcher takes about as long as all others together. What takes longest starts first.
    halves = [half for half in (parts[1:], parts[:1]) if half]
    jobs: dict[str, Callable[[], Any]] = {
        **{f"simulate {half[-1]}": partial(simulate_apart, circuits.verilog.parent, half) for half in halves},
        _PROVE: partial(prove, design.specification, dict.fromkeys(parts, circuits.verilog)),
        **{name: partial(synthesise_job, job) for name, job in synthesis_jobs(design, circuits).items()},
    }
    names, results, seconds = list(jobs), dict[str, Any](), dict[str, float]()
    started = time.perf_counter()
    progress("simulating, proving, counting", 0, len(jobs))
    for position, result in in_parallel(lambda job: job(), jobs.values()):
        results[names[position]] = result
        seconds[names[position]] = time.perf_counter() - started
        progress("simulating, proving, counting", len(results), len(jobs))
    proofs = results.pop(_PROVE)
    vectors: dict[str, int] = {}
    failure = None
    for half in halves:
        simulated, mismatch = results.pop(f"simulate {half[-1]}")
        vectors |= simulated
        failure = failure or mismatch
    syntheses: dict[str, Synthesis] = {name: results[name] for name in names if name in results}
    proofs_of_netlists = _prove_netlists(design, circuits, syntheses)
    failures = [failure, _refutation(proofs, "Verilog"), _refutation(proofs_of_netlists, "mapped netlist")]
    reason = next((text for text in failures if text), None)
    proof_seconds = sum(
        max(proof.seconds for proof in found.values()) for found in (proofs, proofs_of_netlists)
    )
    status = "failed" if reason else "proved"
    return Checked(syntheses, status, METHOD, proof_seconds, vectors, seconds, reason)


def synthesise_parts(design: Design, circuits: Circuits, progress: Progress) -> dict[str, Synthesis]:
    """Count what each circuit of a design takes, and the Sobel baseline."""
    jobs = synthesis_jobs(design, circuits)
    finished: list[str] = []

    def done(name: str) -> None:
        finished.append(name)
        progress("synthesising", len(finished), len(jobs))

    progress("synthesising", 0, len(jobs))
    return synthesise_all(jobs, done=done)


def synthesis_jobs(design: Design, circuits: Circuits) -> dict[str, Job]:
    """What is counted: each circuit of a design, and the Sobel baseline."""
    text = circuits.verilog.read_text(encoding="utf-8")
    jobs: dict[str, Job] = {
        part: Job(text, design.specification.part(part).module) for part in COUNTED[design.target]
    }
    jobs[SOBEL] = Job(circuits.sobel.read_text(encoding="utf-8"), SOBEL, baseline=True)
    return jobs


def _prove_netlists(
    design: Design, circuits: Circuits, syntheses: Mapping[str, Synthesis]
) -> dict[PartName, Proof]:
    with tempfile.TemporaryDirectory(prefix="wnn2hdl-") as name:
        netlists = {}
        for part in COUNTED[design.target]:
            path = Path(name) / f"{part}.v"
            write_text(path, syntheses[part].netlist_verilog)
            netlists[part] = (circuits.verilog, path)
        return prove_netlists(design.specification, netlists)


def _refutation(proofs: Mapping[PartName, Proof], what: str) -> str | None:
    for part, proof in proofs.items():
        if proof.counterexample is not None:
            return f"the {what} of the {part} differs from the model {proof.counterexample}"
    return None
