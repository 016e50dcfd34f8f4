"""Everything on the embedded default: landscapes, sweep, circuits, proof, a map, a flight and a page."""

import shlex
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.local import run_locally as scan_locally
from wnn2hdl.apps.deforestation.options import ScanOptions
from wnn2hdl.apps.deforestation.output import OVERLAY_FILE, SUMMARY_HTML
from wnn2hdl.apps.deforestation.scanning import Scanner
from wnn2hdl.apps.navigation.flight import FlightRun, run_flight
from wnn2hdl.apps.navigation.methods import WEIGHTLESS
from wnn2hdl.apps.navigation.page import PAGE_FILE as FLIGHT_PAGE
from wnn2hdl.apps.navigation.recording import Recording, split
from wnn2hdl.apps.navigation.summary import write_run
from wnn2hdl.apps.overview import Overview, write_overview
from wnn2hdl.apps.sweep import Outcome, Recipe, discard_another, draw, grid, present, run_locally, run_sweep
from wnn2hdl.build.compile import Build, compile_model
from wnn2hdl.build.folder import require_replaceable
from wnn2hdl.build.planning import CompileOptions
from wnn2hdl.build.playback import Playback, play
from wnn2hdl.build.reporting import open_entries
from wnn2hdl.build.verification import open_build
from wnn2hdl.dataset import Dataset, from_masks
from wnn2hdl.encode import high_bits
from wnn2hdl.errors import ExtraMissingError
from wnn2hdl.files import make_folder, write_text
from wnn2hdl.images import read_rgb, write_png
from wnn2hdl.ir import WisardModel
from wnn2hdl.ir.model import COMMAND
from wnn2hdl.progress import Progress
from wnn2hdl.report import Exhibit, index_page, percent
from wnn2hdl.samples import landscape
from wnn2hdl.samples.landscapes import IMAGES, MASKS, write_landscapes
from wnn2hdl.training.budget import train_under_budget
from wnn2hdl.training.discriminators import train, with_colours

if TYPE_CHECKING:
    from wnn2hdl.apps.navigation.results import SearchKind

SIDE = 256
TRAINING_SEED, TRAINING_IMAGES = 0, 12
TEST_SEED, TEST_IMAGES = 1000, 4
"""Landscapes to train on, and others to test on: different seeds, so no image is in both."""

SCENE_SIDE, SCENE_SEED = 768, 2000
"""The landscape that is mapped."""

ADDRESS_BITS, RAMS, TRIALS, FINALIST_TRIALS, SWEEP_PIXELS = (2, 3, 4, 5), (4, 8, 12, 16), 5, 20, 5_000
"""A sweep of seconds; the reference design's had n = 2…12, k = 2…20, ten trials, and 100 of a finalist."""

LUTS_PER_PIXEL = 1

CALIBRATION_FRAMES = 5
WINDOW_M = 95.0
"""Half the side of the window that the reference searched."""

PAGE, OVERVIEW, REFERENCE_BUILD, SMALLEST_BUILD = "index.html", "overview.jpg", "reference", "smallest"
"""Names in the demo's folder."""

REFERENCE = "the reference design's discriminators (n = 4, k = 16), on the colours of the training landscapes"
SMALLEST = "the most accurate classifier of one LUT per pixel, on every input"
"""What the two builds are."""


@dataclass(frozen=True, eq=False)
class Demo:
    """What the demo made.

    Attributes:
        page: the page to open.
        outcome: of the sweep.
        reference: the reference design's discriminators (n = 4, k = 16), in domain mode.
        smallest: the most accurate classifier of `LUTS_PER_PIXEL` LUT per pixel, on every input.
        windows: 3x3 windows of a landscape that ran through the smallest circuit.
        scan: the summary of the mapped landscape; None without the extra ``geo``.
        flight: the located flight; None without it.
        missing: what to install for what was left out; empty if nothing was.
    """

    page: Path
    outcome: Outcome
    reference: Build
    smallest: Build
    windows: int
    scan: dict[str, Any] | None
    flight: FlightRun | None
    missing: str


