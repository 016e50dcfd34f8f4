"""Where a flight's frames were taken."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from wnn2hdl.api.progress import watched
from wnn2hdl.api.showing import Shown
from wnn2hdl.apps.navigation.camera import Camera
from wnn2hdl.apps.navigation.conventions import read_flight_poses
from wnn2hdl.apps.navigation.flight import FlightRun, run_flight
from wnn2hdl.apps.navigation.learned import Learned
from wnn2hdl.apps.navigation.methods import METHODS, engine_of
from wnn2hdl.apps.navigation.poses import Pose, frame_files
from wnn2hdl.apps.navigation.recording import Recording, split, unseen
from wnn2hdl.apps.navigation.results import MethodResult, SearchKind
from wnn2hdl.apps.navigation.summary import write_run
from wnn2hdl.errors import InputError
from wnn2hdl.files import output_folder
from wnn2hdl.ir.engine import Shape
from wnn2hdl.progress import Progress
from wnn2hdl.raster import Reading


@dataclass(frozen=True, eq=False, repr=False)
class Flight(Shown):
    """A located flight.

    Attributes:
        run: figures, positions of each frame, and what was learned.
    """

    run: FlightRun

    @property
    def methods(self) -> dict[SearchKind, dict[str, MethodResult]]:
        """The positions and errors of each search's methods."""
        return {search.kind: self.run.rows(search) for search in self.run.result.searches}

    @property
    def title(self) -> str:
        """See `Shown.title`."""
        frames = len(self.run.result.searches[0].methods[0].fixes)
        return f"{frames} frames located on {self.run.result.map_name}"

    @property
    def facts(self) -> Mapping[str, str]:
        """See `Shown.facts`."""
        return {
            f"{method}, {kind}": _spoken(row)
            for kind, rows in self.methods.items()
            for method, row in rows.items()
            if not row.tracked
        }

    def write(self, folder: Path | str) -> tuple[Path, ...]:
        """Write tables, GeoJSON, plots and what was learned; raises InputError if that cannot be done."""
        with output_folder(Path(folder), "flight"):
            return write_run(self.run, Path(folder))


def recording(
    map_file: Path | str,
    frames: Path | str,
    poses: Path | str,
    camera: Camera | float,
    reading: Reading = Reading(),  # noqa: B008  # frozen
) -> Recording:
    """A flight from files.

    Args:
        map_file: a GeoTIFF of the country flown over.
        frames: a folder of the camera's frames.
        poses: a CSV of the frames' logged poses.
        camera: the camera, or its focal length in pixels.
        reading: how the map is read.

    Raises:
        InputError: a file is missing or cannot be used, or the log follows another convention.
        ExtraMissingError: the extra ``geo`` is not installed.
    """
    logged = read_flight_poses(Path(poses))
    return Recording.of_files(Path(map_file), frame_files(logged, Path(frames)), camera, reading)


def locate(
    flight: Recording | None = None,
    *,
    calibrate: int | Sequence[Pose] | Learned | Path | str = 0,
    methods: Collection[str] = METHODS,
    engine: tuple[Shape, Shape] | None = None,
    window_m: float | None = 95.0,
    whole_map: bool = True,
    heading_deg: float | None = None,
    height_share: float = 0.0,
    jobs: int | None = None,
    seed: int = 0,
    progress: Progress | None = None,
) -> Flight:
    """Locate the frames of a flight.

    Args:
        flight: of `recording`, or made of arrays; a generated flight if left out.
        calibrate: so many frames, or those of these poses, are fitted on and not scored; or what an earlier
            run learned, or its ``calibration.json``; 0 takes everything as it is given.
        methods: keys of those that are compared.
        engine: rows and columns of template and segment of the match engine that methods answer as.
        window_m: half the side of a window around the logged position that is searched; None for no window.
        whole_map: search the whole map, too.
        heading_deg: how far logged headings may be off; by default what the calibration found.
        height_share: by which share logged heights may be off.
        jobs: frames located at a time; by default as many as the machine has cores.
        seed: of the generated flight.
        progress: called with how far it is; by default a line is shown where somebody watches.

    Raises:
        InputError: nothing is to be searched, too few frames are left, or as `run_flight`.
        ExtraMissingError: the extra ``geo`` is not installed.
    """
    searches: dict[SearchKind, float | None] = {}
    if window_m is not None:
        searches["window"] = window_m
    if whole_map:
        searches["map"] = None
    if not searches:
        raise InputError("nothing is to be searched", hint="give a window, or search the whole map")
    template, segment = engine or (None, None)
    answering = engine_of(template, segment, methods)
    with watched(progress) as report:
        flown = flight or Recording.embedded(seed)
        if isinstance(calibrate, Path | str):
            calibrate = Learned.read(Path(calibrate))
        learned: Learned | Sequence[Pose]
        if isinstance(calibrate, int):
            learned, scored = split(flown.poses, calibrate) if calibrate else ((), flown.poses)
        else:
            used = calibrate.poses if isinstance(calibrate, Learned) else calibrate
            learned, scored = calibrate, unseen(flown.poses, used)
        run = run_flight(
            flown.scoring(scored),
            learned,
            searches,
            report,
            keys=methods,
            engine=answering,
            heading_deg=heading_deg,
            scale=height_share,
            jobs=jobs,
        )
    return Flight(run)


def _spoken(row: MethodResult) -> str:
    if row.mean_m is None:
        return "errors not known"
    return f"{row.mean_m:.1f} m off on average, fixes for {row.fixed_percent:.0f} % of the frames"
