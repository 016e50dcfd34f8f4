"""A small rendered flight, located once for all tests of it."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.apps.navigation.camera import Camera
from wnn2hdl.apps.navigation.flight import FlightRun, run_flight
from wnn2hdl.apps.navigation.learned import Learned
from wnn2hdl.apps.navigation.methods import METHODS
from wnn2hdl.apps.navigation.poses import Pose
from wnn2hdl.apps.navigation.recording import Recording, poses_of, split
from wnn2hdl.apps.navigation.results import SearchKind
from wnn2hdl.apps.navigation.world import WorldMap
from wnn2hdl.samples.flight import make_flight


@dataclass
class Flying:
    """Seven frames, of which four calibrate a camera whose tilt is not known.

    Attributes:
        steps: the progress that was reported.
        threads: that OpenCV may use, whenever a frame is read.
    """

    steps: list[tuple[str, int, int]] = field(default_factory=list)
    threads: list[int] = field(default_factory=list)

    def __call__(
        self,
        searches: Mapping[SearchKind, float | None],
        aside_deg: float = 0,
        known: Learned | None = None,
        keys: Collection[str] = METHODS,
    ) -> FlightRun:
        """Locate them by some methods; logged positions of those that are scored are this many degrees aside.

        What is known already is not calibrated.
        """
        flight = make_flight(
            4,
            (600, 600),
            frames=7,
            frame_size=(150, 260),
            height_m=60,
            tilt_deg=7,
            spacing_m=20,
            gusts_deg=1.5,
        )
        poses = poses_of(flight)
        calibrating, scored = split(poses, 4)
        scored = tuple(replace(pose, latitude_deg=pose.latitude_deg + aside_deg) for pose in scored)
        numbers = {pose.frame: number for number, pose in enumerate(poses)}

        def read(pose: Pose) -> NDArray[np.uint8]:
            self.threads.append(cv2.getNumThreads())
            return flight.frame(numbers[pose.frame])

        recording = Recording(
            "rendered",
            WorldMap.of_array(flight.map_image, flight.transform, f"EPSG:{flight.epsg}"),
            Camera.of_focal(flight.camera.focal_px, 260, 150),
            scored,
            read,
        )
        return run_flight(
            recording,
            known or calibrating,
            searches,
            lambda *step: self.steps.append(step),
            keys=keys,
            jobs=2,
        )


@pytest.fixture(scope="session")
def flying() -> Flying:
    return Flying()


@pytest.fixture(scope="session")
def run(flying: Flying) -> FlightRun:
    return flying({"window": 40.0, "map": None})
