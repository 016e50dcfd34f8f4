"""Pictures of a flight: errors by method, and the tracks on the map; the same results give the same bytes."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Self

import cv2
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.patheffects import withStroke
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.apps.navigation.results import FAR_M, FlightResult, FrameFix, MethodResult, SearchResult
from wnn2hdl.report.drawing import INK, mark
from wnn2hdl.report.plots import plot_style, save_plot

ToPixel = Callable[[ArrayLike, ArrayLike], tuple[NDArray[np.float64], NDArray[np.float64]]]
"""Rows and columns of a picture from latitudes and longitudes in degrees."""

COLOURS = ("#D55E00", "#56B4E9", "#F0E442", "#009E73", "#CC79A7", "#E69F00", "#0072B2")
"""Of the methods in their order; the colour-blind can distinguish them too (Okabe and Ito, 2008)."""

_MARKERS = "osD^vPX"

_WIDEST_PX = 1600
_LEAST_SIDE_M = 150.0
"""The map's picture is no finer and shows no less than this."""

_LEAST_ASPECT = 0.7
"""A straight track is shown with this much of its length beside it."""


@dataclass(frozen=True)
class Extent:
    """The part of a map that shows a flight, in pixels; ends are half open."""

    top: int
    bottom: int
    left: int
    right: int

    @classmethod
    def around(
        cls, methods: Sequence[MethodResult], shape: tuple[int, int], to_pixel: ToPixel, gsd_m: float
    ) -> Self:
        """All that is known of the truth, all positions, and something around them.

        Args:
            methods: at least one, with one frame whose truth or position is known.
            shape: rows and columns of the map.
            to_pixel: where positions lie in it.
            gsd_m: metres per pixel.
        """
        tracks = [_known(methods[0].fixes, to_pixel)]
        tracks += [_located(method.fixes, to_pixel)[:2] for method in methods]
        places = [np.concatenate([track[i] for track in tracks]) for i in (0, 1)]
        least = max(_LEAST_SIDE_M / gsd_m, _LEAST_ASPECT * max(float(np.ptp(side)) for side in places))
        return cls(*_span(places[0], shape[0], least), *_span(places[1], shape[1], least))


@plot_style()
def plot_errors(result: FlightResult, path: Path) -> tuple[Path, Path]:
    """Mean and standard deviation of each method's error, and each frame's error; one panel per search.

    Args:
        result: at least one search with one method.
        path: the picture without its suffix.

    Returns:
        The two files written, as by `save_plot`.

    Raises:
        InputError: the folder does not exist or cannot be written.
    """
    most = max(len(search.methods) for search in result.searches)
    figure = Figure(figsize=(1.2 + 4.2 * len(result.searches), 2.2 + 0.42 * most), layout="constrained")
    panels = figure.subplots(1, len(result.searches), squeeze=False)[0]
    for axes, search in zip(panels, result.searches, strict=True):
        _draw_errors(axes, search)
    legend = "bars: mean ± standard deviation; dots: frames; arrows: frames further off"
    figure.supxlabel(legend, fontsize="small")
    return save_plot(figure, path)


def _draw_errors(axes: Axes, search: SearchResult) -> None:
    far = 1.1 * FAR_M
    dots: list[tuple[float, float]] = []
    alone = sum(not method.tracked for method in search.methods)
    for place, method in enumerate(search.methods):
        if method.mean_m is None or method.std_m is None:
            continue
        # A track has the colour of the method it is made of.
        colour = COLOURS[(place - alone if method.tracked else place) % len(COLOURS)]
        hatch = "//" if method.tracked else ""
        (bar,) = axes.barh(place, method.mean_m, 0.6, color=colour, hatch=hatch, edgecolor=INK, linewidth=0.6)
        mark(bar, f"{method.name}: {_mean_and_std(method.mean_m, method.std_m)}")
        spread = [[min(method.std_m, method.mean_m)], [method.std_m]]
        axes.errorbar(method.mean_m, place, xerr=spread, color=INK, capsize=4, linewidth=1.2)
        # Errors of frames lie in the order of the flight, from the bar's top to its foot.
        heights = place + np.linspace(-0.25, 0.25, len(method.errors_m))
        seen = [fix for fix in method.fixes if fix.error_m is not None]
        for fix, error, height in zip(seen, method.errors_m, heights, strict=True):
            (dot,) = axes.plot(error, height, ".", color=INK, markersize=3, alpha=0.6)
            mark(dot, f"{fix.frame}: {error:.1f} m")
        dots += list(zip(method.errors_m, heights, strict=True))
        far = max(far, 1.1 * (method.mean_m + method.std_m))
    # A few frames far off would press all bars together; they wait at the border.
    beyond = [height for error, height in dots if error > far]
    axes.plot([0.985 * far] * len(beyond), beyond, ">", color=INK, markersize=4, alpha=0.6)
    axes.axvline(FAR_M, color=INK, linestyle="--", linewidth=1)
    if search.blind_mean_m is not None:
        axes.axvline(search.blind_mean_m, color=INK, linestyle=":", linewidth=1.2)
        axes.text(
            search.blind_mean_m, -0.5, "blind guess ", ha="right", va="bottom", fontsize="small", color=INK
        )
    axes.set_yticks(
        range(len(search.methods)), [f"{m.name}\n{_mean_and_std(m.mean_m, m.std_m)}" for m in search.methods]
    )
    axes.set_ylim(len(search.methods) - 0.5, -0.9)
    axes.set_xlim(0, far)
    axes.set_xlabel("error, m")
    axes.set_title(_title(search), fontsize="medium")
    axes.grid(visible=True, axis="x")


def _mean_and_std(mean: float | None, std: float | None) -> str:
    return "no position" if mean is None or std is None else f"{mean:.1f} ± {std:.1f} m"


