"""Which convention a log is in, found by frames of a generated flight that calibrate."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import pytest

from wnn2hdl.apps.navigation.camera import Camera
from wnn2hdl.apps.navigation.explain import require_fit, require_stated_meaning
from wnn2hdl.apps.navigation.matching import MapIndex
from wnn2hdl.apps.navigation.poses import Pose
from wnn2hdl.apps.navigation.recording import poses_of
from wnn2hdl.apps.navigation.sights import Lookout, Sight
from wnn2hdl.apps.navigation.world import WorldMap
from wnn2hdl.edges import grey
from wnn2hdl.errors import InputError
from wnn2hdl.samples.flight import make_flight

Log = Callable[[Pose], Pose]
Explained = Callable[..., list[tuple[str, int, int]]]


@pytest.fixture(scope="module")
def explained() -> Explained:
    """Checks a log of six frames, each rewritten; gives the progress."""
    flight = make_flight(
        7, (900, 900), frames=6, frame_size=(150, 260), height_m=80, tilt_deg=7, spacing_m=45, gusts_deg=4
    )
    world = WorldMap.of_array(flight.map_image, flight.transform, f"EPSG:{flight.epsg}")
    grid = world.resampled(1.0)
    frames = [grey(flight.frame(number)) for number in range(6)]
    index = MapIndex(grey(grid.image), grid.valid)
    given = Camera.of_focal(flight.camera.focal_px, 260, 150)

    def check(log: Log = lambda pose: pose, camera: Camera = given) -> list[tuple[str, int, int]]:
        reported: list[tuple[str, int, int]] = []
        lookout = Lookout(grid, index, frames, [log(pose) for pose in poses_of(flight)], lambda: None)
        require_stated_meaning(lookout, camera, lambda *step: reported.append(step))
        return reported

    return check


def test_a_good_log_is_taken_with_progress(explained: Explained) -> None:
    reported = explained()
    done = [step[1] for step in reported]
    assert done == sorted(done)
    assert reported[-1][1] == reported[-1][2]


@pytest.mark.parametrize(
    ("log", "named"),
    [
        (lambda pose: replace(pose, yaw_deg=-pose.yaw_deg), "yaw_deg counts counter-clockwise from north"),
        (lambda pose: replace(pose, yaw_deg=90 - pose.yaw_deg), "counter-clockwise from east"),
        (lambda pose: replace(pose, yaw_deg=pose.yaw_deg - 180), "twist_deg = 180"),
        (lambda pose: replace(pose, yaw_deg=pose.yaw_deg + 90), "twist_deg = -90"),
        (
            lambda pose: replace(pose, height_m=pose.height_m + 110),
            "is above sea level",
        ),
        (lambda pose: replace(pose, height_m=pose.height_m / 0.3048), "is in feet"),
        (
            lambda pose: replace(
                pose,
                yaw_deg=math.radians(pose.yaw_deg),
                pitch_deg=math.radians(pose.pitch_deg),
                roll_deg=math.radians(pose.roll_deg),
            ),
            "in radians",
        ),
    ],
    ids=["counter-clockwise", "from east", "backwards", "sideways", "sea level", "feet", "radians"],
)
def test_another_convention_is_named(explained: Explained, log: Log, named: str) -> None:
    with pytest.raises(InputError) as caught:
        explained(log)
    assert named in caught.value.line()
    assert "to judge by the calibration frames" in caught.value.line()


def test_the_focal_length_of_larger_frames_is_named(
    explained: Explained,
) -> None:
    with pytest.raises(InputError, match="the focal length that of larger frames"):
        explained(camera=Camera.of_focal(195 * 2, 260, 150))


def test_a_fit_needs_half_of_the_frames_near_the_truth() -> None:
    near, far = Sight(3, 4, 0, 0.6, 5), Sight(30, 4, 0, 0.6, 5)
    frames: Sequence[Sight | None] = [near, near, far, None]
    require_fit(frames)
    with pytest.raises(InputError, match=r"do not fit the map.*: 1 of 3 match within 20 m"):
        require_fit(frames[1:])
