"""A design: what is to be computed, on which inputs, and by which networks of LUTs."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, Self

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import ModelFileError
from wnn2hdl.files import read_json, write_json
from wnn2hdl.ir import WINDOW_CODES, EdgeFilter, LutNetwork, Neighbourhood, TruthTable, WisardModel
from wnn2hdl.lower.table import pixel_table
from wnn2hdl.verify.specification import AnySpecification, NeighbourhoodSpecification, Specification

Mode = Literal["exact", "domain"]
Style = Literal["rtl", "luts"]
Target = Literal["block", "pixel", "edge", "match", "neighbourhood"]

MODEL_FILE = "model.json"
DESIGN_FILE = "design.json"
FORMAT = "wnn2hdl-design"
VERSION = 1

COMBINER = "combiner"
"""Name of the table that reads the taps of a neighbourhood."""


@dataclass(frozen=True, eq=False)
class Design:
    """Everything that decides the emitted Verilog.

    Attributes:
        specification: the model and the care sets, and the edge filter behind pixels.
        mode: ``exact``: equal to the model on every input; ``domain``: on the care sets only.
        target: which circuit is the top of the Verilog.
        style: ``rtl`` writes equations, ``luts`` explicit LUT cells.
        networks: the minimised tables of `tables`, by the same names.
    """

    specification: AnySpecification
    mode: Mode
    target: Target
    style: Style
    networks: Mapping[str, LutNetwork]

    @property
    def model(self) -> WisardModel:
        """The model."""
        return self.specification.model

    @property
    def decision(self) -> LutNetwork:
        """The network from the encoder's bits to the class, outputs ``class_bit0`` …."""
        return self.networks[COMBINER if self.target == "neighbourhood" else "pixel"]

    @property
    def used(self) -> Mapping[str, LutNetwork]:
        """The networks that the target is made of: a pixel classifier alone has no edge filter in it."""
        if self.target in ("block", "neighbourhood"):
            return self.networks
        return {name: network for name, network in self.networks.items() if name == self.target}

    def save(self, folder: Path) -> None:
        """Write `MODEL_FILE` and `DESIGN_FILE` into a folder."""
        self.model.save(folder / MODEL_FILE)
        write_json(
            folder / DESIGN_FILE,
            {
                "format": FORMAT,
                "version": VERSION,
                "model_sha256": self.model.digest(),
                "mode": self.mode,
                "target": self.target,
                "style": self.style,
                **self._specification_json(),
                **{name: network.to_json() for name, network in self.networks.items()},
            },
        )

    def _specification_json(self) -> dict[str, Any]:
        specification = self.specification
        if isinstance(specification, NeighbourhoodSpecification):
            return {"care": self._codes(specification.care)}
        return {
            "edges": specification.edge_filter.to_json(),
            "pixel_care": self._codes(specification.pixel_care),
            "window_care": self._codes(specification.window_care),
        }

    def _codes(self, care: NDArray[np.bool_]) -> list[int] | None:
        return np.flatnonzero(care).tolist() if self.mode == "domain" else None

    @classmethod
    def load(cls, folder: Path) -> Self:
        """Read what `save` wrote.

        Raises:
            ModelFileError: a file is missing or damaged, or they belong to different builds.
        """
        model = WisardModel.load(folder / MODEL_FILE)
        path = folder / DESIGN_FILE
        data = read_json(path, "a design")
        if data.get("format") != FORMAT or data.get("version") != VERSION:
            raise ModelFileError("not a design of this wnn2hdl", value=path, hint="compile the model again")
        if data.get("model_sha256") != model.digest():
            raise ModelFileError(
                "the design was made from another model", value=path, hint="compile the model again"
            )
        try:
            specification = _specification(model, data)
            networks = {name: LutNetwork.from_json(data[name]) for name in tables(specification)}
            return cls(specification, data["mode"], data["target"], data["style"], networks)
        except (KeyError, TypeError, ValueError, IndexError, ModelFileError) as error:
            raise ModelFileError("the design is damaged", value=f"{path} ({error})") from error


def tables(specification: AnySpecification) -> dict[str, TruthTable]:
    """The tables to minimise, by name, with their don't-cares.

    Of pixels these are ``pixel``, the classifier, and ``edge``, the edge filter; of a neighbourhood
    ``tap0`` …, which are exact, and `COMBINER`.
    """
    if isinstance(specification, NeighbourhoodSpecification):
        encoder = specification.encoder
        taps = {
            name: TruthTable.exact(tap.pixel.names, ("class_bit0",), tap.table[:, np.newaxis])
            for name, tap in zip(encoder.names, encoder.taps, strict=True)
        }
        return {**taps, COMBINER: pixel_table(specification.model, specification.care)}
    return {
        "pixel": pixel_table(specification.model, specification.pixel_care),
        "edge": specification.edge_filter.table().with_care(specification.window_care),
    }


def _specification(model: WisardModel, data: dict[str, Any]) -> AnySpecification:
    codes = 1 << model.encoder.width
    if isinstance(model.encoder, Neighbourhood):
        return NeighbourhoodSpecification(model, _flags(data["care"], codes))
    return Specification(
        model,
        EdgeFilter.from_json(data["edges"]),
        _flags(data["pixel_care"], codes),
        _flags(data["window_care"], WINDOW_CODES),
    )


def _flags(codes: list[int] | None, size: int) -> NDArray[np.bool_]:
    flags = np.full(size, codes is None)
    if codes is not None:
        flags[codes] = True
    return flags
