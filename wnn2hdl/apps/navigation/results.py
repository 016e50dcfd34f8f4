"""What a flight came to: the fix of each frame, a method's figures over its frames, and all of a run."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

SearchKind = Literal["window", "map"]

FAR_M = 100.0
"""From this great-circle error on, in metres, a position counts as a false positive, as in the reference."""

FIGURES = (
    "mean_m",
    "std_m",
    "variance_m2",
    "median_m",
    "false_positive_percent",
    "true_positive_percent",
    "fixed_percent",
    "fixed_mean_m",
    "fixed_true_percent",
    "mean_seconds",
)
"""Properties of `MethodResult` in tables and JSON; those of ``fixed_…`` are of the fixes that are given."""


@dataclass(frozen=True)
class FrameFix:
    """Where one method saw one frame.

    Attributes:
        frame: name of the frame's file.
        truth_latitude: degrees, where the UAV was; None if not known.
        truth_longitude: degrees, or None together with ``truth_latitude``.
        latitude: degrees, where the method puts it; None if the method has no position at all to offer
            (the frame shows nothing to match, or a filter has not started).
        longitude: degrees, or None together with ``latitude``.
        error_m: metres between the two by great circle; None without either position.
        geodesic_error_m: the same on the ellipsoid.
        confidence: the method's own measure; compare it within a method only.
        fixed: whether the confidence suffices to give the position out as a fix.
        seconds: processor time for this frame, reading its file not counted.
    """

    frame: str
    truth_latitude: float | None
    truth_longitude: float | None
    latitude: float | None
    longitude: float | None
    error_m: float | None
    geodesic_error_m: float | None
    confidence: float
    fixed: bool
    seconds: float


@dataclass(frozen=True)
class MethodResult:
    """One method over all frames that were scored.

    The reference gives a position for every frame, so its five figures (mean, standard deviation, variance
    and the two shares at `FAR_M`) are taken here over all frames with a position, confident or not. The
    figures of the fixes show what the confidence is worth.

    Attributes:
        name: as the tables show it, "perspective + Canny".
        fixes: one per frame, in the order of the flight.
        tracked: whether a filter over the track made them of the method's own.
        weightless: whether the method is the project's own, the weightless edges.
    """

    name: str
    fixes: tuple[FrameFix, ...]
    tracked: bool = False
    weightless: bool = False

    @property
    def errors_m(self) -> tuple[float, ...]:
        """Great-circle errors of all frames with a position, confident or not."""
        return tuple(fix.error_m for fix in self.fixes if fix.error_m is not None)

    @property
    def fixed_errors_m(self) -> tuple[float, ...]:
        """Great-circle errors of the fixes that were given."""
        return tuple(fix.error_m for fix in self.fixes if fix.fixed and fix.error_m is not None)

    @property
    def mean_m(self) -> float | None:
        """Mean error; None without any position."""
        return _mean(self.errors_m)

    @property
    def variance_m2(self) -> float | None:
        """Population variance of the errors: the mean square deviation, divided by their number."""
        mean = self.mean_m
        return None if mean is None else _mean([(error - mean) ** 2 for error in self.errors_m])

    @property
    def std_m(self) -> float | None:
        """Population standard deviation: the root of `variance_m2`."""
        variance = self.variance_m2
        return None if variance is None else math.sqrt(variance)

    @property
    def median_m(self) -> float | None:
        """Median error: for an even number, the mean of the two in the middle."""
        ordered = sorted(self.errors_m)
        middle = len(ordered) // 2
        return _mean(ordered[middle : middle + 1] if len(ordered) % 2 else ordered[middle - 1 : middle + 1])

    @property
    def false_positive_percent(self) -> float | None:
        """Share of the positions that are `FAR_M` or more off."""
        return _percent([error >= FAR_M for error in self.errors_m])

    @property
    def true_positive_percent(self) -> float | None:
        """Share of the positions that are less than `FAR_M` off."""
        return _percent([error < FAR_M for error in self.errors_m])

    @property
    def fixed_percent(self) -> float | None:
        """Share of all frames for which a fix was given."""
        return _percent([fix.fixed for fix in self.fixes])

    @property
    def fixed_mean_m(self) -> float | None:
        """Mean error of the fixes that were given; None if there was none."""
        return _mean(self.fixed_errors_m)

    @property
    def fixed_true_percent(self) -> float | None:
        """Share of the fixes that were given and are less than `FAR_M` off; None if there was none."""
        return _percent([error < FAR_M for error in self.fixed_errors_m])

    @property
    def mean_seconds(self) -> float | None:
        """Mean processor time per frame."""
        return _mean([fix.seconds for fix in self.fixes])


@dataclass(frozen=True)
class SearchResult:
    """All methods under one way of searching.

    Attributes:
        kind: "window" searches a square around the true position, as the reference did, "map" the whole map.
        half_width_m: metres from the window's centre to its sides, the furthest a match may be moved along
            either axis; None for the whole map.
        methods: in the order of the tables.
    """

    kind: SearchKind
    half_width_m: float | None
    methods: tuple[MethodResult, ...]

    @property
    def key(self) -> str:
        """A name for files and tables: "map", or "window_95m"."""
        return "map" if self.half_width_m is None else f"window_{self.half_width_m:g}m"

    @property
    def beaten(self) -> str:
        """A sentence on what is nearer than the weightless edges; empty if they were not used, or nothing is.

        Only methods that judge each frame by itself are compared; a track's positions are another thing.
        """
        alone = [method for method in self.methods if not method.tracked and method.mean_m is not None]
        own = next((method for method in alone if method.weightless), None)
        if own is None or own.mean_m is None:
            return ""
        nearer = [method for method in alone if method.mean_m is not None and method.mean_m < own.mean_m]
        if not nearer:
            return ""
        named = ", ".join(f"{method.name} ({method.mean_m:.1f} m)" for method in nearer)
        verb = "is" if len(nearer) == 1 else "are"
        return f"On this flight {named} {verb} nearer on average than {own.name} ({own.mean_m:.1f} m)."

    @property
    def furthest_m(self) -> float | None:
        """The largest error a window around the truth allows: its half diagonal."""
        return None if self.half_width_m is None else math.sqrt(2) * self.half_width_m

    @property
    def blind_mean_m(self) -> float | None:
        """The mean error of a blind guess in such a window.

        A uniformly random point of a square of half side a lies a (√2 + asinh 1) / 3 = 0.765 a from its
        centre on average.
        """
        if self.half_width_m is None:
            return None
        return self.half_width_m * (math.sqrt(2) + math.asinh(1)) / 3


@dataclass(frozen=True)
class FlightResult:
    """A whole run.

    Attributes:
        map_name: file name of the map.
        ground_sample_distance_m: metres per pixel at which frames and map were compared.
        focal_px: focal length in pixels of the frames as given or fitted.
        tilts_deg: the camera's forward tilt as given, or as fitted for each stretch of the flight, degrees.
        calibrated_on: frames on which unknowns of the camera were fitted; empty if it was given.
        searches: the same methods, searched in one or two ways.
        map_note: what had to be assumed about the map's bands and pages; empty if nothing.
        map_share: share of the grid, which is north up, that the map shows, 0 to 1.
        read_back: whether the calibration is an earlier run's.
    """

    map_name: str
    ground_sample_distance_m: float
    focal_px: float
    tilts_deg: tuple[float, ...]
    calibrated_on: tuple[str, ...]
    searches: tuple[SearchResult, ...]
    map_note: str = ""
    map_share: float = 1.0
    read_back: bool = False

    @property
    def largest_geodesic_difference_m(self) -> float | None:
        """By how much, at most, the great-circle error of a position differs from the geodesic one."""
        differences = [
            abs(fix.error_m - fix.geodesic_error_m)
            for search in self.searches
            for method in search.methods
            for fix in method.fixes
            if fix.error_m is not None and fix.geodesic_error_m is not None
        ]
        return max(differences, default=None)


def _mean(values: Sequence[float]) -> float | None:
    return math.fsum(values) / len(values) if values else None


def _percent(hits: Sequence[bool]) -> float | None:
    return 100 * sum(hits) / len(hits) if hits else None
