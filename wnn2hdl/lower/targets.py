"""The targets: what a model can be compiled to. Each is a function that returns a circuit."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from wnn2hdl.errors import InputError
from wnn2hdl.ir import (
    WINDOW_BITS,
    Context,
    EdgeFilter,
    Encoder,
    FeatureEncoder,
    Neighbourhood,
    PixelEncoder,
    VideoFormat,
    WisardModel,
    Words,
    picture_encoder,
)
from wnn2hdl.ir.care import CareSet, Codes, Everything
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.engine import EngineFormat
from wnn2hdl.ir.models import AnyModel, LogicModel, NetworkModel, TableSumModel
from wnn2hdl.ir.relational import grey_codes
from wnn2hdl.ir.video import MAX_CLASSES
from wnn2hdl.lower import context, deforestation, gates, structural, sums


@dataclass(frozen=True, eq=False)
class Ingredients:
    """What a target is made from.

    Attributes:
        model: the model.
        edges: the edge filter; None for targets that have none.
        care: the care sets of circuits by name; where one is missing, everything matters.
        video: the streams of a video core; None for other targets.
        engine: the sizes of a match engine; None for other targets.
    """

    model: AnyModel
    edges: EdgeFilter | None = None
    care: Mapping[str, CareSet] | None = None
    video: VideoFormat | None = None
    engine: EngineFormat | None = None

    def cared(self, name: str, width: int) -> CareSet:
        """The care set of a circuit whose code has ``width`` bits."""
        return (self.care or {}).get(name, Everything(width))


@dataclass(frozen=True)
class Target:
    """A kind of circuit.

    Attributes:
        name: as the command line has it.
        description: what the circuit is, for people.
        lower: makes the circuit.
        fits: whether a model can be compiled to it.
        has_edges: whether the circuit contains the edge filter.
        classifies: whether it answers with classes of pixels.
        streams: whether it is a video core, whose circuits stand between registers and memories.
        matches: whether it is a match engine, whose circuits do so, too.
    """

    name: str
    description: str
    lower: Callable[[Ingredients], Circuit]
    fits: Callable[[AnyModel], bool]
    has_edges: bool = False
    classifies: bool = True
    streams: bool = False
    matches: bool = False


def _pixel(of: Ingredients) -> Circuit:
    model = _wisard(of)
    return deforestation.pixel(model, of.cared("pixel", model.encoder.width))


def _grey(of: Ingredients, encoder: Encoder) -> Circuit:
    """The pixel classifier where pixels are grey: other codes than theirs are free."""
    assert isinstance(encoder, PixelEncoder)
    cared = of.cared("pixel", encoder.width).project(tuple(range(encoder.width))) & grey_codes(encoder)
    if not cared.any():
        raise InputError(
            "the care imagery has no grey pixel",
            value="--format mono",
            hint="give grey imagery with --care",
        )
    return deforestation.pixel(_wisard(of), Codes(cared))


def _edge(of: Ingredients) -> Circuit:
    assert of.edges is not None
    return deforestation.edge(of.edges, of.cared("edge", WINDOW_BITS))


def _block(of: Ingredients) -> Circuit:
    block = deforestation.block(_pixel(of), _edge(of))
    return deforestation.block_match(block, deforestation.match())


def _video(of: Ingredients) -> Circuit:
    assert of.video is not None
    model = _wisard(of)
    if len(model.classes) > MAX_CLASSES:
        raise InputError(f"a video core has at most {MAX_CLASSES} classes", value=len(model.classes))
    encoder = model.encoder
    if isinstance(encoder, Neighbourhood):
        decision = deforestation.decision(model, of.cared("decision", encoder.width))
        circuits = {"classifier": deforestation.taps(encoder), "decision": decision}
    elif isinstance(encoder, Context):
        if of.video.pixels_per_clock > 1:
            raise InputError(
                "a core that counts around a pixel takes one pixel per clock", value=of.video.pixels_per_clock
            )
        counted = context.context(model, encoder, of.cared("context", encoder.width))
        circuits = {"classifier": context.planes(encoder), "decision": counted}
    else:
        circuits = {"classifier": _grey(of, encoder) if of.video.is_mono else _pixel(of)}
    return deforestation.video(circuits | ({"window": _edge(of)} if of.video.has_edges else {}))


def _engine(of: Ingredients) -> Circuit:
    assert of.engine is not None
    return deforestation.engine(deforestation.lane(of.engine.columns))


def _neighbourhood(of: Ingredients) -> Circuit:
    model = _wisard(of)
    encoder = model.encoder
    assert isinstance(encoder, Neighbourhood)
    return deforestation.neighbourhood(model, encoder, of.cared("neighbourhood", encoder.width))


def _network(of: Ingredients) -> Circuit:
    if isinstance(of.model, LogicModel):
        return gates.network(of.model)
    if isinstance(of.model, TableSumModel):
        return sums.network(of.model)
    assert isinstance(of.model, NetworkModel)
    return structural.network(of.model)


def _wisard(of: Ingredients) -> WisardModel:
    assert isinstance(of.model, WisardModel)
    picture_encoder(of.model)  # refuses a model that is too large for a table
    return of.model


def _reads_pixels(model: AnyModel) -> bool:
    return isinstance(model, WisardModel) and isinstance(model.encoder, PixelEncoder)


def _reads_neighbours(model: AnyModel) -> bool:
    return isinstance(model, WisardModel) and isinstance(model.encoder, Neighbourhood)


def _counts(model: AnyModel) -> bool:
    return isinstance(model, WisardModel) and isinstance(model.encoder, Context)


def _reads_pictures(model: AnyModel) -> bool:
    return _reads_pixels(model) or _reads_neighbours(model) or _counts(model)


def _is_network(model: AnyModel) -> bool:
    if isinstance(model, LogicModel):
        return True
    if isinstance(model, TableSumModel):
        return isinstance(model.encoder, Words)
    return isinstance(model, NetworkModel) and isinstance(model.encoder, FeatureEncoder)


def _reads(model: AnyModel) -> str:
    """What goes into a model, for a message."""
    if isinstance(model, LogicModel):
        return "bits"
    if _reads_pixels(model):
        return "single pixels"
    if _counts(model):
        return "counts around a pixel"
    return "a pixel's neighbours" if _reads_neighbours(model) else "features"


TARGETS: Mapping[str, Target] = {
    target.name: target
    for target in (
        Target("block", "Nine pixel classifiers and an edge filter", _block, _reads_pixels, has_edges=True),
        Target("pixel", "A pixel classifier", _pixel, _reads_pixels),
        Target("edge", "An edge filter", _edge, _reads_pixels, has_edges=True, classifies=False),
        Target(
            "match",
            "A nine-bit match-and-count circuit",
            lambda _: deforestation.match(),
            _reads_pixels,
            classifies=False,
        ),
        Target(
            "neighbourhood",
            "A classifier of a pixel that looks at its neighbours",
            _neighbourhood,
            _reads_neighbours,
        ),
        Target(
            "video",
            "A video core: classifier, line buffers and edge filter between two AXI4-Streams",
            _video,
            _reads_pictures,
            has_edges=True,
            streams=True,
        ),
        Target(
            "engine",
            "A match engine: where in a segment of a map a binary picture agrees in most pixels",
            _engine,
            _reads_pixels,
            classifies=False,
            matches=True,
        ),
        Target(
            "network",
            "A whole network: encoder, tables, votes and winner; or gates",
            _network,
            _is_network,
            classifies=False,
        ),
    )
}


def target_for(model: AnyModel, name: str | None) -> Target:
    """The target of that name, or the first one that the model can be compiled to.

    Raises:
        InputError: there is no such target, or the model cannot be compiled to it, or to any.
    """
    fitting = [target for target in TARGETS.values() if target.fits(model)]
    if not fitting:
        raise InputError(
            "models of this kind are not compiled to circuits yet",
            value=model.kind,
            hint="see docs/limits.md for those that are",
        )
    if name is None:
        return fitting[0]
    if name not in TARGETS:
        raise InputError("there is no such target", value=name, hint=f"choose {', '.join(TARGETS)}")
    if TARGETS[name] not in fitting:
        raise InputError(
            f"the model reads {_reads(model)}",
            value=f"target {name}",
            hint=f"choose {' or '.join(target.name for target in fitting)}, or another model",
        )
    return TARGETS[name]
