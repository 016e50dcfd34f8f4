"""From a model and the user's choices to a design: care sets, edge filter, minimised networks."""

import sys
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from wnn2hdl.build.capacity import require_capacity
from wnn2hdl.build.design import CLASSIFIERS, Design, Mode
from wnn2hdl.build.emission import generators
from wnn2hdl.build.imagery import Imagery, Survey, edge_agreement, learn_edges, survey
from wnn2hdl.build.minimising import minimise_once
from wnn2hdl.build.pruning import Pruned, prune_exactly, prune_on_rows
from wnn2hdl.dataset.tables import read_table
from wnn2hdl.edges import RULES, Agreement, from_file
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.rows import feature_bits, require_vector_classifier, scaled
from wnn2hdl.ir import (
    WINDOW_CODES,
    EdgeFilter,
    LutNetwork,
    PictureEncoder,
    Style,
    VideoFormat,
    WisardModel,
)
from wnn2hdl.ir.care import CareSet, Codes
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.engine import EngineFormat, Shape
from wnn2hdl.ir.features import Thermometer
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.ir.models import AnyModel, LogicModel
from wnn2hdl.ir.packing import packed_luts
from wnn2hdl.ir.video import MAX_CLOCK, Answer
from wnn2hdl.lower.table import care_set
from wnn2hdl.lower.targets import Ingredients, Target, target_for
from wnn2hdl.minimise import Minimised
from wnn2hdl.minimise.circuit import minimise
from wnn2hdl.minimise.estimate import estimated_luts
from wnn2hdl.progress import Progress
from wnn2hdl.raster import AlphaMeaning, Reading
from wnn2hdl.schedule import Stages, for_clock, for_instances, for_stages


@dataclass(frozen=True)
class CompileOptions:
    """The user's choices.

    Attributes:
        target: what the model is compiled to; None for the first that it can be.
        name: what the names of all Verilog modules begin with; None makes it from the name of the folder.
        input: format of the words that a network reads as features, as in ``Q3.12`` (a sign bit, 3 whole and
            12 fraction bits) or ``UQ8.0`` (without a sign); None for what the model states.
        prune: leave out tables of a network that change no answer; or, with `prune_table`, hardly any.
        prune_table: file of feature vectors on which answers are compared; `label` and `raw` hold for it too.
        most_changed: share of its rows whose answers may change.
        mode: equal to the model on every input, or on the care set.
        care: folder of the imagery that makes the care set; needed in domain mode.
        care_minimum: how often a code must occur in it to be cared for.
        edges: ``boundary``, ``half-plane``, ``learned`` or the path of a file of patterns.
        edge_images: folder of the imagery from which patterns are learned; `care` if left out.
        edge_patterns: how many patterns are learned.
        edge_luts: learn only patterns that fit this many LUTs, 1 to 3; None sets no limit.
        stages: make a pipeline of so many stages; its latency in cycles. None makes a combinational circuit,
            unless there is a `clock`.
        clock: make a pipeline of as few stages as a clock of so many megahertz allows by the delay model of
            `wnn2hdl.schedule`.
        style: how LUT networks are written: as cells of the vendor, or as equations.
        effort: 0 to 3, how long to look for a smaller circuit.
        max_luts: LUTs that the circuit may take; more than the device has allow a circuit that cannot fit it.
        max_width: of a video core: pixels of the longest line.
        format: of a video core: a pixel's channels from the least significant byte, or ``mono``.
        answer: of a video core: ``class``, ``edge`` or ``both``.
        pixels_per_clock: of a video core: 1, 2 or 4.
        square: of a video core: send majorities of squares of so many pixels' side as well; None for none.
        template: of a match engine: rows and columns of the template.
        segment: of a match engine: rows and columns of the segment of the map that it is looked for in.
        frames_per_second: of a match engine: how many templates it matches at this `clock`.
        test_images: folder of labelled pictures for the accuracies in the report; needs `test_masks`.
        test_masks: folder of their masks.
        test_table: file of labelled feature vectors for the same, of a model that reads these.
        label: its column of class names, of a CSV file.
        raw: whether its features still have to be scaled as the model says.
        palette: file of the classes and what stands for them in the masks.
        ignore: codes of the masks' unlabelled pixels.
        bands: how all of these pictures are read, with `scale` and `alpha`, see `wnn2hdl.raster.Reading`.
        sobel_threshold: the baseline's, 1 to 2040.
    """

    target: str | None = None
    name: str | None = None
    input: str | None = None
    prune: bool = False
    prune_table: Path | None = None
    most_changed: float = 0.0
    mode: Mode = "exact"
    care: Path | None = None
    care_minimum: int = 1
    edges: str = "boundary"
    edge_images: Path | None = None
    edge_patterns: int = 75
    edge_luts: int | None = None
    stages: int | None = None
    clock: float | None = None
    style: Style = "cells"
    effort: int = 1
    max_luts: int | None = None
    max_width: int = VideoFormat.max_width
    format: str = VideoFormat.format
    answer: Answer = VideoFormat.answer
    template: Shape | None = None
    segment: Shape | None = None
    frames_per_second: float | None = None
    pixels_per_clock: int = VideoFormat.pixels_per_clock
    square: int | None = VideoFormat.square
    test_images: Path | None = None
    test_masks: Path | None = None
    test_table: Path | None = None
    label: str | None = None
    raw: bool | None = None
    palette: Path | None = None
    ignore: tuple[int, ...] | None = None
    bands: tuple[int, ...] | None = None
    scale: tuple[float, float] | None = None
    alpha: AlphaMeaning | None = None
    sobel_threshold: int = 128

    @property
    def imagery(self) -> Path | None:
        """The imagery in which edges are looked at."""
        return self.edge_images or self.care

    @property
    def pipelined(self) -> bool:
        """Whether registers are asked for."""
        return self.stages is not None or self.clock is not None

    @property
    def reading(self) -> Reading:
        """How pictures are read."""
        return Reading(self.bands, self.scale, self.alpha)


