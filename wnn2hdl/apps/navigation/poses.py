"""Where the UAV was and how it was turned at each frame, as its log says."""

import csv
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from wnn2hdl.errors import InputError

COLUMNS = (
    "frame",
    "latitude_deg",
    "longitude_deg",
    "height_above_ground_m",
    "yaw_deg",
    "pitch_deg",
    "roll_deg",
)
"""The columns of a file of poses; others are left out. Where a position is not known, its two are empty."""

_POSITION = ("latitude_deg", "longitude_deg")

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
        latitude_deg: WGS 84, north positive; NaN where nobody knows, likewise the longitude.
        longitude_deg: WGS 84, east positive.
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
    """Read a CSV with the columns `COLUMNS`, in any order, one line a frame; those of the position may lack.

    Returns:
        The poses in the order of flight: by `frame_numbers`, or the file's order where names do not tell.

    Raises:
        InputError: the file cannot be read, has no lines or lacks a column; a value is no number or out of
            range; a frame occurs twice.
    """
    try:
        with path.open(newline="", encoding="utf-8-sig") as stream:
            reader = csv.DictReader(stream)
            there = {*(reader.fieldnames or ())}
            needed = [name for name in COLUMNS if name not in _POSITION or there & {*_POSITION}]
            missing = [name for name in needed if name not in there]
            if missing:
                raise InputError(
                    f"the poses {path} lack a column",
                    value=", ".join(missing),
                    hint=f"the first line names {','.join(needed)}",
                )
            poses = tuple(_pose(row, f"line {reader.line_num} of {path}") for row in reader)
    except OSError as error:
        raise InputError("cannot read the poses", value=f"{path} ({error.strerror})") from error
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError("the poses are no CSV", value=f"{path} ({error})") from error
    if not poses:
        raise InputError("no poses", value=path, hint="give one line a frame")
    seen: set[str] = set()
    for pose in poses:
        if pose.frame in seen:
            raise InputError(
                f"a frame occurs twice in {path}", value=pose.frame, hint="keep one of its lines"
            )
        seen.add(pose.frame)
    numbers = frame_numbers([pose.frame for pose in poses])
    if numbers is None:
        return poses
    return tuple(pose for _, pose in sorted(zip(numbers, poses, strict=True), key=lambda pair: pair[0]))


def frame_numbers(names: Sequence[str]) -> list[int] | None:
    """The numbers at the end of frames' names, as cameras and video tools count them: ``IMG_0447.jpg``.

    Returns:
        a number for each name; None unless each has one of its own and the same text before it.
    """
    found = [re.fullmatch(r"(.*?)(\d+)(\.[^.]*)?", name) for name in names]
    parts = [(match[1], int(match[2])) for match in found if match is not None]
    told = len(parts) == len(names) == len({*parts}) and len({text for text, _ in parts}) == 1
    return [number for _, number in parts] if told else None


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
    numbers = []
    unlocated = not any(row.get(name) for name in _POSITION)
    for name, (low, high) in _RANGES.items():
        if unlocated and name in _POSITION:
            numbers.append(math.nan)
            continue
        text = row[name]
        try:
            number = float(text)
        except (ValueError, TypeError):
            raise InputError(f"{where}: {name} is no number", value=repr(text)) from None
        if not (math.isfinite(number) and low <= number <= high):
            raise InputError(f"{where}: {name} is not within {low:g} to {high:g}", value=text)
        numbers.append(number)
    return Pose(row["frame"], *numbers)
