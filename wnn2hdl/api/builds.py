"""Builds: compiled, opened, verified."""

import shutil
import tempfile
import weakref
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from wnn2hdl.api.models import Model
from wnn2hdl.api.progress import watched
from wnn2hdl.api.showing import Shown
from wnn2hdl.build.compile import compile_model, require_equal
from wnn2hdl.build.design import Design
from wnn2hdl.build.folder import require_build
from wnn2hdl.build.planning import CompileOptions
from wnn2hdl.build.reporting import read_report
from wnn2hdl.build.verification import verify_build
from wnn2hdl.ir.models import AnyModel, load_model
from wnn2hdl.progress import Progress
from wnn2hdl.report.baseline import shown_parts

UNNAMED = "circuit"
"""The folder's name, and so that of the modules, if no folder is named."""


@dataclass(frozen=True, eq=False, repr=False)
class Build(Shown):
    """A circuit with its proof and counts.

    Attributes:
        folder: where its files lie; without a name of its own it goes when the build is no longer used.
        report: the object of its `report.json`.
    """

    folder: Path
    report: dict[str, Any] = field(repr=False)

    @property
    def luts(self) -> dict[str, int]:
        """LUTs of each part that was counted."""
        return {
            part: figures["luts"]
            for part, figures in self.report["parts"].items()
            if figures["luts"] is not None
        }

    @property
    def proved(self) -> bool:
        """Whether all of it is proved equal to the model."""
        status: str = self.report["proof"]["status"]
        return status == "proved"

    @property
    def accuracy(self) -> float | None:
        """Of the circuit on the test pictures or rows that `compile` was given, 0 to 1; None without any."""
        share: float | None = self.report["accuracy"]
        return share

    @property
    def design(self) -> Design:
        """The circuit and all that decides its text."""
        return Design.load(self.folder)

    @property
    def verilog(self) -> str:
        """The text of the circuit."""
        return (self.folder / f"{self.design.name}.v").read_text(encoding="utf-8")

    @property
    def title(self) -> str:
        """See `Shown.title`."""
        return f"{self.report['name']}: {self.report['target']}, {self.report['mode']} mode"

    @property
    def facts(self) -> Mapping[str, str]:
        """See `Shown.facts`."""
        proof = self.report["proof"]
        found = {"proof": f"{proof['status']}, {proof['method']}"}
        parts = shown_parts(self.report["parts"])
        found |= {f"LUTs of {part}": str(figures["luts"]) for part, figures in parts.items()}
        if self.accuracy is not None:
            found["accuracy"] = f"{self.accuracy:.2%}"
        return found | {"folder": str(self.folder)}


@dataclass(frozen=True, repr=False)
class Verification(Shown):
    """What checking a build again found.

    Attributes:
        folder: of the build.
        problems: one line each; empty if there is none.
        unproved: claims that a limit left undecided.
    """

    folder: Path
    problems: tuple[str, ...]
    unproved: tuple[str, ...]

    def __bool__(self) -> bool:
        """Whether the build is what it says, and all of it is proved."""
        return not self.problems and not self.unproved

    @property
    def title(self) -> str:
        """See `Shown.title`."""
        return f"{self.folder}: {'verified' if self else 'NOT verified'}"

    @property
    def facts(self) -> Mapping[str, str]:
        """See `Shown.facts`."""
        found = {f"problem {number}": text for number, text in enumerate(self.problems, start=1)}
        return found | ({"unproved": ", ".join(self.unproved)} if self.unproved else {})


def compile(  # noqa: A001  # as the command is called
    model: Model | AnyModel | Path | str,
    folder: Path | str | None = None,
    options: CompileOptions = CompileOptions(),  # noqa: B008  # frozen
    *,
    progress: Progress | None = None,
) -> Build:
    """Compile a model to Verilog, prove it, and count its LUTs.

    Args:
        model: the model, or its file.
        folder: where the build goes; an earlier build there is replaced. Without it the files are temporary.
        options: target, mode, pipeline and so on.
        progress: called with every stage; by default a line is shown where somebody watches.

    Raises:
        InputError: the model or the imagery cannot be used, or the folder cannot be written.
        CheckError: the circuit is not the model.
        ToolError: an outside program is missing or failed.
    """
    place = Path(tempfile.mkdtemp(prefix="wnn2hdl-"), UNNAMED) if folder is None else Path(folder)
    try:
        with watched(progress) as report:
            made = compile_model(network(model), place, options, report)
        require_equal(made)
    except BaseException:
        if folder is None:
            shutil.rmtree(place.parent, ignore_errors=True)
        raise
    build = Build(made.folder, made.report)
    if folder is None:
        weakref.finalize(build, shutil.rmtree, place.parent, ignore_errors=True)
    return build


def open_build(folder: Path | str) -> Build:
    """A build that was made before; raises InputError or ModelFileError if the folder holds none."""
    require_build(Path(folder))
    return Build(Path(folder), read_report(Path(folder)))


def verify(build: Build | Path | str, *, progress: Progress | None = None) -> Verification:
    """Check a build from its files alone: hashes, text, simulation, proof, counts.

    Args:
        build: the build, or its folder.
        progress: called with every stage; by default a line is shown where somebody watches.

    Raises:
        InputError: the folder is not a build.
        ToolError: an outside program is missing or failed.
    """
    folder = build.folder if isinstance(build, Build) else Path(build)
    with watched(progress) as report:
        problems, checked = verify_build(folder, report)
    return Verification(folder, tuple(problems), () if checked is None else checked.unproved)


def network(model: Model | AnyModel | Path | str) -> AnyModel:
    """The network that is meant; raises ModelFileError for a file that holds none."""
    if isinstance(model, Model):
        return model.model
    return load_model(Path(model)) if isinstance(model, Path | str) else model