def run_demo(folder: Path, seed: int, progress: Progress) -> Demo:
    """Run every stage on generated data.

    Args:
        folder: gets the landscapes (``training``, ``test``), ``sweep``, the builds ``reference`` and
            ``smallest``, ``scan``, ``flight``, the page, and `OVERVIEW`, one picture of it all.
        seed: of the tuple mappings.
        progress: called with every stage.

    Raises:
        InputError: the folder cannot be written, or something else is where a build is to go.
        ToolError: an outside program is missing or failed.
    """
    for name in (REFERENCE_BUILD, SMALLEST_BUILD):
        require_replaceable(folder / name)
    training = _landscapes(folder / "training", TRAINING_IMAGES, TRAINING_SEED, progress)
    test = _landscapes(folder / "test", TEST_IMAGES, TEST_SEED, progress)
    outcome = _sweep(training, folder / "sweep", seed, progress)
    model = train(
        training, high_bits(), address_bits=4, rams=16, bleaching=None, seed=seed, progress=progress
    )
    model = _trained(model, training, folder, seed, "", progress)
    options = CompileOptions(test_images=folder / "test" / IMAGES, test_masks=folder / "test" / MASKS)
    domain = replace(options, mode="domain", care=folder / "training" / IMAGES)
    reference = compile_model(model, folder / REFERENCE_BUILD, domain, progress)
    small = train_under_budget(training, LUTS_PER_PIXEL, trials=0, seed=seed, progress=progress)
    small = _trained(
        small, training, folder, seed, f" --luts-per-pixel {LUTS_PER_PIXEL} --trials 0", progress
    )
    smallest = compile_model(small, folder / SMALLEST_BUILD, options, progress)
    picture = folder / "test" / IMAGES / f"{test.names[0]}"
    playback = play(smallest.folder, picture, "amaranth", progress)
    scanned = flight = None
    missing = ""
    try:
        scanned = _scan(smallest.folder, folder, progress)
        flight = _fly(folder / "flight", seed, progress)
    except ExtraMissingError as error:
        missing = error.line()
    _show(folder, smallest, read_rgb(picture), playback, scanned is not None, flight)
    entries = open_entries([reference.folder, smallest.folder], folder / PAGE)
    exhibits = _exhibits(outcome, scanned, flight)
    lead = f"From generated landscapes: {REFERENCE} (reference), and {SMALLEST} (smallest)."
    pair = (entries[0], entries[1])
    write_text(folder / PAGE, index_page(entries, pair, (), exhibits, lead, maker="wnn2hdl demo"))
    return Demo(folder / PAGE, outcome, reference, smallest, playback.windows, scanned, flight, missing)


def _trained(
    model: WisardModel, dataset: Dataset, folder: Path, seed: int, choice: str, progress: Progress
) -> WisardModel:
    """A model with the colours it saw, and a note of the command that does what was done here."""
    images, masks = (shlex.quote(str((folder / "training" / name).resolve())) for name in (IMAGES, MASKS))
    command = f"wnn2hdl train --images {images} --masks {masks}{choice} --seed {seed}"
    model = with_colours(model, dataset, progress)
    return replace(model, training={**model.training, COMMAND: command})


def _landscapes(folder: Path, count: int, seed: int, progress: Progress) -> Dataset:
    write_landscapes(folder, count, SIDE, seed=seed, progress=progress)
    return from_masks(folder / IMAGES, folder / MASKS)


def _sweep(training: Dataset, folder: Path, seed: int, progress: Progress) -> Outcome:
    plan = grid(Recipe(seed, high_bits().bits, None, 1), ADDRESS_BITS, RAMS, TRIALS)
    sets = draw(training, pixels=SWEEP_PIXELS, seed=seed, progress=progress)
    # Of an earlier demo with another seed.
    discard_another(sets, plan.recipe, folder)
    outcome = run_sweep(sets, plan, folder, run_locally, progress, finalist_trials=FINALIST_TRIALS)
    present(outcome, sets, folder)
    return outcome


def _scan(build: Path, folder: Path, progress: Progress) -> dict[str, Any]:
    make_folder(folder / "scan")
    scene = folder / "scan" / "scene.png"
    write_png(scene, landscape(SCENE_SIDE, SCENE_SIDE, SCENE_SEED).image)
    scanner = Scanner.open(build, ScanOptions(), partial(scan_locally, 1), progress)
    return scanner.scan(scene, folder / "scan")


def _fly(folder: Path, seed: int, progress: Progress) -> FlightRun:
    recording = Recording.embedded(seed)
    calibrating, scored = split(recording.poses, CALIBRATION_FRAMES)
    searches: dict[SearchKind, float | None] = {"window": WINDOW_M, "map": None}
    run = run_flight(recording.scoring(scored), calibrating, searches, progress)
    make_folder(folder)
    write_run(run, folder)
    return run


def _show(
    folder: Path,
    build: Build,
    photo: NDArray[np.uint8],
    playback: Playback,
    mapped: bool,
    flight: FlightRun | None,
) -> None:
    """Write all of it as one picture."""
    luts = {part: figures["luts"] for part, figures in build.report["parts"].items()}
    design, _, _ = open_build(build.folder)
    overlay = read_rgb(folder / "scan" / OVERLAY_FILE) if mapped else None
    write_overview(folder / OVERVIEW, Overview(photo, playback, design, luts, overlay, flight))


def _exhibits(outcome: Outcome, scanned: dict[str, Any] | None, flight: FlightRun | None) -> list[Exhibit]:
    exhibits = []
    if scanned:
        text = (
            f"A landscape of {SCENE_SIDE}x{SCENE_SIDE} pixels as the smallest circuit sees it: "
            f"{percent(scanned['deforested']['share'])} is deforested."
        )
        exhibits.append(Exhibit("Map", text, f"scan/{SUMMARY_HTML}?index=../{PAGE}", f"scan/{OVERLAY_FILE}"))
    if flight:
        search = flight.result.searches[-1]
        row = flight.rows(search)[WEIGHTLESS]
        text = (
            f"{len(row.fixes)} frames of a generated flight, located on the whole map by weightless edges: "
            f"{row.mean_m:.1f} m off on average. {search.beaten}"
        )
        exhibits.append(
            Exhibit("Flight", text.strip(), f"flight/{FLIGHT_PAGE}?index=../{PAGE}", "flight/tracks_map.svg")
        )
    text = f"{len(outcome.plan)} trained and costed circuits, and the statistics that choose among them."
    exhibits.append(Exhibit("Sweep", text, f"sweep/index.html?index=../{PAGE}", "sweep/pareto.svg"))
    return exhibits
