"""The HTML page of a build, made of what lies in its folder."""

import os
import shlex
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any
from urllib.parse import quote

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.build.classifier import circuit_classifier
from wnn2hdl.build.design import MODEL_FILE, Design
from wnn2hdl.build.emission import steps
from wnn2hdl.build.folder import REPORT_FILE, REPORT_HTML, SAMPLE_FILE, failure, require_build
from wnn2hdl.build.planning import CompileOptions
from wnn2hdl.dataset import Dataset
from wnn2hdl.edges import RULES
from wnn2hdl.emit import check as check_manifest
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.accuracy import with_halo
from wnn2hdl.evaluation.classifiers import model_classifier
from wnn2hdl.files import write_text
from wnn2hdl.images import Palette, png_bytes, read_rgb, spoken_codes
from wnn2hdl.ir import Neighbourhood, window_codes
from wnn2hdl.report import Entry, Picture, build_page, load_report, percent
from wnn2hdl.samples import landscape

SAMPLE_SIDE = 256
"""Pixels of the sample picture's sides at most: enough to see the edges of, small enough for a page."""

SAMPLE_SEED = 1000

_FLAGS = {"care_minimum": "--care-min"}
_NO_FLAG = frozenset({"sobel_threshold", "prune", "prune_table", "most_changed"})
"""Options that users cannot give, and those that have done their work on the build's model."""

_EDGE_SETS = frozenset({*RULES, "learned"})


