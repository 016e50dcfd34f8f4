"""A design: what is to be computed, on which inputs, and by which networks of LUTs."""

from dataclasses import dataclass
from pathlib import Path
from typing import Literal, Self

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import ModelFileError
from wnn2hdl.ir import WINDOW_CODES, EdgeFilter, LutNetwork, TruthTable, WisardModel
from wnn2hdl.ir.files import read_json, write_json
from wnn2hdl.tables import pixel_table
from wnn2hdl.verify.specification import Specification

Mode = Literal["exact", "domain"]
Style = Literal["rtl", "luts"]
Target = Literal["block", "pixel", "edge", "match"]

MODEL_FILE = "model.json"
DESIGN_FILE = "design.json"
FORMAT = "wnn2hdl-design"
VERSION = 1


@dataclass(frozen=True, eq=False)
class Design:
    """Everything that decides the emitted Verilog.

    Attributes:
        specification: the model, the edge filter and the care sets.
        mode: ``exact``: equal to the model on every input; ``domain``: on the care sets only.
        target: which circuit is the top of the Verilog.
        style: ``rtl`` writes equations, ``luts`` explicit LUT cells.
        pixel: the pixel classifier over the encoder's bits, outputs ``class_bit0`` ….
        edge: the edge filter over ``bit0`` … ``bit8``, output ``edge_bit``.
    """

    specification: Specification
    mode: Mode
    target: Target
    style: Style
    pixel: LutNetwork
    edge: LutNetwork

    @property
    def model(self) -> WisardModel:
        """The model."""
        return self.specification.model

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
                "edges": self.specification.edge_filter.to_json(),
                "pixel_care": np.flatnonzero(self.specification.pixel_care).tolist()
                if self.mode == "domain"
                else None,
                "window_care": np.flatnonzero(self.specification.window_care).tolist()
                if self.mode == "domain"
                else None,
                "pixel": self.pixel.to_json(),
                "edge": self.edge.to_json(),
            },
        )

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
            raise ModelFileError("not a design of this wnn2hdl", value=path, mend="compile the model again")
        if data.get("model_sha256") != model.digest():
            raise ModelFileError(
                "the design was made from another model", value=path, mend="compile the model again"
            )
        try:
            specification = Specification(
                model,
                EdgeFilter.from_json(data["edges"]),
                _flags(data["pixel_care"], 1 << model.encoder.width),
                _flags(data["window_care"], WINDOW_CODES),
            )
            return cls(
                specification,
                data["mode"],
                data["target"],
                data["style"],
                LutNetwork.from_json(data["pixel"]),
                LutNetwork.from_json(data["edge"]),
            )
        except (KeyError, TypeError, ValueError, IndexError) as error:
            raise ModelFileError("the design is damaged", value=f"{path} ({error})") from error


def tables(specification: Specification) -> tuple[TruthTable, TruthTable]:
    """The tables to minimise: the pixel classifier's and the edge filter's, with their don't-cares."""
    pixel = pixel_table(specification.model, specification.pixel_care)
    return pixel, specification.edge_filter.table().with_care(specification.window_care)


def _flags(codes: list[int] | None, size: int) -> NDArray[np.bool_]:
    flags = np.full(size, codes is None)
    if codes is not None:
        flags[codes] = True
    return flags
