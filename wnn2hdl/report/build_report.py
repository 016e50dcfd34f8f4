"""The figures of one build and their form as `report.json`."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

REPORT_VERSION = 2
"""Of the form of `report.json`; it rises when a key changes its meaning or goes away."""


@dataclass(frozen=True)
class PartFigures:
    """What one part costs; a figure that was not measured is None.

    Attributes:
        luts: LUT1 to LUT6 cells and, except for the Sobel baseline, leftover INV cells.
        inv: leftover inverters.
        muxf7: MUXF7 cells.
        muxf8: MUXF8 cells.
        carry4: carry chains of four bits.
        srl: shift registers in LUTs.
        ffs: flip-flops and latches.
        bram36: block RAMs of 36 Kb, one of 18 Kb being half of one.
        dsp: DSP slices.
        delay_ps: logic delay in picoseconds, without routing.
    """

    luts: int | None = None
    inv: int | None = None
    muxf7: int | None = None
    muxf8: int | None = None
    carry4: int | None = None
    srl: int | None = None
    ffs: int | None = None
    bram36: float | None = None
    dsp: int | None = None
    delay_ps: int | None = None


@dataclass(frozen=True)
class Minimised:
    """The size of a cover before and after minimising.

    Attributes:
        cubes_before: product terms of the table as it was extracted, one for each input that gives 1.
        cubes_after: product terms left.
        literals_before: literals in the former.
        literals_after: literals in the latter.
    """

    cubes_before: int
    cubes_after: int
    literals_before: int
    literals_after: int


@dataclass(frozen=True)
class Proof:
    """How the emitted Verilog was checked against the model.

    Attributes:
        status: ``proved``, ``UNPROVED``, ``simulated``, ``failed`` or ``not run``.
        method: in words; None if it was not run.
        seconds: wall clock; None if it was not run.
        failure: an input on which circuit and model differ, in words; None if none was found.
        before: circuits that an earlier build proved, with the same Verilog and netlist, and this one did not
            prove again.
        claims: all that was to be proved, with the part, the statement and the status of each.
        unproved: what a limit left unproved.
    """

    status: str = "not run"
    method: str | None = None
    seconds: float | None = None
    failure: str | None = None
    before: tuple[str, ...] = ()
    claims: tuple[Mapping[str, str], ...] = ()
    unproved: tuple[str, ...] = ()


@dataclass(frozen=True)
class Care:
    """The inputs on which the circuit equals the model.

    Attributes:
        codes: how many pixel codes are cared for: all of them in exact mode.
        coverage: the share of other imagery's pixels with such a code, 0 to 1; None if not measured.
        of: how many pixel codes there are.
    """

    codes: int | None = None
    coverage: float | None = None
    of: int | None = None


@dataclass(frozen=True)
class ModelFigures:
    """The trained network that was compiled.

    Attributes:
        classes: class names, the background first.
        address_bits: n, of each RAM; None of a network without RAMs, as are the following.
        rams: k, of each discriminator.
        bits: names of the input bits of a model of pictures, code bit 0 first.
        bleaching: the threshold.
        saturation: for each class and RAM the share of its addresses that fire, 0 to 1.
        training: what the model file says about its training.
        kind: of the model, as its file has it.
    """

    classes: tuple[str, ...]
    address_bits: int | None = None
    rams: int | None = None
    bits: tuple[str, ...] = ()
    bleaching: int | None = None
    saturation: tuple[tuple[float, ...], ...] = ()
    training: Mapping[str, Any] = field(default_factory=dict)
    kind: str = "wisard"


@dataclass(frozen=True)
class EdgeFigures:
    """The edge filter, and how far its edges are Canny's within one pixel; None where not measured.

    Attributes:
        name: of the pattern set.
        patterns: how many windows of 512 count as an edge.
        precision: share of its edge pixels that are near one of Canny's, 0 to 1.
        recall: share of Canny's edge pixels that are near one of the filter's, 0 to 1.
        f1: their harmonic mean.
        imagery: the folder it was measured on; learned patterns may come from the same.
    """

    name: str | None = None
    patterns: int | None = None
    precision: float | None = None
    recall: float | None = None
    f1: float | None = None
    imagery: str | None = None


@dataclass(frozen=True)
class LightFigures:
    """How right a circuit is on labelled pictures whose light is changed.

    Attributes:
        curves: by what varies, ``exposure`` or ``haze``, for each ``value`` the ``accuracy``, its 95 %
            ``interval``, bootstrapped over images (None with one image), and of the ``worst_image`` the
            ``name`` and the ``accuracy``; empty where not measured.
        warning: that and why brighter ground may be answered differently, in words; None if nothing speaks
            for it.
    """

    curves: Mapping[str, Sequence[Mapping[str, Any]]] = field(default_factory=dict)
    warning: str | None = None


@dataclass(frozen=True)
class RowFigures:
    """How right a circuit of features is on labelled rows; None where not measured.

    Attributes:
        count: of the rows.
        interval: Wilson's 95 % interval of the circuit's accuracy.
        model_interval: of the accuracy of the model as it was given to `compile`, which may read real
            numbers where the circuit reads words.
        changed: rows on which the two answer differently.
    """

    count: int | None = None
    interval: tuple[float, float] | None = None
    model_interval: tuple[float, float] | None = None
    changed: int | None = None


@dataclass(frozen=True)
class PublishedFigure:
    """A figure that others published and that was not measured here."""

    what: str
    luts: int
    registers: int | None
    source: str


_PAPER = "the reference design's paper, xc7z020clg484"

PUBLISHED = (
    PublishedFigure("block of nine pixel classifiers and an edge filter", 21, 0, _PAPER),
    PublishedFigure("nine-bit match-and-count", 11, None, _PAPER),
    PublishedFigure("Sobel, cited there as [33]", 135, 49, _PAPER),
    PublishedFigure("Sobel, cited there as [34]", 114, 0, _PAPER),
)
"""What the circuits are compared with; None where the paper gives no figure."""


@dataclass(frozen=True)
class BuildReport:
    """Everything that is reported about a build.

    Attributes:
        name: of the build.
        target: the name of one of `wnn2hdl.lower.targets.TARGETS`.
        mode: ``exact`` or ``domain``.
        latency: clock cycles from the inputs to the outputs of the target; 0 if it is combinational.
        stage_ps: the longest path between the registers of its pipeline, in picoseconds, with wires, by the
            delay model that chose the stages; None if it is combinational.
        parts: what each circuit costs by its name, ``sobel``, the baseline, among them.
        count: the command by which the parts were counted.
        device: the device of `utilisation`.
        utilisation: for parts by name, percent of the device's resources by name.
        minimised: by the name of the table.
        proof: how the Verilog was checked.
        care: where circuit and model are equal.
        edges: the edge filter.
        accuracy: of the circuit, 0 to 1, on labelled pixels or rows; None if there were none.
        model_accuracy: of the model on the same; of a model of features, as it was given.
        confusion: those pixels or rows by true class (rows) and the circuit's answer (columns).
        light: the circuit's accuracy in changed light.
        rows: more about labelled rows.
        model: the network that was compiled.
        command: what compiles the model file of the build folder again, run beside that folder.
        evaluation: what measures its accuracies again, run there too; None if there are none.
        options: the options of the command that are part of the result.
        hashes: SHA-256 of files by name, in hexadecimal.
        tools: versions of programs by name.
        seconds: wall clock by stage; of checks and syntheses, which are one stage and run side by side, the
            time after which each was done.
    """

    name: str
    target: str
    mode: str
    parts: Mapping[str, PartFigures]
    latency: int = 0
    stage_ps: int | None = None
    count: str | None = None
    device: str | None = None
    utilisation: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    minimised: Mapping[str, Minimised] = field(default_factory=dict)
    proof: Proof = Proof()
    care: Care = Care()
    edges: EdgeFigures = EdgeFigures()
    accuracy: float | None = None
    model_accuracy: float | None = None
    confusion: tuple[tuple[int, ...], ...] | None = None
    light: LightFigures = LightFigures()
    rows: RowFigures = RowFigures()
    model: ModelFigures | None = None
    command: str | None = None
    evaluation: str | None = None
    options: Mapping[str, Any] = field(default_factory=dict)
    hashes: Mapping[str, str] = field(default_factory=dict)
    tools: Mapping[str, str] = field(default_factory=dict)
    seconds: Mapping[str, float] = field(default_factory=dict)


def report_dict(report: BuildReport) -> dict[str, Any]:
    """The JSON object of `report.json`: the report's fields, its version, and the published figures."""
    fields = asdict(report)
    return {
        "version": REPORT_VERSION,
        **fields,
        "published": published_figures(),
    }


def published_figures() -> list[dict[str, Any]]:
    """`PUBLISHED`, as reports list them."""
    return [asdict(figure) | {"measured_here": False} for figure in PUBLISHED]