def sample_picture(test_set: Dataset | None) -> NDArray[np.uint8]:
    """The middle of the first whole test image; without one, a generated landscape.

    Returns:
        uint8 ``[height, width, 3]``, at most `SAMPLE_SIDE` high and wide.
    """
    image = next(iter(test_set), None) if test_set is not None else None
    if image is None or image.shape is None:
        return landscape(SAMPLE_SIDE, SAMPLE_SIDE, SAMPLE_SEED).image
    top, left = (max(0, size - SAMPLE_SIDE) // 2 for size in image.shape)
    return np.ascontiguousarray(image.picture[top : top + SAMPLE_SIDE, left : left + SAMPLE_SIDE])


def page(design: Design, report: Mapping[str, Any], sample: NDArray[np.uint8]) -> str:
    """The page of a build.

    Args:
        design: the build's.
        report: the object of its `report.json`.
        sample: a picture to show through the circuit, uint8 ``[height, width, 3]``.
    """
    if not (design.target.classifies or design.target.has_edges):
        return build_page(report, design.networks, steps=steps(design))
    model = design.picture_model
    palette = Palette.of(model.classes)
    window = model.encoder if isinstance(model.encoder, Neighbourhood) else None
    legend = tuple(palette.to_json().items())
    pictures = _pictures(design, sample, palette)
    return build_page(report, design.networks, pictures, legend, window, steps(design))


def write_page(folder: Path) -> Path:
    """Write the page of a build into its folder, made of the files there.

    Raises:
        ModelFileError: one of these is missing or damaged.
        InputError: the page cannot be written.
    """
    report = read_report(folder)
    sample = folder / SAMPLE_FILE
    picture = read_rgb(sample) if sample.is_file() else sample_picture(None)
    write_text(folder / REPORT_HTML, page(Design.load(folder), report, picture))
    return folder / REPORT_HTML


def read_report(folder: Path) -> dict[str, Any]:
    """The report of a build; raises ModelFileError if it is missing, damaged or of another wnn2hdl.

    A build that is marked as failed is not proved, whatever the report says.
    """
    report = load_report(folder / REPORT_FILE)
    reason = failure(folder)
    if reason is not None:
        report["proof"] |= {"status": "failed", "failure": reason}
    return report


def open_entries(folders: Sequence[Path], index: Path) -> tuple[Entry, ...]:
    """Builds for an index, each with a page; a page that is missing is written.

    Args:
        folders: the builds; those of the same name are distinguished by their paths.
        index: the file of the index, which links to their pages.

    Raises:
        InputError: one is not a build, is given twice, or lies in a folder whose name is not UTF-8.
        ModelFileError: a file of one is missing or damaged, the manifest among them.
    """
    places = [folder.resolve() for folder in folders]
    for folder, place in zip(folders, places, strict=True):
        if places.count(place) > 1:
            raise InputError("a build is given twice", value=folder, hint="name it once")
        _require_utf8(place)
    names = Counter(place.name for place in places)
    entries = []
    for folder, place in zip(folders, places, strict=True):
        require_build(folder)
        report = read_report(folder)
        # The page is made of the other files, and one of another version of wnn2hdl is not a change of these.
        changes = tuple(check_manifest(folder, besides={REPORT_HTML}))
        if not (folder / REPORT_HTML).is_file():
            write_page(folder)
        name = place.name if names[place.name] == 1 else str(folder)
        networks = Design.load(folder).networks
        entries.append(Entry(name, _link(place / REPORT_HTML, index.resolve()), report, networks, changes))
    return tuple(entries)


def _link(page: Path, index: Path) -> str:
    """The address of a page for its index, with the way back to it."""
    way, back = (
        quote(Path(os.path.relpath(end, start.parent)).as_posix())
        for start, end in ((index, page), (page, index))
    )
    return f"{way}?index={back}"


def _require_utf8(folder: Path) -> None:
    shown = os.fsencode(folder).decode(errors="backslashreplace")
    if shown != str(folder):
        raise InputError("the name of a folder is not UTF-8", value=shown, hint="rename it")


def command(name: str, options: CompileOptions) -> str:
    """The command that compiles a build's model again, as a shell takes it, without options of no effect.

    Args:
        name: of the build folder, whose model is compiled and beside which the new build is put.
        options: what it was compiled with.
    """
    words = ["wnn2hdl", "compile", f"{name}/{MODEL_FILE}", "-o", f"{name}-again"]
    usual = asdict(CompileOptions())
    for option, value in asdict(options).items():
        if option == "raw" and value is not None:
            words.append(_scaling(value))
        elif value != usual[option] and option not in _NO_FLAG:
            words += [_FLAGS.get(option, f"--{option.replace('_', '-')}"), _word(option, value)]
    return shlex.join(words)


def _scaling(raw: bool) -> str:
    return "--raw" if raw else "--scaled"


def evaluation(name: str, options: CompileOptions) -> str:
    """The command that measures a build on its test data again; arguments as of `command`."""
    places = {
        "--images": options.test_images,
        "--masks": options.test_masks,
        "--palette": options.palette,
        "--table": options.test_table,
    }
    words = ["wnn2hdl", "evaluate", name]
    if options.raw is not None:
        words.append(_scaling(options.raw))
    for flag, place in places.items():
        if place is not None:
            words += [flag, str(place.resolve())]
    for option in ("label", "ignore", "bands", "scale", "alpha"):
        value = getattr(options, option)
        if value is not None:
            words += [f"--{option}", _word(option, value)]
    return shlex.join(words)


def _word(option: str, value: Any) -> str:
    # Paths are whole, since the command is run from another folder than the one they were given in.
    if isinstance(value, Path) or (option == "edges" and value not in _EDGE_SETS):
        return str(Path(value).resolve())
    if option == "ignore":
        return spoken_codes(value)
    if option in ("template", "segment"):
        return "x".join(map(str, value))
    if isinstance(value, tuple):
        return (".." if option == "scale" else ",").join(map(str, value))
    return str(value)


def _pictures(design: Design, sample: NDArray[np.uint8], palette: Palette) -> tuple[Picture, ...]:
    given = "" if design.target.classifies else ", as the edge filter is given it"
    classifier = (
        circuit_classifier(design) if design.target.classifies else model_classifier(design.picture_model)
    )
    labels = classifier.classify(with_halo(sample, classifier.halo))
    # Outside of its care set a circuit of several outputs may name a class that does not exist.
    labels = np.minimum(labels, np.uint8(len(palette.names) - 1))
    found = [
        _picture("Input", "A picture, as it goes in", sample),
        _picture(
            f"Class of each pixel{given}",
            _shares(labels, palette.names),
            palette.paint(labels),
        ),
    ]
    if "edge" in design.networks and min(labels.shape) >= 3:
        edges = design.networks["edge"].evaluate(window_codes(labels != 0))[..., 0]
        # With a white rim, since pixels there have no whole window, so that all pictures lie alike.
        drawn = np.pad(np.where(edges, np.uint8(0), np.uint8(255)), 1, constant_values=255)
        caption = f"{percent(float(edges.mean()))} of the windows are an edge, drawn in black"
        found.append(_picture("Edges", caption, drawn))
    return tuple(found)


def _picture(title: str, description: str, array: NDArray[np.uint8]) -> Picture:
    return Picture(title, description, png_bytes(array), array.shape[1], array.shape[0])


def _shares(labels: NDArray[np.uint8], names: tuple[str, ...]) -> str:
    shares = np.bincount(labels.ravel(), minlength=len(names)) / labels.size
    return ", ".join(f"{percent(float(share))} {name}" for name, share in zip(names, shares, strict=True))
