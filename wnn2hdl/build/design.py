"""A design: the model, the circuit made from it, and all else that decides the emitted Verilog."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Literal, Self, get_args

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError, ModelFileError
from wnn2hdl.files import read_json, write_json
from wnn2hdl.ir import (
    Context,
    EdgeFilter,
    LutNetwork,
    Neighbourhood,
    PictureEncoder,
    Style,
    VideoFormat,
    WisardModel,
)
from wnn2hdl.ir.care import CareSet
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.circuit_file import circuit_from_json, circuit_to_json
from wnn2hdl.ir.engine import EngineFormat
from wnn2hdl.ir.identifiers import require_name, require_unreserved
from wnn2hdl.ir.models import AnyModel, load_model
from wnn2hdl.ir.registers import RegisterMap, engine_registers, video_registers
from wnn2hdl.ir.verilog_text import check_comment
from wnn2hdl.lower.targets import TARGETS, Target
from wnn2hdl.schedule import Stages, pipelined
from wnn2hdl.verify.specification import Specification
from wnn2hdl.verify.specify import care_sets, specify

Mode = Literal["exact", "domain"]

CLASSIFIERS = ("pixel", "neighbourhood", "decision", "context")
"""The circuits of which one says what a pixel is; its care set is that of the classifier."""

MODEL_FILE = "model.json"
DESIGN_FILE = "design.json"
IP = "ip"
"""A core with its registers, as a part."""

FORMAT = "wnn2hdl-design"
VERSION = 4


def require_picture_model(model: AnyModel) -> WisardModel:
    """A model that reads pictures, as it is given; raises InputError for all others."""
    if isinstance(model, WisardModel) and isinstance(model.encoder, PictureEncoder):
        return model
    raise InputError("the model does not read pictures", value=model.kind, hint="use one trained on images")


@dataclass(frozen=True, eq=False)
class Design:
    """Everything that decides the emitted Verilog.

    Attributes:
        model: the model.
        edges: the edge filter behind pixels; None if the circuit has none.
        circuit: the target's circuit; its tables are LUT networks, and it is combinational.
        target: what the circuit is.
        mode: ``exact``: equal to the model on every input that there is; ``domain``: on the care sets only.
        style: how LUT networks are written.
        name: what the names of all modules begin with.
        header: lines of the comment at the top of the Verilog.
        stages: where the registers of its pipeline are; None of a design without registers.
        video: the streams of a video core; None of all other designs.
        engine: the sizes of a match engine; None of all other designs.
    """

    model: AnyModel
    edges: EdgeFilter | None
    circuit: Circuit
    target: Target
    mode: Mode
    style: Style
    name: str
    header: tuple[str, ...]
    stages: Stages | None = None
    video: VideoFormat | None = None
    engine: EngineFormat | None = None

    @cached_property
    def specification(self) -> Specification:
        """What every circuit of the design has to compute, stated by the model."""
        return specify(self.model, self.edges, care_sets(self.circuit), self.circuit)

    @property
    def picture_model(self) -> WisardModel:
        """The model, of a design that classifies pictures; raises InputError for all others."""
        return require_picture_model(self.model)

    @cached_property
    def top(self) -> Circuit:
        """The circuit with its registers, as it is written in Verilog."""
        return self.circuit if self.stages is None else pipelined(self.circuit, self.stages)

    @property
    def surroundings(self) -> Neighbourhood | Context | None:
        """What the model looks at around a pixel; None of all other models."""
        encoder = self.model.encoder if isinstance(self.model, WisardModel) else None
        return encoder if isinstance(encoder, Neighbourhood | Context) else None

    @property
    def reads_grey(self) -> bool:
        """Whether its pixel classifier reads grey pixels alone, so that all other colours are don't-cares."""
        return self.video is not None and self.video.is_mono and self.surroundings is None

    @property
    def latency(self) -> int:
        """Cycles from inputs to outputs; of a video core those of its circuits, one after the other.

        Of a match engine those from the last pixel of a template to the result.
        """
        if self.engine is not None:
            return self.engine.cycles(self.top.latency)
        return self.top.latency if self.video is None else sum(node.latency for node in self.top.nodes)

    @property
    def parts(self) -> dict[str, Circuit]:
        """The circuits of the design by name, innermost first.

        The last is the top of the Verilog, unless that is a video core or a match engine: its circuits are
        apart from each other.
        """
        return {
            name: circuit
            for name, circuit in self.top.definitions().items()
            if not self.has_memories or circuit is not self.top
        }

    @property
    def has_memories(self) -> bool:
        """Whether its circuits stand between the registers and memories of a core."""
        return self.video is not None or self.engine is not None

    @property
    def networks(self) -> dict[str, LutNetwork]:
        """The LUT networks of the design, by the names of `Circuit.tables`."""
        return {
            name: table.function
            for name, table in self.circuit.tables().items()
            if isinstance(table.function, LutNetwork)
        }

    @property
    def care(self) -> CareSet | None:
        """The codes that the classifier is cared for on; None for a design without a classifier."""
        if not self.target.classifies:
            return None
        sets = care_sets(self.circuit)
        return next(sets[name] for name in CLASSIFIERS if name in sets)

    @property
    def registers(self) -> RegisterMap | None:
        """The registers of a core; None of designs that are none."""
        digest = self.model.digest()
        if self.engine is not None:
            return engine_registers(self.engine, digest)
        return None if self.video is None else video_registers(digest)

    def module(self, part: str) -> str:
        """The Verilog module of a circuit."""
        return f"{self.name}_{part}"

    @property
    def outermost(self) -> str:
        """The Verilog module around all others: of a core the one that has its registers."""
        return self.module(IP if self.has_memories else self.circuit.name)

    def made_by(self, effort: int, versions: Mapping[str, str]) -> tuple[str, ...]:
        """Lines for the comment at the top of the Verilog: what was made, of what, and by what.

        Args:
            effort: of the minimiser.
            versions: of the generators by name.
        """
        lines = [f"{self.module(self.circuit.name)}: made by wnn2hdl from the model {self.model.digest()}."]
        if self.mode == "exact":
            on = "every grey pixel" if self.reads_grey else "every input"
            lines.append(f"Mode exact: equal to the model on {on}.")
        else:
            lines.append("Mode domain: equal to the model on its care set; elsewhere it may answer anything.")
            lines += [
                f"The care set of the {name} holds {int(care.sum())} of {len(care)} codes."
                for name, care in self.cared.items()
            ]
        if self.stages is not None and self.has_memories:
            cycles = ", ".join(f"{name} {circuit.latency}" for name, circuit in self.parts.items())
            lines.append(f"Registers in its circuits, in cycles: {cycles}.")
        elif self.stages is not None:
            cycles = "1 cycle" if self.top.latency == 1 else f"{self.top.latency} cycles"
            lines.append(
                f"A pipeline of latency {cycles} that takes a new input in each; its outputs are registers."
            )
        made = f"LUT networks written as {self.style}, effort {effort}."
        if self.video is not None:
            kind = "grey" if self.video.is_mono else f"channels {self.video.format} from the low byte"
            lines.append(
                f"Pixels: {kind}, {self.video.pixels_per_clock} per clock; answer {self.video.answer}, "
                f"lines of up to {self.video.max_width} pixels."
            )
            if self.video.square is not None:
                lines.append(f"Majorities of squares of {self.video.square}x{self.video.square} pixels.")
        if self.engine is not None:
            (height, width), (rows, columns) = self.engine.template, self.engine.segment
            lines.append(
                f"Template {height}x{width} in a segment {rows}x{columns}: {self.latency} cycles, "
                f"{self.engine.lanes} lanes of {self.engine.columns} columns."
            )
        if self.edges is not None:
            made = f"Edge filter of {self.edges.size} patterns. {made}"
        return (*lines, made, ", ".join(f"{name} {version}" for name, version in versions.items()))

    @property
    def cared(self) -> dict[str, NDArray[np.bool_]]:
        """For each circuit with a care set the codes in it, bool ``[2**width]``."""
        return {
            name: care.project(tuple(range(care.width))) for name, care in care_sets(self.circuit).items()
        }

    def save(self, folder: Path) -> None:
        """Write `MODEL_FILE` and `DESIGN_FILE` into a folder."""
        self.model.save(folder / MODEL_FILE)
        write_json(
            folder / DESIGN_FILE,
            {
                "format": FORMAT,
                "version": VERSION,
                "model_sha256": self.model.digest(),
                "target": self.target.name,
                "mode": self.mode,
                "style": self.style,
                "name": self.name,
                "header": list(self.header),
                "edges": None if self.edges is None else self.edges.to_json(),
                "circuit": circuit_to_json(self.circuit),
                "pipeline": None if self.stages is None else self.stages.to_json(),
                "video": None if self.video is None else self.video.to_json(),
                "engine": None if self.engine is None else self.engine.to_json(),
            },
        )

    @classmethod
    def load(cls, folder: Path) -> Self:
        """Read what `save` wrote.

        Raises:
            ModelFileError: a file is missing or damaged, or they belong to different builds.
        """
        model = load_model(folder / MODEL_FILE)
        path = folder / DESIGN_FILE
        data = read_json(path, "a design")
        if data.get("format") != FORMAT or data.get("version") != VERSION:
            raise ModelFileError("not a design of this wnn2hdl", value=path, hint="compile the model again")
        if data.get("model_sha256") != model.digest():
            raise ModelFileError(
                "the design was made from another model", value=path, hint="compile the model again"
            )
        try:
            if data["mode"] not in get_args(Mode) or data["style"] not in get_args(Style):
                raise ValueError(f"mode {data['mode']!r}, style {data['style']!r}")
            design = cls(
                model,
                None if data["edges"] is None else EdgeFilter.from_json(data["edges"]),
                circuit_from_json(data["circuit"]),
                TARGETS[data["target"]],
                data["mode"],
                data["style"],
                require_name(data["name"]),
                tuple(data["header"]),
                None if data["pipeline"] is None else Stages.from_json(data["pipeline"]),
                None if data["video"] is None else VideoFormat.from_json(data["video"]),
                None if data["engine"] is None else EngineFormat.from_json(data["engine"]),
            )
            design.check()
        except (KeyError, TypeError, ValueError, IndexError, AttributeError, InputError) as error:
            raise ModelFileError("the design is damaged", value=f"{path} ({error})") from error
        return design

    def check(self) -> None:
        """Check that the circuit is one that the model makes claims about, and mapped.

        In exact mode a care set says at most what cannot occur at all, or that pixels are grey.

        Raises:
            ValueError: it is not.
            KeyError: its pipeline is that of another circuit.
            InputError: a module would be called like a reserved word.
        """
        for line in self.header:
            check_comment(line)
        claims = self.specification.claims
        if self.target.streams != (self.video is not None):
            raise ValueError(f"the {self.target.name} has streams, or has none")
        if self.target.matches != (self.engine is not None):
            raise ValueError(f"the {self.target.name} has sizes of an engine, or has none")
        if self.engine is not None and not self.top.latency:
            raise ValueError("the lanes of an engine have registers")
        outermost = self.parts if self.video else ("lane",) if self.engine else (self.circuit.name,)
        if unknown := [name for name in outermost if name not in claims]:
            raise ValueError(f"nothing is known about the circuits {unknown}")
        require_unreserved(self.module(self.circuit.name))
        for name, part in self.parts.items():
            require_unreserved(self.module(name))
            # A circuit without its own claim is proved as a part of one that has one.
            if name in claims and part.widths != (claims[name].inputs, claims[name].outputs):
                raise ValueError(f"{name} has the ports {part.widths}")
        if self.circuit.latency:
            raise ValueError(f"the circuit answers {self.circuit.latency} cycles late")
        for name, table in self.circuit.tables().items():
            if not isinstance(table.function, LutNetwork):
                raise ValueError(f"{name} is not mapped to LUTs")
        if not self.target.fits(self.model):
            raise ValueError(f"the model cannot be the target {self.target.name}")
        if self.target.classifies and care_sets(self.circuit).keys().isdisjoint(CLASSIFIERS):
            raise ValueError(f"the {self.target.name} holds no classifier")
        for name, care in care_sets(self.circuit).items():
            free = ("everything", "implied", *(["codes"] if self.reads_grey and name == "pixel" else []))
            if self.mode == "exact" and care.kind not in free:
                raise ValueError(f"{name} has don't-cares in exact mode")
