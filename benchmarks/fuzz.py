"""Give every reader of files damaged ones, and count what it makes of them.

``python -m benchmarks.fuzz --cases 500 --seed 1`` makes a small build and all other files that commands read,
damages each of them ``--cases`` times and reads it with the function that the command calls; every
``CLI_EVERY``-th goes through the command itself. A file is read, or refused by one line; anything else
(another exception, a warning, more than ``SECONDS`` or ``MEMORY``) is a fault, and the status is then 1.
"""

import argparse
import contextlib
import io
import random
import resource
import shutil
import signal
import sys
import tempfile
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.damage import damaged
from wnn2hdl.apps.navigation.camera import Camera
from wnn2hdl.apps.navigation.poses import read_poses
from wnn2hdl.build.checking import synthesise_parts
from wnn2hdl.build.classifier import circuit_classifier, open_classifier
from wnn2hdl.build.compile import compile_model
from wnn2hdl.build.design import DESIGN_FILE, Design
from wnn2hdl.build.folder import REPORT_FILE
from wnn2hdl.build.planning import CompileOptions
from wnn2hdl.build.reporting import open_entries, read_report
from wnn2hdl.build.statements import false_statements
from wnn2hdl.build.verification import inspect_build, open_build
from wnn2hdl.cli import main as command_line
from wnn2hdl.dataset import LabelledImage, from_masks, from_regions
from wnn2hdl.dataset.regions import REGION_COLUMNS
from wnn2hdl.dataset.tables import read_table
from wnn2hdl.edges import from_file
from wnn2hdl.emit import MANIFEST_NAME
from wnn2hdl.encode import parse_bits
from wnn2hdl.errors import Wnn2hdlError
from wnn2hdl.evaluation.tagged import read_tags
from wnn2hdl.files import write_json, write_text
from wnn2hdl.images import Palette, read_rgb
from wnn2hdl.ir import Thermometer, WisardModel
from wnn2hdl.ir.models import load_model
from wnn2hdl.lower.targets import Ingredients, target_for
from wnn2hdl.markdown import head, row
from wnn2hdl.raster import RasterReader, Reading
from wnn2hdl.report import (
    Limits,
    gate_json,
    gate_junit,
    gate_markdown,
    index_page,
    read_baseline,
    run_gate,
    write_baseline,
)
from wnn2hdl.samples.flight import make_flight, write_flight
from wnn2hdl.samples.landscapes import IMAGES, MASKS, write_landscapes
from wnn2hdl.training.discriminators import train

SECONDS = 20.0
"""As long may reading a file take, on a busy machine."""

MEMORY = 4 << 30
"""So many bytes of addresses may the process take, all libraries included."""

CLI_EVERY = 50

LONGEST_LINE = 2500
"""Characters of a line that a person still reads."""


@dataclass(frozen=True)
class Reader:
    """One kind of file.

    Attributes:
        name: of the kind.
        file: a valid one; the damaged ones stand in its place.
        read: does with it what commands do; raises Wnn2hdlError for a file that it refuses.
        command: words of a command that reads it.
    """

    name: str
    file: Path
    read: Callable[[], object]
    command: tuple[str, ...]


@dataclass
class Tally:
    """What became of the files of a kind."""

    ends: Counter[str] = field(default_factory=Counter)
    faults: dict[str, str] = field(default_factory=dict)


class Overtime(BaseException):
    """A file took more than `SECONDS`."""


def ending(read: Callable[[], object]) -> tuple[str, str]:
    """How reading a file ended: ``read``, ``refused`` or a fault, and what there is to say about it."""

    def expire(*_: object) -> None:
        raise Overtime

    signal.signal(signal.SIGALRM, expire)
    signal.setitimer(signal.ITIMER_REAL, SECONDS)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            read()
    except Wnn2hdlError as error:
        line = error.line()
        if len(line) > LONGEST_LINE or not line.isprintable():
            return "an unreadable line", line[:300]
        return "refused", line
    except OSError as error:
        return "refused", str(error)  # the command line says it on one line
    except (Exception, Overtime) as error:  # any other is what is looked for
        place = traceback.extract_tb(error.__traceback__)[-1]
        return f"{type(error).__name__} in {Path(place.filename).name}:{place.lineno}", traceback.format_exc()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
    return "read", ""


