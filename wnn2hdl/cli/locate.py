"""`locate`: where was the UAV, from each of its frames and a map."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click

from wnn2hdl.apps.navigation.camera import Camera
from wnn2hdl.apps.navigation.conventions import read_flight_poses
from wnn2hdl.apps.navigation.methods import ENGINE_METHODS, METHODS, engine_of
from wnn2hdl.apps.navigation.poses import Pose, frame_files
from wnn2hdl.apps.navigation.recording import Recording, unseen
from wnn2hdl.cli.finite import FiniteRange
from wnn2hdl.cli.main import app
from wnn2hdl.cli.options import SizeType, file, folder, jobs_option, output_option, seed_option
from wnn2hdl.cli.output import emit, json_option, progress
from wnn2hdl.cli.pictures import READING, reading_options
from wnn2hdl.errors import InputError
from wnn2hdl.files import output_folder
from wnn2hdl.ir.engine import Shape
from wnn2hdl.raster import Reading

REFERENCE_WINDOW_M = 95.0
"""The reference searched windows of 599x599 pixels for frames of 219x219, at half a metre per pixel."""

LEAST_FRAMES = 4
"""Even if 3 frames are all right, it does not follow that a fix is right in 95 % of cases."""


class CalibrationType(click.ParamType[int | Path]):
    """How many frames of the flight, or a file with the poses of some."""

    name = "N|POSES.csv"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> int | Path:
        """The count, or the file."""
        text = str(value)
        if text.isdecimal():
            if int(text) < LEAST_FRAMES:
                self.fail(
                    f"{text} frames are too few to calibrate on; give at least {LEAST_FRAMES}", param, ctx
                )
            return int(text)
        if not text.endswith(".csv"):
            self.fail(f"{text!r} is neither a count nor a CSV of poses", param, ctx)
        return Path(text)


class MethodsType(click.ParamType[tuple[str, ...]]):
    """Keys of methods, by commas."""

    name = "METHOD,..."

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[str, ...]:
        """The keys."""
        if isinstance(value, tuple):
            return value
        keys = [key.strip() for key in str(value).split(",")]
        every = (*METHODS, *ENGINE_METHODS)
        unknown = [key for key in keys if key not in every]
        if unknown:
            self.fail(f"{unknown[0]!r} is not one of {', '.join(every)}", param, ctx)
        return tuple(keys)


SECTIONS = {
    "Flight": ("--map", *READING, "--frames", "--poses", "--camera", "--focal"),
    "Search": (
        "--methods",
        "--template",
        "--segment",
        "--search",
        "--window",
        "--heading-tolerance",
        "--height-tolerance",
    ),
    "Calibration": ("--calibrate", "--calibrate-frames", "--calibration"),
}


@app.command("locate", sections=SECTIONS)
@click.option("--map", "map_file", type=file, help="Search this GeoTIFF of the country flown over.")
@reading_options
@click.option("--frames", type=folder, help="Read the camera's frames from this folder.")
@click.option("--poses", "poses_file", type=file, help="Read the frames' logged poses from this CSV file.")
@click.option("--camera", "camera_file", type=file, help="Read the camera from this TOML file.")
@click.option("--focal", type=FiniteRange(1, 1e6), metavar="PIXELS", help="Set the focal length.")
@click.option(
    "--calibrate",
    "calibrate",
    type=CalibrationType(),
    help="Fit camera, edges and confidence on N frames, or on a CSV's, which are not scored.",
)
@click.option(
    "--calibrate-frames",
    type=folder,
    help="Find the CSV's frames here.  [default: --frames]",
)
@click.option(
    "--calibration",
    "calibration_file",
    type=file,
    help="Use an earlier run's calibration.json.",
)
@click.option(
    "--methods",
    type=MethodsType(),
    default=METHODS,
    help="Compare these methods.  [default: all but match engines]",
)
@click.option("--template", type=SizeType(), help="Let a match engine take this much of a frame.")
@click.option("--segment", type=SizeType(), help="Let it look for it in this much of the map.")
@click.option(
    "--search",
    type=click.Choice(["window", "map", "both"]),
    default="both",
    show_default=True,
    help="Search windows, the whole map, or both.",
)
@click.option(
    "--window",
    "window_m",
    type=FiniteRange(1, 100_000),
    default=REFERENCE_WINDOW_M,
    show_default=True,
    metavar="METRES",
    help="Search this far to each side.",
)
@click.option(
    "--heading-tolerance",
    "heading_deg",
    type=FiniteRange(0, 180),
    metavar="DEGREES",
    help="Try headings up to this far off.",
)
@click.option(
    "--height-tolerance",
    "height_percent",
    type=FiniteRange(0, 50),
    metavar="PERCENT",
    default=0,
    show_default=True,
    help="Try heights up to this far off.",
)
@jobs_option("frames")
@seed_option
@output_option("Write into this folder.", default=Path("build/flight"), show_default=True)
@json_option
def locate_command(
    map_file: Path | None,
    reading: Reading,
    frames: Path | None,
    poses_file: Path | None,
    camera_file: Path | None,
    focal: float | None,
    calibrate: int | Path | None,
    calibrate_frames: Path | None,
    calibration_file: Path | None,
    methods: tuple[str, ...],
    template: Shape | None,
    segment: Shape | None,
    search: str,
    window_m: float,
    heading_deg: float | None,
    height_percent: float,
    jobs: int | None,
    seed: int,
    output: Path,
    as_json: bool,
) -> None:
    """Locate the frames of a flight on a map, by several methods side by side.

    Without --map, a small synthetic flight is located. A window around the logged position bounds the error:
    with the default of 95 m, no error can exceed 134 m, and a blind guess would be 73 m off on average.
    Searching the whole map has no such help and needs no position in the poses; without one, a frame is
    located and no error is reported.

    \b
    Examples:
      wnn2hdl locate --map map.tif --frames FRAMES --poses poses.csv --focal 750 --calibrate 10
      wnn2hdl locate --map map.tif --frames NEW --poses new.csv --focal 750 --search map \\
        --calibration build/flight/calibration.json
    """
    # Not at the top: they load what other commands need not wait for.
    from wnn2hdl.api import locate
    from wnn2hdl.apps.navigation.learned import Learned
    from wnn2hdl.apps.navigation.output import flight_markdown
    from wnn2hdl.apps.navigation.summary import summary, write_run

    given = {"--map": map_file, "--frames": frames, "--poses": poses_file}
    if calibration_file and calibrate:
        raise InputError(
            "--calibration takes what an earlier --calibrate learned",
            value=calibration_file,
            hint="give one of them",
        )
    if calibrate_frames and not isinstance(calibrate, Path):
        raise InputError(
            "--calibrate-frames goes with a CSV file in --calibrate", value=calibrate_frames, hint="give both"
        )
    # Before the frames are read, so that wrong sizes are told at once.
    engine = engine_of(template, segment, methods)
    known = Learned.read(calibration_file) if calibration_file else None
    with output_folder(output, "flight"), progress() as report:
        fitted: tuple[Pose, ...] = ()
        if map_file and frames and poses_file:
            scored = read_flight_poses(poses_file)
            if known:
                scored = unseen(scored, known.poses)
            elif isinstance(calibrate, Path):
                scored, fitted = _divided(scored, calibrate, calibrate_frames)
            files = frame_files(scored, frames) | frame_files(fitted, calibrate_frames or frames)
            flown = Recording.of_files(map_file, files, _camera(camera_file, focal), reading).scoring(scored)
        else:
            _refuse_halves(given, {"--camera": camera_file, "--focal": focal})
            if reading != Reading():
                raise InputError("--bands, --scale and --alpha are for a map from a file", hint="give --map")
            if isinstance(calibrate, Path):
                raise InputError(
                    "the embedded flight has no file of poses",
                    value=calibrate,
                    hint="give a count to --calibrate",
                )
            report("flight", 0, 1)
            flown = Recording.embedded(seed)
            report("flight", 1, 1)
        run = locate(
            flown,
            calibrate=known or (calibrate if isinstance(calibrate, int) else fitted),
            methods=methods,
            engine=None if engine is None else (engine.template, engine.segment),
            window_m=None if search == "map" else window_m,
            whole_map=search != "window",
            heading_deg=heading_deg,
            height_share=height_percent / 100,
            jobs=jobs,
            progress=report,
        ).run
        written = write_run(run, output)
    data = summary(run) | {"files": [str(path) for path in written]}
    emit(data, f"{flight_markdown(run.result)}\nwritten to {output}", as_json=as_json)


def _divided(
    poses: tuple[Pose, ...], calibration: Path, elsewhere: Path | None
) -> tuple[tuple[Pose, ...], tuple[Pose, ...]]:
    """Poses that are scored, and those of a file that calibrate, whose frames may lie in another folder."""
    calibrating = read_flight_poses(calibration)
    names = {pose.frame for pose in calibrating}
    # Cameras start to count again on each flight: in another folder, a name may be another frame's.
    scored = tuple(
        pose for pose in poses if pose not in calibrating and (elsewhere or pose.frame not in names)
    )
    if not scored:
        raise InputError(
            "no frame is left to score", value=calibration, hint="calibrate on other frames than --poses has"
        )
    return scored, calibrating


def _camera(path: Path | None, focal: float | None) -> Camera | float:
    if path and focal:
        raise InputError("--camera and --focal both give the focal length", hint="give one of them")
    if path:
        return Camera.read(path)
    if focal:
        return focal
    raise InputError("the camera is not known", hint="give --camera CAMERA.toml or --focal PIXELS")


def _refuse_halves(given: Mapping[str, Path | None], own: Mapping[str, object]) -> None:
    """Refuse part of a flight's options; none at all is the embedded flight."""
    missing = [name for name, value in given.items() if value is None]
    if len(missing) < len(given):
        raise InputError(
            "these options go together", value=", ".join(given), hint=f"give {', '.join(missing)}"
        )
    given_own = [name for name, value in own.items() if value is not None]
    if given_own:
        raise InputError(
            "the embedded flight has its own camera and map",
            value=" ".join(given_own),
            hint=f"leave it out, or give {missing[0]}",
        )
