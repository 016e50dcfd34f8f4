"""From a model to a build folder: plan, emit, check, count, report."""

import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from wnn2hdl.build.checking import Checked, check
from wnn2hdl.build.design import Design
from wnn2hdl.build.emission import emit, generators
from wnn2hdl.build.folder import FAILED, REPORT_FILE, REPORT_PAGE, SAMPLE_FILE, resolved, staged
from wnn2hdl.build.measuring import Measured, labelled_data, measure
from wnn2hdl.build.planning import CompileOptions, Plan, plan
from wnn2hdl.build.reporting import command, evaluation, sample_picture, write_page
from wnn2hdl.dataset import Dataset
from wnn2hdl.emit import write_manifest
from wnn2hdl.errors import CheckError
from wnn2hdl.files import write_json, write_text
from wnn2hdl.images import write_png
from wnn2hdl.ir.identifiers import name_from, require_name
from wnn2hdl.ir.models import AnyModel, LogicModel
from wnn2hdl.progress import Progress
from wnn2hdl.report import (
    BuildReport,
    Care,
    EdgeFigures,
    Minimised,
    PartFigures,
    Proof,
    model_figures,
    report_dict,
    report_markdown,
)
from wnn2hdl.synth import OPTIONS, XC7Z020, shares


@dataclass(frozen=True, eq=False)
class Build:
    """A finished build.

    Attributes:
        folder: where it lies.
        report: the object of its `report.json`.
        failure: why the circuit is not the model; None if it is.
    """

    folder: Path
    report: dict[str, Any]
    failure: str | None


@dataclass
class _Clock:
    """Wall-clock seconds by stage."""

    seconds: dict[str, float] = field(default_factory=dict)

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        started = time.perf_counter()
        yield
        self.seconds[name] = time.perf_counter() - started


def compile_model(
    model: AnyModel,
    folder: Path,
    options: CompileOptions,
    progress: Progress,
) -> Build:
    """Compile a model into a folder.

    The folder appears when all is written; where a check fails it holds a file `FAILED` that says why.

    Args:
        model: the model.
        folder: the build folder; an earlier build there is replaced.
        options: the user's choices.
        progress: called with every stage.

    Raises:
        InputError: the model or the imagery cannot be used, the test masks have other classes, or the folder
            cannot be written.
        ToolError: an outside program is missing or failed.
    """
    labelled = labelled_data(model, options)
    name = require_name(options.name) if options.name else name_from(resolved(folder).name)
    clock = _Clock()
    with staged(folder) as staging:
        with clock.stage("plan"):
            planned = plan(model, name, options, progress)
        with clock.stage("emit"):
            progress("writing Verilog", 0, 1)
            files = emit(planned.design, staging, sobel_threshold=options.sobel_threshold)
            progress("writing Verilog", 1, 1)
        with clock.stage("check and synthesise"):
            checked = check(planned.design, files, progress, afresh=False)
        with clock.stage("evaluate"):
            measured = measure(planned.design, labelled, progress)
        report = report_dict(_report(folder.name, planned, options, checked, measured, clock))
        write_json(staging / REPORT_FILE, report)
        write_text(staging / REPORT_PAGE, report_markdown(report))
        write_png(staging / SAMPLE_FILE, sample_picture(labelled if isinstance(labelled, Dataset) else None))
        write_page(staging)
        if checked.failure is not None:
            write_text(staging / FAILED, checked.failure + "\n")
        names = sorted(path.name for path in staging.iterdir())
        write_manifest(staging, names, versions=report["tools"], options=report["options"])
    return Build(folder, report, checked.failure)


def require_equal(build: Build) -> None:
    """Raise `CheckError` if the circuit was found to differ from the model."""
    if build.failure is not None:
        raise CheckError("the circuit is not the model", value=build.failure, hint=f"see {build.folder}")


def require_proved(unproved: Sequence[str], allowed: Sequence[str]) -> None:
    """Raise `CheckError` if a limit left anything unproved but what is allowed."""
    left = [name for name in unproved if name not in allowed]
    if left:
        raise CheckError(
            "a limit left parts UNPROVED",
            value=", ".join(left),
            hint="name with --allow-unproved what may stay so",
        )


