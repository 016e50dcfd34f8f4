"""The targets: what a model can be compiled to. Each is a function that returns a circuit."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from wnn2hdl.errors import InputError
from wnn2hdl.ir import WINDOW_BITS, EdgeFilter, Neighbourhood, WisardModel
from wnn2hdl.ir.care import CareSet, Everything
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.lower import deforestation


@dataclass(frozen=True, eq=False)
class Ingredients:
    """What a target is made from.

    Attributes:
        model: the model.
        edges: the edge filter; None for targets that have none.
        care: the care sets of circuits by name; where one is missing, everything matters.
    """

    model: WisardModel
    edges: EdgeFilter | None = None
    care: Mapping[str, CareSet] | None = None

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
        has_edges: whether the circuit contains the edge filter.
        classifies: whether it answers with classes of pixels.
        of_neighbours: whether it is made of models that look at a pixel's neighbours.
    """

    name: str
    description: str
    lower: Callable[[Ingredients], Circuit]
    has_edges: bool = False
    classifies: bool = True
    of_neighbours: bool = False


def _pixel(of: Ingredients) -> Circuit:
    return deforestation.pixel(of.model, of.cared("pixel", of.model.encoder.width))


def _edge(of: Ingredients) -> Circuit:
    assert of.edges is not None
    return deforestation.edge(of.edges, of.cared("edge", WINDOW_BITS))


def _block(of: Ingredients) -> Circuit:
    block = deforestation.block(_pixel(of), _edge(of))
    return deforestation.block_match(block, deforestation.match())


def _neighbourhood(of: Ingredients) -> Circuit:
    encoder = of.model.encoder
    assert isinstance(encoder, Neighbourhood)
    return deforestation.neighbourhood(of.model, encoder, of.cared("neighbourhood", encoder.width))


TARGETS: Mapping[str, Target] = {
    target.name: target
    for target in (
        Target("block", "Nine pixel classifiers and an edge filter", _block, has_edges=True),
        Target("pixel", "A pixel classifier", _pixel),
        Target("edge", "An edge filter", _edge, has_edges=True, classifies=False),
        Target(
            "match", "A nine-bit match-and-count circuit", lambda _: deforestation.match(), classifies=False
        ),
        Target(
            "neighbourhood",
            "A classifier of a pixel that looks at its neighbours",
            _neighbourhood,
            of_neighbours=True,
        ),
    )
}


def target_for(model: WisardModel, name: str | None) -> Target:
    """The target of that name, or the first one that the model can be compiled to.

    Raises:
        InputError: the model cannot be compiled to this target.
    """
    neighbours = isinstance(model.encoder, Neighbourhood)
    fitting = [target for target in TARGETS.values() if target.of_neighbours == neighbours]
    if name is None:
        return fitting[0]
    if TARGETS[name] not in fitting:
        looks = "looks at a pixel's neighbours" if neighbours else "does not look at a pixel's neighbours"
        raise InputError(
            f"the model {looks}",
            value=f"target {name}",
            hint=f"choose {' or '.join(target.name for target in fitting)}, or another model",
        )
    return TARGETS[name]