def through_command(words: tuple[str, ...]) -> None:
    """Run a command in this process.

    Raises:
        AssertionError: it ends otherwise than a command may.
        Wnn2hdlError: it refuses its input, on one line.
    """
    output, complaint = io.StringIO(), io.StringIO()
    before, sys.argv = sys.argv, ["wnn2hdl", *words]
    try:
        with contextlib.redirect_stdout(output), contextlib.redirect_stderr(complaint):
            status = command_line()
    finally:
        sys.argv = before
    if status not in (0, 1, 2):
        raise AssertionError(f"status {status}")
    if status == 2:
        last = complaint.getvalue().splitlines()[-1]
        if not last.startswith("wnn2hdl: ") or "Traceback" in complaint.getvalue():
            raise AssertionError(last)
        raise Wnn2hdlError(last)


def fuzz(reader: Reader, cases: int, seed: int) -> Tally:
    """Damage the file of a reader again and again; it is put back at the end."""
    chance = random.Random(f"{seed} {reader.name}")
    content = reader.file.read_bytes()
    tally = Tally()
    try:
        for number in range(cases):
            wrong = damaged(content, chance)
            reader.file.write_bytes(wrong)
            by_command = reader.command and number % CLI_EVERY == 0
            end, text = ending((lambda: through_command(reader.command)) if by_command else reader.read)
            tally.ends[end] += 1
            if end not in ("read", "refused") and end not in tally.faults:
                tally.faults[end] = text
                kept = Path(tempfile.gettempdir()) / f"fuzz-{reader.name.replace(' ', '-')}-{number}"
                kept.write_bytes(wrong)
                tally.faults[end] += f"\nthe file: {kept}"
    finally:
        reader.file.write_bytes(content)
    return tally


def readers(folder: Path) -> list[Reader]:
    """Every kind of file that a command reads, and a valid one of each in an empty folder."""
    write_landscapes(folder / "scene", 2, 48, seed=5, progress=_silent)
    images, masks = folder / "scene" / IMAGES, folder / "scene" / MASKS
    labelled = ("--images", str(images), "--masks", str(masks))
    picture, mask = sorted(images.iterdir())[0], sorted(masks.iterdir())[0]
    bits = parse_bits("R7,R6,R5,G7,G6,B7")
    dataset = from_masks(images, masks)
    model = train(dataset, bits, address_bits=3, rams=4, bleaching=None, seed=0, progress=_silent)
    file = folder / "model.json"
    model.save(file)
    aside = str(folder / "aside.json")

    def of_model() -> None:
        read = load_model(file)
        if isinstance(read, WisardModel):
            open_classifier(file)
            target_for(read, "pixel" if read.encoder.kind == "bits" else None).lower(Ingredients(read))

    return [
        Reader("model", file, of_model, ("evaluate", str(file), *labelled)),
        Reader("picture, PNG", picture, lambda: read_rgb(picture), ("evaluate", str(file), *labelled)),
        Reader(
            "mask",
            mask,
            lambda: [*map(_labels, from_masks(images, masks))],
            ("train", *labelled, "-o", aside),
        ),
        *_of_features(folder),
        *_of_builds(folder, model, CompileOptions(test_images=images, test_masks=masks)),
        *_of_training(folder, images, labelled, file),
        *_of_flights(folder / "flight"),
    ]


def _labels(image: LabelledImage) -> int:
    return int(image.labels.sum())


def _of_features(folder: Path) -> Iterator[Reader]:
    file = folder / "features.json"
    counts = np.random.default_rng(0).integers(0, 3, (2, 3, 4))
    thresholds = Thermometer(((0.1, 0.5, 0.9), (2.0, 3.0)))
    WisardModel(thresholds, ("a", "b"), np.array([[[0, 1], [2, 3], [4, 0]]]), counts, 1).save(file)
    words: tuple[str, ...] = ("compile", str(file), "-o", str(folder / "aside"))
    yield Reader("model of features", file, lambda: load_model(file), words)
    table = folder / "table.csv"
    write_text(table, "height,width,label\n1.5,2,a\n0.25,3e1,b\n-1,0,a\n")
    words = ("evaluate", str(file), "--table", str(table), "--label", "label")
    yield Reader("table", table, lambda: read_table(table, "label"), words)


def _of_builds(folder: Path, model: WisardModel, options: CompileOptions) -> Iterator[Reader]:
    build, baseline = folder / "build", folder / "baseline.json"
    assert compile_model(model, build, options, _silent).failure is None
    write_baseline(baseline, {"build": read_report(build)}, {"build": ()})
    design, files, _ = open_build(build)
    counted = synthesise_parts(design, files, _silent)

    def inspect() -> None:
        _, found = inspect_build(build)
        if found is not None:
            false_statements(found[0], found[2], counted, {"status": "proved"})

    def of_design() -> None:
        circuit_classifier(Design.load(build))
        inspect()

    def of_report() -> None:
        _show(build, baseline)
        inspect()

    report = ("report", str(build))
    yield Reader("design", build / DESIGN_FILE, of_design, ("verify", str(build)))
    yield Reader("report", build / REPORT_FILE, of_report, (*report, "--format", "json"))
    yield Reader("manifest", build / MANIFEST_NAME, inspect, (*report, "--format", "markdown"))
    yield Reader("Verilog", files.verilog, inspect, ("verify", str(build)))
    words = (*report, "--baseline", str(baseline), "--format", "junit")
    yield Reader("baseline", baseline, lambda: _show(build, baseline), words)


