"""Checking emitted Verilog against the model and counting what it costs, at the same time."""

import tempfile
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from wnn2hdl.errors import CheckError, ToolError
from wnn2hdl.ir.files import write_text
from wnn2hdl.pipeline.circuits import COUNTED, PARTS, SIMULATED, SOBEL, Circuits, component, port_arrays
from wnn2hdl.pipeline.design import Design
from wnn2hdl.pipeline.training import Progress
from wnn2hdl.synth import Job, Synthesis, synthesise, synthesise_all
from wnn2hdl.tools import in_parallel
from wnn2hdl.verify.proof import METHOD, Proof, prove, prove_netlists
from wnn2hdl.verify.simulation import simulate
from wnn2hdl.verify.specification import PartName
from wnn2hdl.verify.vectors import stimulus

_SIMULATE, _PROVE = "simulate", "prove"


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

    All but the last run side by side; proof and synthesis in processes of their own. Ctrl-C ends all of them.

    Raises:
        ToolError: an outside program is missing or failed.
    """
    stopped = threading.Event()
    jobs: dict[str, Callable[[], Any]] = {
        _SIMULATE: partial(_simulate, design, _until(stopped, progress)),
        _PROVE: partial(prove, design.specification, dict.fromkeys(PARTS[design.target], circuits.verilog)),
        **{name: partial(_synthesise, job) for name, job in synthesis_jobs(design, circuits).items()},
    }
    names, results, seconds = list(jobs), dict[str, Any](), dict[str, float]()
    started = time.perf_counter()
    try:
        for position, result in in_parallel(lambda job: job(), jobs.values()):
            results[names[position]] = result
            seconds[names[position]] = time.perf_counter() - started
            progress("proving and synthesising", len(results), len(jobs))
    finally:
        stopped.set()
    (vectors, failure), proofs = results.pop(_SIMULATE), results.pop(_PROVE)
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

    return synthesise_all(jobs, done=done)


def synthesis_jobs(design: Design, circuits: Circuits) -> dict[str, Job]:
    """What is counted: each circuit of a design, and the Sobel baseline."""
    text = circuits.verilog.read_text(encoding="utf-8")
    jobs: dict[str, Job] = {
        part: Job(text, design.specification.part(part).module) for part in COUNTED[design.target]
    }
    jobs[SOBEL] = Job(circuits.sobel.read_text(encoding="utf-8"), SOBEL, baseline=True)
    return jobs


def _synthesise(job: Job) -> Synthesis:
    return synthesise(job.verilog, job.top, baseline=job.baseline)


def _simulate(design: Design, progress: Progress) -> tuple[dict[str, int], str | None]:
    """Simulate the circuits; return the number of vectors of each, and the first mismatch in words."""
    vectors: dict[str, int] = {}
    for part in SIMULATED[design.target]:
        inputs = stimulus(design.specification, part)
        expected = design.specification.evaluate(part, inputs)
        try:
            result = simulate(
                component(design, part),
                port_arrays(inputs),
                port_arrays(expected),
                progress=partial(progress, f"simulating {part}"),
            )
        except CheckError as error:
            return vectors, error.line()
        vectors[part] = result.vectors
    return vectors, None


def _until(stopped: threading.Event, progress: Progress) -> Progress:
    """Progress of a thread that nothing can kill: it ends by an error once the work around it has ended."""

    def report(step: str, done: int, total: int) -> None:
        if stopped.is_set():
            raise ToolError("stopped, since the work around it has ended")
        progress(step, done, total)

    return report


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
