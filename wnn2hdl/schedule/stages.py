"""A schedule: in which stage of a pipeline each cell of a circuit is."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

from wnn2hdl.schedule.logic import Key

Place = tuple[str, Key]
"""A definition and a cell, or an instance, in it."""


@dataclass(frozen=True)
class Stages:
    """Where registers are.

    Attributes:
        places: the stage of each cell, and of each instance that of its inputs, counted from the inputs of
            the definition that it stands in.
        latencies: cycles from the inputs to the outputs of each definition, by name.
        period: the longest path from register to register in picoseconds, by the delay model.
    """

    places: Mapping[Place, int]
    latencies: Mapping[str, int]
    period: int

    def to_json(self) -> dict[str, Any]:
        """A JSON object."""
        places: dict[str, dict[str, dict[str, int]]] = {name: {} for name in self.latencies}
        for (definition, (node, cell)), stage in self.places.items():
            places[definition].setdefault(node, {})[cell] = stage
        return {"period_ps": self.period, "latencies": dict(self.latencies), "stages": places}

    @classmethod
    def from_json(cls, data: Any) -> Self:
        """The inverse of `to_json`.

        Raises:
            ValueError, KeyError, TypeError, AttributeError: the data are anything else.
        """
        places = {
            (str(definition), (str(node), str(cell))): _count(stage)
            for definition, nodes in data["stages"].items()
            for node, cells in nodes.items()
            for cell, stage in cells.items()
        }
        latencies = {str(name): _count(latency) for name, latency in data["latencies"].items()}
        return cls(places, latencies, _count(data["period_ps"]))


def _count(value: Any) -> int:
    if type(value) is not int or value < 0:
        raise ValueError(f"{value!r} is not a count")
    return value
