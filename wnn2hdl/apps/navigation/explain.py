"""The convention of a log, found by laying out calibration frames as if it meant this or that.

With the right meaning, matches lie beside the truth by the same distance ahead and to the right, which the
camera's unknown tilt makes; with a wrong one they lie anywhere in the window that is searched. So meanings
are compared by how many frames agree, weighted by how far their matches stand out. A meaning other
than the stated one is never adopted, but named in the error.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from wnn2hdl.apps.navigation.camera import Camera
from wnn2hdl.apps.navigation.conventions import (
    COUNTER_CLOCKWISE,
    FROM_EAST,
    RADIANS,
    Convention,
    may_be_radians,
)
from wnn2hdl.apps.navigation.poses import Pose
from wnn2hdl.apps.navigation.sights import HEADINGS_DEG, Lookout, Sight, steps
from wnn2hdl.errors import InputError
from wnn2hdl.progress import Progress

AGREE_M = 20.0
"""Matches so near to one another agree. In a window of ±60 m two do by chance in 1 of 12 cases."""

MOST = 0.6
"""Share of the frames that have to agree, four at least, for a meaning to explain them."""

DECISIVE = 2.0
"""How many times better than the stated meaning another one has to explain the frames."""

_KNOWN_SCALE = 0.15
"""A focal length or height this share off is not another convention; calibration fits it."""

_SCALE_STEP = 1.15
"""Between heights that are tried; a match survives half of it."""

_SCALES = (0.15, 3.5)
_FEET = 0.3048


@dataclass(frozen=True)
class Evidence:
    """How well a meaning explains the frames.

    Attributes:
        agreeing: the most frames whose matches lie together.
        weight: the sum of their peaks' heights in standard deviations, which unlike the scores do not rise
            with smaller patches.
    """

    agreeing: int = 0
    weight: float = 0.0


def require_stated_meaning(lookout: Lookout, camera: Camera, progress: Progress) -> None:
    """Refuse a log and a camera that calibration frames contradict.

    What is stated is tried with a gimbal and without. Only if it does not explain most frames, other meanings
    are, first by the logged headings, then those of the headings by headings beside them, too.

    Args:
        lookout: the frames.
        camera: as given.
        progress: called with how many frames have been looked for.

    Raises:
        InputError: another meaning explains the frames decisively better.
    """
    frames = len(lookout.poses)
    headings, scales = _headings(lookout.poses), _scales(lookout.poses, camera)
    tried: list[tuple[tuple[float, ...], tuple[Convention, ...]]] = [
        ((0.0,), (*headings, *scales)),
        (HEADINGS_DEG, headings),
    ]
    most = frames * sum(2 + len(others) for _, others in tried)
    lookout = replace(lookout, looked=steps(progress, "conventions", most))
    for errors, others in tried:
        stated = max(
            (
                _evidence(lookout, replace(camera, stabilised=stabilised), errors)
                for stabilised in (False, True)
            ),
            key=lambda evidence: evidence.weight,
        )
        if stated.agreeing >= MOST * frames:
            break
        found = [
            (
                _evidence(
                    replace(lookout, poses=[other.read(pose) for pose in lookout.poses]), camera, errors
                ),
                other,
            )
            for other in others
        ]
        best, other = max(found, key=lambda pair: pair[0].weight)
        if best.agreeing >= max(4, MOST * frames) and best.weight >= DECISIVE * stated.weight:
            raise InputError(
                f"{other.fault}, to judge by the calibration frames",
                value=f"{best.agreeing} of {frames} agree with the map so, {stated.agreeing} as given",
                hint=other.hint,
            )
    progress("conventions", most, most)


def require_fit(sights: Sequence[Sight | None]) -> None:
    """Raise InputError unless half of the calibration frames match the map where they were, to `AGREE_M`."""
    near = sum(sight is not None and sight.miss_m <= AGREE_M for sight in sights)
    if near < len(sights) / 2:
        raise InputError(
            "the calibration frames do not fit the map, whatever the camera's mount",
            value=f"{near} of {len(sights)} match within {AGREE_M:g} m of where they were",
            hint="check headings (clockwise from north), heights (above the ground, in metres), focal length "
            "and the map's place, or calibrate on frames with more to see",
        )


def _headings(poses: Sequence[Pose]) -> tuple[Convention, ...]:
    """Other meanings of the angles."""
    mounts = (_mount("right", 90), _mount("back", 180), _mount("left", -90))
    signs = (
        Convention(
            "pitch_deg counts nose down",
            "give it nose up: with the other sign",
            lambda pose: replace(pose, pitch_deg=-pose.pitch_deg),
        ),
        Convention(
            "roll_deg counts left side down",
            "give it right side down: with the other sign",
            lambda pose: replace(pose, roll_deg=-pose.roll_deg),
        ),
    )
    radians = (RADIANS,) if may_be_radians(poses) else ()
    return (COUNTER_CLOCKWISE, FROM_EAST, *mounts, *signs, *radians)


def _mount(side: str, twist_deg: float) -> Convention:
    return Convention(
        f"the camera is mounted with image-up to the {side}",
        f"give --camera with twist_deg = {twist_deg:g}",
        lambda pose: replace(pose, yaw_deg=pose.yaw_deg + twist_deg),
    )


def _scales(poses: Sequence[Pose], camera: Camera) -> tuple[Convention, ...]:
    """Other heights, which other focal lengths come to."""
    low, high = np.log(_SCALES) / np.log(_SCALE_STEP)
    powers = range(int(np.ceil(low)), int(high) + 1)
    height = float(np.median([pose.height_m for pose in poses]))
    return tuple(
        _scale(float(_SCALE_STEP**power), height, camera.fx)
        for power in powers
        if abs(_SCALE_STEP**power - 1) > _KNOWN_SCALE
    )


def _scale(scale: float, height_m: float, focal_px: float) -> Convention:
    if abs(scale / _FEET - 1) <= _SCALE_STEP / 2 - 0.5:
        fault = "height_above_ground_m is in feet, or above sea level"
    elif scale < 1:
        fault = "height_above_ground_m is above sea level, or the focal length that of smaller frames"
    else:
        fault = "height_above_ground_m is too low, or the focal length that of larger frames"
    return Convention(
        fault,
        f"give metres above the ground (about {scale * height_m:.0f} instead of {height_m:.0f} fit), or the "
        f"focal length of these frames (about {focal_px / scale:.0f} pixels instead of {focal_px:.0f})",
        lambda pose: replace(pose, height_m=pose.height_m * scale),
    )


def _evidence(lookout: Lookout, camera: Camera, headings: Sequence[float]) -> Evidence:
    sights = []
    for number in range(len(lookout.poses)):
        try:
            sight = lookout.sight(number, camera, headings)
        except InputError:
            # Too much ground, or none: whatever such a pose means, the frame does not agree with it.
            lookout.looked()
            continue
        if sight is not None and sight.score > 0:
            sights.append(sight)
    places = np.array([(sight.ahead_m, sight.right_m) for sight in sights]).reshape(-1, 2)
    together = np.linalg.norm(places[:, None] - places, axis=-1) <= AGREE_M
    heights = np.array([sight.psr for sight in sights])
    return max(
        (Evidence(int(near.sum()), float(heights[near].sum())) for near in together),
        key=lambda evidence: evidence.weight,
        default=Evidence(),
    )
