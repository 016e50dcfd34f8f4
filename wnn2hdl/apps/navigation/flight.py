"""A flight over a map, every frame located by every method: calibrate, learn, search, compare."""

import os
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import product
from typing import TypeVar

import cv2
import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.navigation.calibrate import Calibration, calibrate
from wnn2hdl.apps.navigation.camera import Camera
from wnn2hdl.apps.navigation.fixes import accepted, fixes, tracked
from wnn2hdl.apps.navigation.geometry import ground_patch
from wnn2hdl.apps.navigation.grid import MapGrid
from wnn2hdl.apps.navigation.learned import Conditions, Learned
from wnn2hdl.apps.navigation.matching import Acceptance
from wnn2hdl.apps.navigation.methods import METHODS, WEIGHTLESS, Method, compared_methods
from wnn2hdl.apps.navigation.navigator import Located, Navigator, Place, PoseTolerance
from wnn2hdl.apps.navigation.poses import Pose, require_located
from wnn2hdl.apps.navigation.recording import Recording
from wnn2hdl.apps.navigation.results import FlightResult, MethodResult, SearchKind, SearchResult
from wnn2hdl.apps.navigation.weightless import GSD_M, Sighting, by_rule, learn
from wnn2hdl.edges import grey
from wnn2hdl.errors import InputError
from wnn2hdl.ir.engine import EngineFormat
from wnn2hdl.progress import Progress, reported

T = TypeVar("T")

MOST_ACROSS = 300
"""The patches of the calibration are at most about this many pixels across, so that their searches take no
longer, however high the flight is, or is said to be."""

COARSER = 2
"""Calibration matches on a grid this much coarser: it needs metres, not half metres."""


@dataclass(frozen=True)
class FlightRun:
    """All that a run found out.

    Attributes:
        result: figures and fixes, for tables and pictures.
        grid: the map as it was matched.
        methods: in the order of each search's rows.
        learned: what was learned before; None if the camera was taken as given.
    """

    result: FlightResult
    grid: MapGrid
    methods: tuple[Method, ...]
    learned: Learned | None

    def rows(self, search: SearchResult) -> dict[str, MethodResult]:
        """A search's rows by their names in JSON."""
        keys = [method.key for method in self.methods]
        keys += [f"{key}-track" for key in keys]
        return dict(zip(keys, search.methods, strict=True))


def run_flight(
    recording: Recording,
    calibrating: Sequence[Pose] | Learned,
    searches: Mapping[SearchKind, float | None],
    progress: Progress,
    *,
    keys: Collection[str] = METHODS,
    engine: EngineFormat | None = None,
    heading_deg: float | None = None,
    scale: float = 0.0,
    jobs: int | None = None,
) -> FlightRun:
    """Locate all frames of a recording.

    Args:
        recording: its poses are those that are scored.
        calibrating: poses of other frames, on which the camera, the weightless edges and the thresholds of
            confidence are fitted; or what was learned so before; empty to take all as it is.
        searches: by kind, half the side in metres of a window around the logged position; None for the whole
            map.
        progress: called with how far the run is.
        keys: of the methods that are compared, at least one.
        engine: that methods among them answer as, see `wnn2hdl.apps.navigation.methods.engine_of`.
        heading_deg: how far the logged headings may be off; by default what the calibration found, or 0.
        scale: share by which the logged heights may be off.
        jobs: frames located at a time; by default as many as the machine has cores.

    Raises:
        InputError: a frame cannot be read, or the calibration fails or belongs to other conditions; a
            position that is needed is not known; no frame shows anything of the map.
    """
    add = "add its latitude and longitude, or"
    known = calibrating if isinstance(calibrating, Learned) else None
    teachers = () if isinstance(calibrating, Learned) else tuple(calibrating)
    require_located(teachers, "calibration takes known positions", f"{add} calibrate on other frames")
    if any(half is not None for half in searches.values()):
        require_located(
            recording.poses, "a window lies around a known position", f"{add} search the map alone"
        )
    progress("map", 0, 1)
    grid, coarse = recording.world.resampled(), recording.world.resampled(GSD_M)
    progress("map", 1, 1)
    calibration = known.calibration if known else None
    if teachers:
        calibration = calibrated(recording, teachers, progress)
    if heading_deg is None and known:
        heading_deg = known.conditions.tolerance.heading_deg
    elif heading_deg is None:
        heading_deg = calibration.heading_search_deg if calibration else 0.0
    tolerance = PoseTolerance(heading_deg, scale)

    def cameras_at(pose: Pose) -> tuple[Camera, ...]:
        return calibration.cameras_at(pose.frame) if calibration else (recording.camera,)

    conditions = None
    if calibration:
        conditions = Conditions.of(recording.world, recording.camera, tolerance, engine)
    weightless = known.weightless if known else by_rule()
    if known and conditions:
        known.require(conditions, searches, keys)
    elif teachers:
        sightings = (
            _sighting(coarse, recording.read(pose), pose, cameras_at(pose)[0], tolerance) for pose in teachers
        )
        weightless = learn(coarse.image, coarse.valid, sightings)
    methods = compared_methods(weightless, keys, engine)
    navigator = Navigator({None: grid, GSD_M: coarse}, methods)

    def locate(pose: Pose) -> dict[Place, Located | None]:
        windows = {
            kind: None if half is None else (pose.latitude_deg, pose.longitude_deg, half)
            for kind, half in searches.items()
        }
        return navigator.locate(recording.read(pose), pose, cameras_at(pose), windows, tolerance)

    proving = list(_in_parallel(locate, teachers, jobs, "thresholds", progress))
    places = product(searches, (method.key for method in methods))
    acceptances = (
        known.acceptances
        if known
        else {place: accepted(grid, teachers, [one[place] for one in proving]) for place in places}
    )
    found = list(_in_parallel(locate, recording.poses, jobs, "frames", progress))
    if not any(one[place] for one in found for place in one):
        raise InputError(
            "no frame shows anything of the map",
            value=recording.map_name,
            hint="check the positions, the heights and the camera"
            + ("" if engine is None else ", or give a smaller --template and --segment"),
        )
    searched = tuple(
        SearchResult(kind, half, _rows(grid, recording.poses, found, methods, acceptances, kind, half))
        for kind, half in searches.items()
    )
    result = _result(recording, grid, calibration, searched, read_back=known is not None)
    learned = known
    if calibration and conditions and not known:
        learned = Learned(conditions, teachers, calibration, weightless, dict(searches), acceptances)
    return FlightRun(result, grid, methods, learned)