@dataclass(frozen=True, eq=False)
class Plan:
    """A design and what was found on the way.

    Attributes:
        design: the design.
        covers: the two-level cover of each table, for the report, by the names of `Circuit.tables`.
        methods: how the LUT network of each table was found.
        agreement: how far the filter's edges are Canny's; None without imagery to measure it on.
        left_out: share of the imagery's pixels without data, 0 to 1; None without a care set of imagery.
        pruned: what was left out of the network; None if that was not asked for.
    """

    design: Design
    covers: dict[str, Minimised]
    methods: dict[str, str]
    agreement: Agreement | None
    left_out: float | None
    pruned: Pruned | None


def plan(model: AnyModel, name: str, options: CompileOptions, progress: Progress) -> Plan:
    """Decide everything about a circuit but its text.

    Args:
        model: the model.
        name: what the names of the Verilog modules begin with.
        options: the user's choices.
        progress: reports every stage.

    Raises:
        InputError: the model reads no pixels, imagery is needed and missing or unusable, or no pipeline meets
            the clock.
        CheckError: a minimised table differs from the model.
    """
    if options.stages is not None and options.clock is not None:
        raise InputError(
            "the number of stages and the clock decide the same",
            value="--stages and --clock",
            hint="give one",
        )
    if options.input is not None:
        model = with_input(model, options.input)
    pruned = _prune(model, options, progress)
    model = model if pruned is None else pruned.model
    target = target_for(model, options.target)
    edges, care, seen = None, None, None
    video = _video(options) if target.streams else None
    has_edges = target.has_edges and (video is None or video.has_edges)
    if isinstance(model, WisardModel) and isinstance(model.encoder, PictureEncoder):
        edges = _edge_filter(model, options, progress) if has_edges else None
        seen = (
            survey(model, _care_imagery(options), progress, framed=target.streams)
            if options.mode == "domain"
            else None
        )
        care = _care_sets(options, seen) if seen is not None else None
    elif options.mode == "domain":
        raise InputError("domain mode is for models of pictures", value=model.kind, hint="leave --mode out")
    engine = _engine(options) if target.matches else None
    lowered = target.lower(Ingredients(model, edges, care, video, engine))
    require_capacity(int(engine.luts) if engine else estimated_luts(lowered), options.max_luts)
    minimised = minimise(lowered, options.effort, progress, by=minimise_once)
    if isinstance(model, LogicModel):
        tables = (table.function for table in minimised.circuit.tables().values())
        luts = sum(packed_luts(table) for table in tables if isinstance(table, LutNetwork))
        require_capacity(luts, options.max_luts)
    design = Design(
        model,
        edges,
        minimised.circuit,
        target,
        options.mode,
        options.style,
        name,
        (),
        _stages(minimised.circuit, target, options),
        video,
        engine,
    )
    design = replace(design, header=design.made_by(options.effort, generators()))
    design.check()
    imagery, agreement = options.imagery, None
    if imagery and edges is not None and isinstance(model, WisardModel):
        agreement = edge_agreement(edges, model, Imagery(imagery, options.reading), progress)
    left_out = None if seen is None else seen.left_out
    return Plan(design, minimised.covers, minimised.methods, agreement, left_out, pruned)


