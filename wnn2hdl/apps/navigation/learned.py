"""What is learned from calibration frames, kept in ``calibration.json`` and read back for similar flights."""

import math
from collections.abc import Collection, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Self, get_args

from wnn2hdl.apps.navigation.calibrate import Calibration, Fit
from wnn2hdl.apps.navigation.camera import Camera
from wnn2hdl.apps.navigation.matching import Acceptance
from wnn2hdl.apps.navigation.methods import ENGINE_METHODS
from wnn2hdl.apps.navigation.navigator import Place, PoseTolerance
from wnn2hdl.apps.navigation.poses import Pose
from wnn2hdl.apps.navigation.results import SearchKind
from wnn2hdl.apps.navigation.weightless import WeightlessEdges
from wnn2hdl.apps.navigation.world import WorldMap
from wnn2hdl.errors import InputError, ModelFileError
from wnn2hdl.files import read_json, write_json
from wnn2hdl.ir.engine import EngineFormat

VERSION = 1
"""Of the form of ``calibration.json``; a file of another one is refused."""


@dataclass(frozen=True)
class Conditions:
    """What a calibration holds for.

    Attributes:
        map: SHA-256 of the map: its pixels and where they lie.
        camera: as given, before it was fitted.
        tolerance: how far the log may be off.
        engine: that methods answer as; None if none of them does.
    """

    map: str
    camera: Camera
    tolerance: PoseTolerance
    engine: EngineFormat | None = None

    @classmethod
    def of(
        cls, world: WorldMap, camera: Camera, tolerance: PoseTolerance, engine: EngineFormat | None
    ) -> Self:
        """The conditions of a flight."""
        return cls(world.digest(), camera, tolerance, engine)