def _result(
    recording: Recording,
    grid: MapGrid,
    calibration: Calibration | None,
    searches: tuple[SearchResult, ...],
    *,
    read_back: bool,
) -> FlightResult:
    camera = calibration.cameras[0] if calibration else recording.camera
    return FlightResult(
        map_name=recording.map_name,
        ground_sample_distance_m=grid.gsd_m,
        focal_px=camera.fx,
        tilts_deg=tuple(tilt for _, tilt in calibration.stretches) if calibration else (camera.tilt_deg,),
        calibrated_on=calibration.frames if calibration else (),
        searches=searches,
        map_note=recording.world.note,
        map_share=float(grid.valid.mean()),
        read_back=read_back,
    )


def _rows(
    grid: MapGrid,
    poses: Sequence[Pose],
    found: Sequence[Mapping[Place, Located | None]],
    methods: Sequence[Method],
    acceptances: Mapping[Place, Acceptance],
    kind: SearchKind,
    half: float | None,
) -> tuple[MethodResult, ...]:
    """Each method's row of a search, and then each one's with the filter over the track."""
    rows, tracks = [], []
    for method in methods:
        place = kind, method.key
        located = [one[place] for one in found]
        row = fixes(grid, poses, located, acceptances[place])
        rows.append(MethodResult(method.title, row, weightless=method.key == WEIGHTLESS))
        track = tracked(grid, poses, located, acceptances[place], half)
        tracks.append(MethodResult(f"{method.title}, track", track, tracked=True))
    return *rows, *tracks


def calibrated(recording: Recording, calibrating: Sequence[Pose], progress: Progress) -> Calibration:
    """The camera as fitted on some frames."""
    camera = recording.camera
    height_m = float(np.median([pose.height_m for pose in calibrating]))
    across_m = height_m * max(camera.width / camera.fx, camera.height / camera.fy)
    coarse = recording.world.resampled(max(COARSER * recording.world.gsd_m, across_m / MOST_ACROSS))
    frames = [grey(recording.read(pose)) for pose in calibrating]
    return calibrate(
        coarse,
        grey(coarse.image),
        frames,
        calibrating,
        camera,
        progress,
    )


def _sighting(
    grid: MapGrid, frame: NDArray[np.uint8], pose: Pose, camera: Camera, tolerance: PoseTolerance
) -> Sighting:
    """A calibration frame as the weightless edges learn from it."""
    patches = tuple(ground_patch(frame, tried, camera, grid.gsd_m) for tried in tolerance.poses(pose))
    row, column = (float(axis) for axis in grid.to_pixel(pose.latitude_deg, pose.longitude_deg))
    return Sighting(patches, row, column)


def _in_parallel(
    locate: Callable[[Pose], T], poses: Sequence[Pose], jobs: int | None, step: str, progress: Progress
) -> Iterator[T]:
    """Results in order. Threads, since they share the map and spend their time in OpenCV and NumPy.

    OpenCV gets no further threads, whose time would not be counted for any frame. However it ends, no thread
    is left behind: one inside OpenCV while Python goes down would abort the process.
    """
    workers = ThreadPoolExecutor(jobs or os.cpu_count() or 1)
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)
    try:
        yield from reported(workers.map(locate, poses), step, len(poses), progress)
    finally:
        workers.shutdown(cancel_futures=True)
        cv2.setNumThreads(threads)