def _prune(model: AnyModel, options: CompileOptions, progress: Progress) -> Pruned | None:
    if not options.prune:
        if options.prune_table is not None or options.most_changed:
            raise InputError("--prune-table and --most-changed are for --prune", hint="give --prune too")
        return None
    if options.prune_table is None:
        if options.most_changed:
            raise InputError("whose answers may change?", value="--most-changed", hint="give --prune-table")
        return prune_exactly(model)
    classifier = require_vector_classifier(model, "the model given")
    features = scaled(classifier, read_table(options.prune_table, options.label, "train"), options.raw)
    bits = feature_bits(classifier, features)
    return prune_on_rows(model, bits, int(options.most_changed * len(bits)), progress)


def with_input(model: AnyModel, words: str) -> AnyModel:
    """A model of features that reads words of a format.

    Raises:
        InputError: there is no such format, or the model's features are no numbers.
    """
    encoder = None if isinstance(model, LogicModel) else model.encoder
    if isinstance(model, LogicModel) or not isinstance(encoder, Thermometer):
        raise InputError("the model reads no numbers, so their format is of no use", value=f"--input {words}")
    try:
        narrowed = replace(encoder, input=FixedPoint.parse(words))
    except ValueError as error:
        raise InputError("not a format of words", value=words, hint="write Q3.12 or UQ8.0") from error
    return replace(model, encoder=narrowed)


def _video(options: CompileOptions) -> VideoFormat:
    """The streams of a video core; raises InputError for a clock that its own registers are not made for."""
    if options.clock is not None and options.clock > MAX_CLOCK:
        raise InputError(
            "a video core is not made for this clock",
            value=f"{options.clock:g} MHz",
            hint=f"give at most --clock {MAX_CLOCK:g}, and more --pixels-per-clock",
        )
    if options.square is not None and options.square % options.pixels_per_clock:
        raise InputError(
            "a square is as wide as whole beats",
            value=f"--square {options.square} --pixels-per-clock {options.pixels_per_clock}",
            hint="give a multiple, or fewer pixels per clock",
        )
    return VideoFormat(
        options.max_width, options.format, options.answer, options.pixels_per_clock, options.square
    )


def _engine(options: CompileOptions) -> EngineFormat:
    """The sizes of a match engine; raises InputError for some that are missing, or that there is none of."""
    sizes = {
        "--template": options.template,
        "--segment": options.segment,
        "--clock": options.clock,
        "--frames-per-second": options.frames_per_second,
    }
    missing = [name for name, value in sizes.items() if value is None]
    if missing:
        raise InputError(
            "a match engine is made for sizes, a clock and a rate",
            value=f"{', '.join(missing)} missing",
            hint="give --template 220x220 --segment 543x543 --clock 100 --frames-per-second 10, or others",
        )
    if options.mode == "domain":
        raise InputError("a match engine has no care set", value="--mode domain", hint="leave it out")
    assert options.template is not None
    assert options.segment is not None
    assert options.clock is not None
    assert options.frames_per_second is not None
    cycles = int(min(options.clock * 1e6 / options.frames_per_second, sys.maxsize))
    try:
        return EngineFormat.fast_enough(options.template, options.segment, cycles)
    except ValueError as error:
        raise InputError(
            "there is no such match engine",
            value=error,
            hint="give other sizes, or fewer --frames-per-second",
        ) from error


def _stages(circuit: Circuit, target: Target, options: CompileOptions) -> Stages | None:
    if target.streams:
        return for_instances(circuit, stages=options.stages, megahertz=options.clock)
    if options.clock is not None:
        return for_clock(circuit, options.clock)
    return None if options.stages is None else for_stages(circuit, options.stages)


def _care_sets(options: CompileOptions, seen: Survey) -> dict[str, CareSet]:
    """The codes that occur in the care imagery, and the binary windows that the model makes of it."""
    codes = Codes(care_set(seen.codes, options.care_minimum))
    windows = seen.windows if seen.windows.any() else np.ones(WINDOW_CODES, dtype=np.int64)
    edge = Codes(care_set(windows, min(options.care_minimum, int(windows.max()))))
    return {**dict.fromkeys(CLASSIFIERS, codes), "edge": edge}


def _care_imagery(options: CompileOptions) -> Imagery:
    if options.care is None:
        raise InputError(
            "domain mode needs imagery that shows which codes occur", hint="give a folder with --care"
        )
    return Imagery(options.care, options.reading)


def _edge_filter(model: WisardModel, options: CompileOptions, progress: Progress) -> EdgeFilter:
    if options.edges in RULES:
        return RULES[options.edges]()
    if options.edges == "learned":
        if options.imagery is None:
            raise InputError(
                "learned edge patterns need imagery to learn from", hint="give a folder with --edge-images"
            )
        imagery = Imagery(options.imagery, options.reading)
        return learn_edges(model, imagery, options.edge_patterns, options.edge_luts, progress)
    edges = from_file(Path(options.edges))
    if edges.name in (*RULES, "learned"):
        raise InputError(
            "the file of edge patterns is called like a rule", value=edges.name, hint="rename it"
        )
    return edges
