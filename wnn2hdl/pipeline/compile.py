"""From a model to a build folder: plan, emit, check, count, report."""

import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field, replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

from wnn2hdl.dataset import Dataset
from wnn2hdl.emit import write_manifest
from wnn2hdl.errors import CheckError
from wnn2hdl.ir import WisardModel
from wnn2hdl.ir.files import write_json, write_text
from wnn2hdl.pipeline.checking import Checked, check
from wnn2hdl.pipeline.circuits import GENERATORS, emit
from wnn2hdl.pipeline.design import Design
from wnn2hdl.pipeline.evaluation import circuit_answers, evaluate
from wnn2hdl.pipeline.folder import FAILED, REPORT_FILE, REPORT_PAGE, staged
from wnn2hdl.pipeline.planning import CompileOptions, Plan, plan
from wnn2hdl.pipeline.training import Progress, pixel_encoder
from wnn2hdl.report import (
    BuildReport,
    Care,
    EdgeFigures,
    Minimised,
    PartFigures,
    Parts,
    Proof,
    report_dict,
    report_markdown,
)
from wnn2hdl.synth import OPTIONS, XC7Z020, Synthesis, utilisation
from wnn2hdl.tables import coverage
from wnn2hdl.tools import find_yosys


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
    model: WisardModel,
    folder: Path,
    options: CompileOptions,
    progress: Progress,
    test_set: Dataset | None = None,
) -> Build:
    """Compile a model into a folder.

    The folder appears when all is written; where a check fails it holds a file `FAILED` that says why.

    Args:
        model: a pixel model.
        folder: the build folder; an earlier build there is replaced.
        options: the user's choices.
        progress: told of every stage.
        test_set: labelled images for the accuracies in the report.

    Raises:
        InputError: the model or the imagery cannot be used, or the folder cannot be written.
        ToolError: an outside program is missing or failed.
    """
    clock = _Clock()
    with staged(folder) as staging:
        with clock.stage("plan"):
            planned = plan(model, options, progress)
        with clock.stage("emit"):
            circuits = emit(
                planned.design,
                staging,
                sobel_threshold=options.sobel_threshold,
                options=_header(planned.design, options),
            )
        with clock.stage("check and synthesise"):
            checked = check(planned.design, circuits, progress)
        with clock.stage("evaluate"):
            accuracies = _accuracies(planned.design, test_set, progress)
        report = report_dict(_report(folder.name, planned, options, checked, accuracies, clock))
        write_json(staging / REPORT_FILE, report)
        write_text(staging / REPORT_PAGE, report_markdown(report))
        if checked.failure is not None:
            write_text(staging / FAILED, checked.failure + "\n")
        names = sorted(path.name for path in staging.iterdir())
        write_manifest(staging, names, versions=report["tools"], options=report["options"])
    return Build(folder, report, checked.failure)


def require_luts(build: Build, max_luts: int) -> None:
    """Raise `CheckError` if the build's target takes more than ``max_luts`` LUTs."""
    luts = build.report["parts"][build.report["target"]]["luts"]
    if luts > max_luts:
        raise CheckError(
            f"the {build.report['target']} takes more LUTs than allowed",
            value=f"{luts}, allowed are {max_luts}",
            mend="try domain mode, another model or more --effort",
        )


def _header(design: Design, options: CompileOptions) -> list[str]:
    specification = design.specification
    codes = int(specification.pixel_care.sum())
    lines = [
        f"Mode {design.mode}: equal to the model on {codes} of {len(specification.pixel_care)} pixel codes."
    ]
    if design.mode == "domain":
        lines.append("On other codes it may answer anything.")
    edges = specification.edge_filter
    lines.append(
        f"Edge filter {edges.name}, {edges.size} patterns; style {design.style}, effort {options.effort}."
    )
    return lines


def _accuracies(
    design: Design, test_set: Dataset | None, progress: Progress
) -> tuple[float | None, float | None, float | None]:
    """Accuracy of the circuit and of the model, and the share of the test pixels that is cared for."""
    if test_set is None:
        return None, None, None
    encoder = pixel_encoder(design.model)
    circuit = evaluate(circuit_answers(design.pixel), encoder, test_set, progress)
    model = evaluate(design.model.evaluate_all_codes(), encoder, test_set, progress)
    return circuit.accuracy, model.accuracy, coverage(circuit.codes, design.specification.pixel_care)


def _report(
    name: str,
    planned: Plan,
    options: CompileOptions,
    checked: Checked,
    accuracies: tuple[float | None, float | None, float | None],
    clock: _Clock,
) -> BuildReport:
    design = planned.design
    specification = design.specification
    circuit_accuracy, model_accuracy, covered = accuracies
    figures = {part: PartFigures(**asdict(result.resources)) for part, result in checked.syntheses.items()}
    yosys = find_yosys()
    return BuildReport(
        name=name,
        target=design.target,
        mode=design.mode,
        parts=Parts(**figures),
        count=OPTIONS,
        device=XC7Z020.name,
        utilisation=_utilisation(checked.syntheses),
        minimised={
            part: Minimised(
                cubes_before=cover.cubes_before,
                cubes_after=len(cover.cover.cubes),
                literals_before=cover.literals_before,
                literals_after=cover.cover.literals,
            )
            for part, cover in planned.covers.items()
        },
        proof=Proof(checked.status, checked.method, checked.proof_seconds),
        care=Care(int(specification.pixel_care.sum()), covered),
        edges=_edges(planned, options),
        accuracy=circuit_accuracy,
        model_accuracy=model_accuracy,
        options={
            **{
                key: str(value) if isinstance(value, Path) else value
                for key, value in asdict(options).items()
            },
            "edge_patterns": specification.edge_filter.size,
            "mapping": dict(planned.methods),
            "simulated_vectors": checked.vectors,
        },
        hashes={"model": design.model.digest()},
        tools={**{name: version(name) for name in GENERATORS}, yosys.name: yosys.version},
        seconds={**clock.seconds, **checked.seconds},
    )


def _edges(planned: Plan, options: CompileOptions) -> EdgeFigures:
    edge_filter, agreement = planned.design.specification.edge_filter, planned.agreement
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


def _utilisation(syntheses: Mapping[str, Synthesis]) -> dict[str, dict[str, float]]:
    shares = {part: asdict(utilisation(result.resources)) for part, result in syntheses.items()}
    return {part: {k: v for k, v in share.items() if k != "device"} for part, share in shares.items()}