@dataclass(frozen=True)
class Learned:
    """All that was learned from calibration frames.

    Attributes:
        conditions: under which.
        poses: of the frames.
        calibration: the camera, fitted.
        weightless: the edges.
        windows: of each search, half its side in metres; None for the whole map.
        acceptances: of each search and method, from which confidence on a fix is given.
    """

    conditions: Conditions
    poses: tuple[Pose, ...]
    calibration: Calibration
    weightless: WeightlessEdges
    windows: Mapping[SearchKind, float | None]
    acceptances: Mapping[Place, Acceptance]

    def write(self, path: Path) -> None:
        """Write ``calibration.json``.

        Raises:
            InputError: the file cannot be written.
        """
        known = self.calibration
        data = {
            "version": VERSION,
            "conditions": asdict(self.conditions),
            **known.report(),
            "poses": [list(asdict(pose).values()) for pose in self.poses],
            "cameras": [asdict(camera) for camera in known.cameras],
            "weightless": self.weightless.to_json(),
            "searches": {
                kind: {
                    "half_width_m": half,
                    "methods": {
                        method: asdict(acceptance)
                        # JSON has no infinity: null stands for a threshold that nothing reaches.
                        | {"threshold": acceptance.threshold if math.isfinite(acceptance.threshold) else None}
                        for (search, method), acceptance in self.acceptances.items()
                        if search == kind
                    },
                }
                for kind, half in self.windows.items()
            },
        }
        write_json(path, data)

    @classmethod
    def read(cls, path: Path) -> Self:
        """The inverse of `write`.

        Raises:
            InputError: the file cannot be read, or is not a calibration of this version.
        """
        data = read_json(path, "a calibration")
        if data.get("version") != VERSION or "searches" not in data:
            raise ModelFileError(
                "not a calibration of this version",
                value=path,
                hint=f"calibrate again with --calibrate: version {VERSION} is read",
            )
        try:
            return cls._of_json(data, path)
        except (KeyError, TypeError, ValueError, AttributeError, InputError) as error:
            raise ModelFileError(
                "the calibration is damaged", value=f"{path} ({error})", hint="calibrate again"
            ) from error

    @classmethod
    def _of_json(cls, data: dict[str, Any], path: Path) -> Self:
        given = data["conditions"]
        tolerance = {name: _number(given["tolerance"][name]) for name in ("heading_deg", "scale")}
        poses = tuple(Pose(_text(name), *map(_number, numbers)) for name, *numbers in data["poses"])
        cameras = tuple(Camera.of_table(table, path) for table in data["cameras"])
        if not len(poses) == len(cameras) > 0:
            raise ValueError(f"{len(cameras)} cameras of {len(poses)} frames")
        calibration = Calibration(
            tuple(pose.frame for pose in poses),
            cameras,
            _number(data["heading_search_deg"]),
            _fit(data["before"]),
            _fit(data["after"]),
        )
        windows: dict[SearchKind, float | None] = {}
        acceptances: dict[Place, Acceptance] = {}
        for kind in get_args(SearchKind):
            if (search := data["searches"].get(kind)) is None:
                continue
            half = search["half_width_m"]
            windows[kind] = None if half is None else _number(half)
            for method, fields in search["methods"].items():
                threshold = math.inf if fields["threshold"] is None else fields["threshold"]
                numbers = {
                    name: _number(value) for name, value in (fields | {"threshold": threshold}).items()
                }
                acceptances[kind, method] = Acceptance(**numbers)
        return cls(
            Conditions(
                _text(given["map"]),
                Camera.of_table(given["camera"], path),
                PoseTolerance(**tolerance),
                EngineFormat.from_json(given["engine"]) if given.get("engine") else None,
            ),
            poses,
            calibration,
            WeightlessEdges.from_json(data["weightless"]),
            windows,
            acceptances,
        )

    def require(
        self,
        conditions: Conditions,
        windows: Mapping[SearchKind, float | None],
        methods: Collection[str],
    ) -> None:
        """Refuse to be used under other conditions.

        Args:
            conditions: of the flight at hand.
            windows: its searches, as `windows`.
            methods: keys of its methods.

        Raises:
            InputError: something differs, or was not calibrated.
        """
        known = self.conditions
        if known.map != conditions.map:
            raise InputError("the calibration belongs to another map", hint="calibrate on this one")
        pairs = {
            name: (value, getattr(conditions.camera, name)) for name, value in vars(known.camera).items()
        }
        pairs["--heading-tolerance"] = (known.tolerance.heading_deg, conditions.tolerance.heading_deg)
        pairs["--height-tolerance"] = (known.tolerance.scale * 100, conditions.tolerance.scale * 100)
        if any(method in ENGINE_METHODS for method in methods):
            for size in ("template", "segment"):
                pairs[f"--{size}"] = _size(known.engine, size), _size(conditions.engine, size)
        for kind, half in windows.items():
            if kind not in self.windows:
                raise InputError(
                    "the calibration has no thresholds for this search",
                    value=kind,
                    hint="calibrate with the same --search",
                )
            if half is not None:
                pairs["--window"] = (self.windows[kind], half)
        for name, (before, now) in pairs.items():
            if before != now:
                raise InputError(
                    "the calibration belongs to other conditions",
                    value=f"{name} was {before}, and now is {now}",
                    hint="give the same as when it was made, or calibrate again",
                )
        missing = [method for method in methods for kind in windows if (kind, method) not in self.acceptances]
        if missing:
            raise InputError(
                "the calibration has no threshold for a method",
                value=missing[0],
                hint="leave it out with --methods, or calibrate with it",
            )


def _size(engine: EngineFormat | None, name: str) -> str:
    return "none" if engine is None else "x".join(map(str, getattr(engine, name)))


def _fit(fields: dict[str, Any]) -> Fit:
    numbers = {name: _number(value) for name, value in fields.items()}
    return Fit(matched=int(numbers.pop("matched")), **numbers)


def _number(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise TypeError(f"{value!r} is not a number")
    return value


def _text(value: object) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{value!r} is not a text")
    return value
