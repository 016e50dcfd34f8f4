"""Calibration frames looked for around where they were."""

import numpy as np
import pytest

from wnn2hdl.apps.navigation.camera import Camera
from wnn2hdl.apps.navigation.matching import MapIndex
from wnn2hdl.apps.navigation.recording import poses_of
from wnn2hdl.apps.navigation.sights import Lookout, steps
from wnn2hdl.apps.navigation.world import WorldMap
from wnn2hdl.edges import grey
from wnn2hdl.samples.flight import make_flight


def test_a_tilt_shows_as_a_distance_ahead() -> None:
    flight = make_flight(
        3, (500, 500), frames=2, frame_size=(120, 200), height_m=60, tilt_deg=9, spacing_m=20, gusts_deg=0
    )
    grid = WorldMap.of_array(flight.map_image, flight.transform, f"EPSG:{flight.epsg}").resampled(1.0)
    looked: list[None] = []
    lookout = Lookout(
        grid,
        MapIndex(grey(grid.image), grid.valid),
        [grey(flight.frame(number)) for number in range(2)],
        poses_of(flight),
        lambda: looked.append(None),
    )
    level = Camera.of_focal(flight.camera.focal_px, 200, 120)
    for sight in lookout.sights([level] * 2, (-6.0, 0.0, 6.0)):
        assert sight is not None
        assert sight.ahead_m == pytest.approx(60 * np.tan(np.radians(9)), abs=2)
        assert sight.right_m == pytest.approx(0, abs=2)
        assert sight.heading_error_deg == 0
    assert len(looked) == 2


def test_steps_are_counted_and_never_beyond_their_number() -> None:
    reported: list[tuple[str, int, int]] = []
    done = steps(lambda *step: reported.append(step), "calibration", 2)
    for _ in range(3):
        done()
    assert reported == [("calibration", count, 2) for count in (0, 1, 2, 2)]
