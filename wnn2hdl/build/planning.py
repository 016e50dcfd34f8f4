"""From a model and the user's choices to a design: care sets, edge filter, minimised networks."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from wnn2hdl.build.design import Design, Mode, Style, Target, tables
from wnn2hdl.build.imagery import edge_agreement, learn_edges, survey, survey_codes
from wnn2hdl.edges import Agreement, boundary, from_file, half_plane
from wnn2hdl.errors import InputError
from wnn2hdl.ir import WINDOW_CODES, EdgeFilter, LutNetwork, Neighbourhood, WisardModel
from wnn2hdl.lower.table import care_set
from wnn2hdl.minimise import Minimised, espresso, map_luts
from wnn2hdl.progress import Progress
from wnn2hdl.verify.specification import AnySpecification, NeighbourhoodSpecification, Specification


@dataclass(frozen=True)
class CompileOptions:
    """The user's choices.

    Attributes:
        target: which circuit is the top of the Verilog; None for all that the model has.
        mode: equal to the model on every input, or on the care set.
        care: folder of the imagery that makes the care set; needed in domain mode.
        care_minimum: how often a code must occur in it to be cared for.
        edges: ``boundary``, ``half-plane``, ``learned`` or the path of a file of patterns.
        edge_images: folder of the imagery from which patterns are learned; `care` if left out.
        edge_patterns: how many patterns are learned.
        edge_luts: learn only patterns that fit so many LUTs, 1 to 3; None sets no limit.
        style: equations or explicit LUT cells.
        effort: 0 to 3, how long to look for a smaller circuit.
        test_images: folder of labelled pictures for the accuracies in the report; needs `test_masks`.
        test_masks: folder of their masks.
        palette: file of the classes and their colours in the masks.
        sobel_threshold: the baseline's, 1 to 2040.
    """

    target: Target | None = None
    mode: Mode = "exact"
    care: Path | None = None
    care_minimum: int = 1
    edges: str = "boundary"
    edge_images: Path | None = None
    edge_patterns: int = 75
    edge_luts: int | None = None
    style: Style = "luts"
    effort: int = 1
    test_images: Path | None = None
    test_masks: Path | None = None
    palette: Path | None = None
    sobel_threshold: int = 128

    @property
    def imagery(self) -> Path | None:
        """The imagery in which edges are looked at."""
        return self.edge_images or self.care


@dataclass(frozen=True, eq=False)
class Plan:
    """A design and what was found on the way.

    Attributes:
        design: the design.
        covers: the two-level covers of the pixel classifier and the edge filter, for the report.
        methods: how each network was found.
        agreement: how far the filter's edges are Canny's; None without imagery to measure it on.
    """

    design: Design
    covers: dict[str, Minimised]
    methods: dict[str, str]
    agreement: Agreement | None


def plan(model: WisardModel, options: CompileOptions, progress: Progress) -> Plan:
    """Decide everything about a circuit but its text.

    Raises:
        InputError: the model reads no pixels, or imagery is needed and missing or unusable.
        CheckError: a minimised table differs from the model.
    """
    target = _target(model, options)
    specification = _specify(model, options, progress)
    covers: dict[str, Minimised] = {}
    methods: dict[str, str] = {}
    networks: dict[str, LutNetwork] = {}
    for name, table in tables(specification).items():
        progress(f"minimising {name}", 0, 2)
        covers[name] = espresso(table)
        progress(f"minimising {name}", 1, 2)
        mapping = map_luts(table, effort=options.effort)
        methods[name] = mapping.method
        networks[name] = mapping.network
        progress(f"minimising {name}", 2, 2)
    design = Design(specification, options.mode, target, options.style, networks)
    imagery, agreement = options.imagery, None
    if imagery and isinstance(specification, Specification):
        agreement = edge_agreement(specification.edge_filter, model, imagery, progress)
    return Plan(design, covers, methods, agreement)


def _target(model: WisardModel, options: CompileOptions) -> Target:
    if not isinstance(model.encoder, Neighbourhood):
        if options.target == "neighbourhood":
            raise InputError(
                "the model does not look at neighbours",
                value="target neighbourhood",
                hint="train one with --neighbourhood, or choose another target",
            )
        return options.target or "block"
    if options.target not in (None, "neighbourhood"):
        raise InputError(
            "the model looks at neighbours, so it is a circuit of its own",
            value=f"target {options.target}",
            hint="leave --target out",
        )
    return "neighbourhood"


def _specify(model: WisardModel, options: CompileOptions, progress: Progress) -> AnySpecification:
    if isinstance(model.encoder, Neighbourhood):
        return _specify_neighbourhood(model, model.encoder, options, progress)
    edge_filter = _edge_filter(model, options, progress)
    if options.mode == "exact":
        return Specification.exact(model, edge_filter)
    seen = survey(model, _care_imagery(options), progress)
    windows = seen.windows if seen.windows.any() else np.ones(WINDOW_CODES, dtype=np.int64)
    return Specification(
        model,
        edge_filter,
        care_set(seen.codes, options.care_minimum),
        care_set(windows, min(options.care_minimum, int(windows.max()))),
    )


def _specify_neighbourhood(
    model: WisardModel, encoder: Neighbourhood, options: CompileOptions, progress: Progress
) -> NeighbourhoodSpecification:
    if options.mode == "exact":
        return NeighbourhoodSpecification(model, np.ones(1 << encoder.width, dtype=np.bool_))
    seen = survey_codes(encoder, _care_imagery(options), progress)
    return NeighbourhoodSpecification(model, care_set(seen, options.care_minimum))


def _care_imagery(options: CompileOptions) -> Path:
    if options.care is None:
        raise InputError(
            "domain mode needs imagery that tells which codes occur", hint="give a folder with --care"
        )
    return options.care


def _edge_filter(model: WisardModel, options: CompileOptions, progress: Progress) -> EdgeFilter:
    if options.edges == "boundary":
        return boundary()
    if options.edges == "half-plane":
        return half_plane()
    if options.edges == "learned":
        if options.imagery is None:
            raise InputError(
                "learned edge patterns need imagery to learn from", hint="give a folder with --edge-images"
            )
        return learn_edges(model, options.imagery, options.edge_patterns, options.edge_luts, progress)
    return from_file(Path(options.edges))
