"""Where the UAV was and how it was turned at each frame, as its log says."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from wnn2hdl.apps.navigation.counter import in_order
from wnn2hdl.apps.navigation.pose_table import POSITION, number, read_rows
from wnn2hdl.errors import InputError

_RANGES = {
    "latitude_deg": (-90.0, 90.0),
    "longitude_deg": (-180.0, 180.0),
    "height_above_ground_m": (0.1, 100_000.0),
    "yaw_deg": (-360.0, 360.0),
    "pitch_deg": (-90.0, 90.0),
    "roll_deg": (-180.0, 180.0),
}


@dataclass(frozen=True)
class Pose:
    """One frame's position and attitude.

    The angles turn the body's axes (forward, right, down) against north, east and down, in the order yaw,
    pitch, roll about the turned axes.

    Attributes:
        frame: name of the frame's file.
        latitude_deg: WGS 84, north positive; NaN if not known.
        longitude_deg: WGS 84, east positive; NaN if not known.
        height_m: above the ground, metres.
        yaw_deg: heading, clockwise from north: 90 flies east.
        pitch_deg: nose up positive.
        roll_deg: right side down positive.
    """

    frame: str
    latitude_deg: float
    longitude_deg: float
    height_m: float
    yaw_deg: float
    pitch_deg: float = 0.0
    roll_deg: float = 0.0

    @property
    def located(self) -> bool:
        """Whether it is known where the frame was taken."""
        return not math.isnan(self.latitude_deg)


def read_poses(path: Path) -> tuple[Pose, ...]:
    """Read a CSV with the columns `pose_table.COLUMNS`, one line per frame; the position's may be missing.

    Returns:
        The poses in the order of flight, by `counter.in_order`.

    Raises:
        InputError: as of `pose_table.read_rows` and `counter.in_order`; the file has no lines; a value is no
            number or out of range; a frame occurs twice.
    """
    poses = [_pose(row, where) for where, row in read_rows(path)]
    if not poses:
        raise InputError("no poses", value=path, hint="give one line per frame")
    seen: set[str] = set()
    for pose in poses:
        if pose.frame in seen:
            raise InputError(
                f"a frame occurs twice in {path}", value=pose.frame, hint="keep one of its lines"
            )
        seen.add(pose.frame)
    return tuple(poses[index] for index in in_order([pose.frame for pose in poses]))


def require_located(poses: Sequence[Pose], why: str, hint: str) -> None:
    """Raise InputError, which says why and what to do, unless it is known where all frames were taken."""
    for pose in poses:
        if not pose.located:
            raise InputError(f"{why}, and a frame has none", value=pose.frame, hint=hint)


def frame_files(poses: Sequence[Pose], folder: Path) -> dict[Pose, Path]:
    """The file of each pose's frame.

    Raises:
        InputError: one of them does not exist, or its name is a path.
    """
    files = {pose: folder / pose.frame for pose in poses}
    for pose, file in files.items():
        if Path(pose.frame).name != pose.frame:
            raise InputError(
                "a frame's name is a path", value=pose.frame, hint=f"give the names of files in {folder}"
            )
        if not file.is_file():
            raise InputError(
                "a frame of the poses is missing", value=file, hint="put it there or drop its line"
            )
    return files


def _pose(row: dict[str, str], where: str) -> Pose:
    if not row["frame"]:
        raise InputError("a frame without a name", value=where)
    unlocated = not any(row.get(name) for name in POSITION)
    numbers = {
        name: math.nan if unlocated and name in POSITION else number(row[name], name, where)
        for name in _RANGES
    }
    for name, (low, high) in _RANGES.items():
        if not unlocated or name not in POSITION:
            inside = math.isfinite(numbers[name]) and low <= numbers[name] <= high
            if not inside:
                raise InputError(
                    f"{where}: {name} is not within {low:g} to {high:g}",
                    value=row[name],
                    hint=_meant(name, numbers),
                )
    if numbers["latitude_deg"] == numbers["longitude_deg"] == 0:
        raise InputError(
            f"{where}: latitude and longitude are both 0, as loggers write where they have no position",
            hint="leave the two cells empty where the position is not known",
        )
    return Pose(row["frame"], *numbers.values())


def _meant(name: str, numbers: dict[str, float]) -> str:
    """What a number out of range probably is."""
    latitude, longitude = (numbers[axis] for axis in POSITION)
    if name == "latitude_deg" and abs(latitude) <= 180 and abs(longitude) <= 90:
        return "latitude and longitude are probably swapped"
    if name == "longitude_deg" and 180 < longitude <= 360:
        return f"longitudes in the west are negative: {longitude - 360:g}"
    if name == "height_above_ground_m":
        return "give metres above the ground, not above sea level or the place of the start"
    return ""