def _of_training(folder: Path, images: Path, labelled: tuple[str, ...], model: Path) -> Iterator[Reader]:
    aside = str(folder / "aside.json")
    palette = folder / "palette.json"
    write_json(palette, {"forest": "#000000", "deforested": "#ffffff"})
    words = ("train", *labelled, "--palette", str(palette), "-o", aside)
    black = np.zeros((2, 2), np.uint8)
    yield Reader("palette", palette, lambda: Palette.read(palette).paint(black), words)
    edges = folder / "edges.json"
    write_text(edges, '{"patterns": [1, 56, "000111000", ["100", "100", "100"]]}\n')
    words = ("compile", str(model), "--target", "edge", "--edges", str(edges), "-o", str(folder / "aside"))
    yield Reader("edge patterns", edges, lambda: from_file(edges).table(), words)
    name = sorted(images.iterdir())[0]
    regions = folder / "regions.csv"
    rows = [f"{name.name},forest,0,0,20,20", f"{name.name},deforested,20,20,9,28"]
    write_text(regions, "\n".join([",".join(REGION_COLUMNS), *rows]) + "\n")
    words = ("train", "--regions", str(regions), "--chips", str(images), "-o", aside)
    yield Reader("regions", regions, lambda: [*from_regions(regions, images, seed=0)], words)
    tags = folder / "tags.csv"
    write_text(tags, f"image_name,tags\n{name.stem},clear primary\nnone,haze road\n")
    words = ("evaluate", str(model), "--chips", str(images), "--tags", str(tags))
    yield Reader("tags", tags, lambda: read_tags(tags), words)


def _of_flights(flight: Path) -> Iterator[Reader]:
    for _ in write_flight(flight, make_flight(0, (640, 640), frames=3)):
        pass
    poses, camera, ground = flight / "poses.csv", flight / "camera.toml", flight / "map.tif"
    frame = sorted((flight / "frames").iterdir())[0]
    words: tuple[str, ...] = (
        "locate",
        "--map",
        str(ground),
        "--frames",
        str(flight / "frames"),
        "--poses",
        str(poses),
    )
    words = (*words, "--camera", str(camera), "-o", str(flight / "located"))
    yield Reader("poses", poses, lambda: read_poses(poses), words)
    yield Reader("camera", camera, lambda: _look(camera), words)
    yield Reader("picture, JPEG", frame, lambda: read_rgb(frame), words)
    yield Reader("map, GeoTIFF", ground, lambda: RasterReader(ground, Reading()).thinned(32, 32), words)


def _show(build: Path, baseline: Path) -> None:
    """What `report` does, in all formats."""
    entries = open_entries([build], build.parent / "index.html")
    reports: Mapping[str, Any] = {entry.name: entry.report for entry in entries}
    known = read_baseline(baseline)
    checks = run_gate(reports, {"build": ()}, Limits(20, 0.5, 1), known)
    index_page(entries, None, checks)
    gate_markdown(reports, checks, known)
    gate_json(reports, checks)
    gate_junit(checks)


def _look(path: Path) -> None:
    camera = Camera.read(path)
    camera.rays(np.array([0.0, camera.width - 1.0]), np.array([0.0, camera.height - 1.0]))


def _silent(step: str, done: int, total: int) -> None:
    """No progress is shown."""


def main() -> None:
    """Print a table of files tried."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--cases", type=int, default=500, help="of each kind")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", help="kinds whose name holds this")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        kinds = [reader for reader in readers(Path(name)) if (options.only or "") in reader.name]
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        heads = ["file", "tried", "read", "refused by one line", "faults"]
        print(head(heads))
        faults: list[str] = []
        for reader in kinds:
            tally = fuzz(reader, options.cases, options.seed)
            read, refused = tally.ends["read"], tally.ends["refused"]
            wrong = options.cases - read - refused
            print(row([reader.name, options.cases, read, refused, wrong]), flush=True)
            faults += [
                f"{reader.name}, {tally.ends[end]}: {end}\n{text}" for end, text in tally.faults.items()
            ]
            shutil.rmtree(Path(name) / "scan", ignore_errors=True)
    print("\n\n".join(faults))
    sys.exit(bool(faults))


if __name__ == "__main__":
    main()