@plot_style()
def plot_tracks(
    search: SearchResult, picture: NDArray[np.uint8], to_pixel: ToPixel, gsd_m: float, path: Path
) -> tuple[Path, Path]:
    """The true track, as far as it is known, and each method's positions on the map, cut to where they are.

    Filled marks are fixes, hollow ones positions that were not confident enough to be given; a frame without
    a position has none.

    Args:
        search: at least one method, and one frame whose truth or position is known.
        picture: uint8 ``[rows, columns, 3]``, the map, north up.
        to_pixel: where positions lie in it.
        gsd_m: metres per pixel.
        path: the picture without its suffix.

    Returns:
        The two files written, as by `save_plot`.

    Raises:
        InputError: the folder does not exist or cannot be written.
    """
    extent = Extent.around(search.methods, picture.shape[:2], to_pixel, gsd_m)
    truth = _known(search.methods[0].fixes, to_pixel)
    tracks = [_located(method.fixes, to_pixel) for method in search.methods]
    top, bottom, left, right = extent.top, extent.bottom, extent.left, extent.right
    part = picture[top:bottom, left:right]
    scale = min(1.0, _WIDEST_PX / max(part.shape[:2]))
    shown = cv2.resize(part, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA) if scale < 1 else part

    aspect = (bottom - top) / (right - left)
    figure = Figure(figsize=(8.0, 8.0 * min(max(aspect, 0.4), 1.8) + 1.5), layout="constrained")
    axes = figure.add_subplot()
    # Half a pixel around, since whole numbers are centres of pixels. Paler, to let the tracks stand out.
    axes.imshow(shown, extent=(left - 0.5, right - 0.5, bottom - 0.5, top - 0.5), alpha=0.75)
    outline = [withStroke(linewidth=5.5, foreground="black")]
    if truth[0].size:
        axes.plot(truth[1], truth[0], "-", color="white", linewidth=3.5, path_effects=outline, label="truth")
        axes.plot(truth[1], truth[0], "o", color="white", markeredgecolor="black", markersize=7)
    for place, (method, (rows, columns, fixed)) in enumerate(zip(search.methods, tracks, strict=True)):
        colour, marker = COLOURS[place % len(COLOURS)], _MARKERS[place % len(_MARKERS)]
        under = [withStroke(linewidth=2.4, foreground="black")]
        axes.plot(columns, rows, "-", color=colour, linewidth=1.2, path_effects=under)
        for given, face, edge in ((False, "none", colour), (True, colour, "black")):
            axes.plot(
                columns[fixed == given],
                rows[fixed == given],
                linestyle="",
                marker=marker,
                markersize=6,
                markerfacecolor=face,
                markeredgecolor=edge,
            )
        axes.plot(
            [], [], "-", color=colour, marker=marker, markersize=6, markeredgecolor="black", label=method.name
        )
    axes.set_xlim(left - 0.5, right - 0.5)
    axes.set_ylim(bottom - 0.5, top - 0.5)
    axes.set_axis_off()
    _scale_bar(axes, (right - left) * gsd_m)
    figure.suptitle(_title(search), fontsize="medium")
    figure.legend(
        loc="outside lower center",
        ncols=2,
        fontsize="small",
        frameon=True,
        facecolor="0.9",
        labelcolor="black",
    )
    return save_plot(figure, path)


def _known(fixes: tuple[FrameFix, ...], to_pixel: ToPixel) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Rows and columns of the true positions that are known."""
    known = [(fix.truth_latitude, fix.truth_longitude) for fix in fixes if fix.truth_latitude is not None]
    return to_pixel(*np.array(known, dtype=np.float64).reshape(-1, 2).T)


def _located(
    fixes: tuple[FrameFix, ...], to_pixel: ToPixel
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
    """Rows, columns and whether a fix was given, of the frames with a position."""
    known = [
        (fix.latitude, fix.longitude, fix.fixed)
        for fix in fixes
        if fix.latitude is not None and fix.longitude is not None
    ]
    if not known:
        return np.empty(0), np.empty(0), np.empty(0, dtype=np.bool_)
    latitude, longitude, fixed = zip(*known, strict=True)
    rows, columns = to_pixel(latitude, longitude)
    return rows, columns, np.array(fixed, dtype=np.bool_)


def _span(places: NDArray[np.float64], size: int, least: float) -> tuple[int, int]:
    """First and end pixel along one side of the map that shows all places and something around them."""
    low, high = float(places.min()), float(places.max())
    margin = max(0.12 * (high - low), (least - (high - low)) / 2)
    first = min(max(math.floor(low - margin), 0), size - 1)
    return first, max(min(math.ceil(high + margin), size), first + 1)


def _scale_bar(axes: Axes, width_m: float) -> None:
    """A bar of 1, 2 or 5 times a power of ten metres, at most a quarter of the picture, in its lower left."""
    power = 10.0 ** math.floor(math.log10(width_m / 4))
    metres = max(step * power for step in (1, 2, 5) if step * power <= width_m / 4)
    share = metres / width_m
    bar = Rectangle(
        (0.03, 0.03), share, 0.012, facecolor="white", edgecolor="black", transform=axes.transAxes, zorder=5
    )
    axes.add_patch(bar)
    axes.text(
        0.03 + share / 2,
        0.05,
        f"{metres / 1000:g} km" if metres >= 1000 else f"{metres:g} m",
        ha="center",
        va="bottom",
        color="white",
        path_effects=[withStroke(linewidth=2.5, foreground="black")],
        transform=axes.transAxes,
        zorder=5,
    )


def _title(search: SearchResult) -> str:
    if search.half_width_m is None:
        return "searched over the whole map"
    return f"searched within ±{search.half_width_m:g} m of the truth"