def require_luts(build: Build, max_luts: int) -> None:
    """Raise `CheckError` if the build's target takes more than ``max_luts`` LUTs."""
    luts = build.report["parts"][build.report["target"]]["luts"]
    if luts > max_luts:
        raise CheckError(
            f"the {build.report['target']} takes more LUTs than allowed",
            value=f"{luts}, allowed are {max_luts}",
            hint="try domain mode, another model or more --effort",
        )


def _report(
    name: str,
    planned: Plan,
    options: CompileOptions,
    checked: Checked,
    measured: Measured,
    clock: _Clock,
) -> BuildReport:
    design = planned.design
    edges = _edges(planned, options)
    figures = {part: PartFigures(**asdict(result.resources)) for part, result in checked.syntheses.items()}
    return BuildReport(
        name=name,
        target=design.target.name,
        mode=design.mode,
        latency=design.latency,
        stage_ps=None if design.stages is None else design.stages.period,
        parts=figures,
        count=OPTIONS,
        device=XC7Z020.name,
        utilisation={part: shares(result.resources) for part, result in checked.syntheses.items()},
        minimised={
            part: Minimised(
                cubes_before=cover.cubes_before,
                cubes_after=len(cover.cover.cubes),
                literals_before=cover.literals_before,
                literals_after=cover.cover.literals,
            )
            for part, cover in planned.covers.items()
        },
        proof=Proof(
            checked.status,
            method(design, checked),
            checked.proof_seconds,
            checked.failure,
            checked.proved_before,
            tuple(map(asdict, checked.claims)),
            checked.unproved,
        ),
        care=_care(design, measured.coverage),
        edges=edges,
        accuracy=measured.accuracy,
        model_accuracy=measured.model_accuracy,
        confusion=measured.confusion,
        light=measured.light,
        rows=measured.rows,
        model=model_figures(design.model),
        command=command(name, options),
        evaluation=evaluation(name, options) if measured.accuracy is not None else None,
        options={
            **{
                key: str(value) if isinstance(value, Path) else value
                for key, value in asdict(options).items()
            },
            "target": design.target.name,
            "name": design.name,
            "latency": design.latency,
            "edge_patterns": edges.patterns,
            "mapping": dict(planned.methods),
            "simulated_vectors": dict(checked.vectors),
            "simulated_before": ", ".join(checked.simulated_before),
            "pruned": _pruned(planned),
            "left_out": {"care": planned.left_out, "test_images": measured.left_out},
        },
        hashes={"model": design.model.digest()},
        tools=generators(),
        seconds={**clock.seconds, **checked.seconds},
    )


def _pruned(planned: Plan) -> dict[str, int | None]:
    found = planned.pruned
    if found is None:
        return {}
    return {"tables": found.tables, "of": found.of, "rows": found.rows, "changed": found.changed}


def method(design: Design, checked: Checked) -> str:
    """How a design was checked against its model, in words."""
    if design.has_memories:
        return f"{checked.method}; the registers and memories of the core around them simulated"
    if isinstance(design.model, LogicModel) and not checked.vectors:
        return f"{checked.method}; too large to be simulated, so evaluated on samples instead"
    return checked.method


def _care(design: Design, coverage: float | None) -> Care:
    if design.care is None:
        return Care()
    cared = design.care.project(tuple(range(design.care.width)))
    return Care(int(cared.sum()), coverage, len(cared))


def _edges(planned: Plan, options: CompileOptions) -> EdgeFigures:
    edge_filter, agreement = planned.design.edges, planned.agreement
    if edge_filter is None:
        return EdgeFigures()
    figures = EdgeFigures(edge_filter.name, edge_filter.size)
    if agreement is None:
        return figures
    return replace(
        figures,
        precision=agreement.precision,
        recall=agreement.recall,
        f1=agreement.f1,
        imagery=str(options.imagery),
    )
