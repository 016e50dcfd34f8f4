"""Pictures of a sweep, each as PNG and SVG; the same results give the same bytes."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from wnn2hdl.apps.sweep.grid import Cell
from wnn2hdl.apps.sweep.selection import Finalist, Surface, label
from wnn2hdl.apps.sweep.trial import Record
from wnn2hdl.report.drawing import INK, mark
from wnn2hdl.report.plots import plot_style, save_plot

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Points = tuple[Sequence[int], Sequence[float]]
"""LUTs and accuracies of a cloud of trials."""

_SIZE = (5.4, 3.9)
_LARGEST_CLOUD = 20_000
_LUT_TICKS = (0, 1, 2, 3, 5, 7, 10, 15, 20, 30, 50, 70, 100, 200, 500, 1000)
_COLOURS = ("tab:blue", "tab:orange", "tab:green", "tab:red", "tab:purple", "tab:brown")


@plot_style()
def draw_all(
    folder: Path,
    surface: Surface,
    marked: Sequence[Cell],
    finalists: Sequence[Finalist],
    clouds: Sequence[tuple[str, Points, Sequence[Record]]],
) -> tuple[str, ...]:
    """Draw every picture that the results allow.

    Args:
        folder: where they are written.
        surface: a surface of less than two rows or columns, or with holes only, is not drawn.
        marked: architectures to mark on the contours.
        finalists: for the histograms.
        clouds: name, all circuits and Pareto front of each way of searching, the grid first.

    Returns:
        The pictures' names without their suffixes.

    Raises:
        InputError: the folder cannot be written.
    """
    # Not at the top: commands that draw nothing need not wait for it.
    from matplotlib.figure import Figure

    drawings: dict[str, Callable[[Figure], None]] = {}
    if min(surface.accuracy.shape) > 1 and np.isfinite(surface.accuracy).any():
        drawings["surface"] = lambda figure: _surface(figure, surface)
        drawings["contour"] = lambda figure: _accuracy_contour(figure, surface, marked)
        drawings["cost"] = lambda figure: _cost_contour(figure, surface, marked)
    if finalists:
        drawings["finalists"] = lambda figure: _histograms(figure, finalists)
    if any(front for _, _, front in clouds):
        drawings["pareto"] = lambda figure: _fronts(figure, clouds)
    for name, drawing in drawings.items():
        figure = Figure(figsize=_SIZE, layout="constrained")
        drawing(figure)
        save_plot(figure, folder / name)
    return tuple(drawings)


def _surface(figure: "Figure", surface: Surface) -> None:
    axes = figure.add_subplot(projection="3d")
    rams, address_bits = np.meshgrid(surface.rams, surface.address_bits)
    height = 100 * surface.accuracy
    drawn = axes.plot_surface(
        address_bits,
        rams,
        height,
        cmap="viridis",
        vmin=np.nanmin(height),
        vmax=np.nanmax(height),
        rstride=1,
        cstride=1,
    )
    axes.set_xlabel("address bits")
    axes.set_ylabel("RAMs")
    axes.set_xticks(surface.address_bits[::2])
    axes.set_yticks(surface.rams[::3])
    axes.view_init(elev=32, azim=-128)
    axes.set_box_aspect(None, zoom=0.9)
    figure.colorbar(drawn, shrink=0.7, label="mean accuracy on held-out images, %")


def _accuracy_contour(figure: "Figure", surface: Surface, marked: Sequence[Cell]) -> None:
    axes = figure.add_subplot()
    filled = axes.contourf(
        surface.rams, surface.address_bits, np.ma.masked_invalid(100 * surface.accuracy), levels=14
    )
    figure.colorbar(filled, label="mean accuracy on held-out images, %")
    _tell_architectures(axes, surface)
    _architecture_axes(axes, surface, marked)


def _cost_contour(figure: "Figure", surface: Surface, marked: Sequence[Cell]) -> None:
    axes = figure.add_subplot()
    # A constant classifier takes no LUT at all, so one is added before the logarithm.
    logarithm = np.ma.masked_invalid(np.log10(1 + surface.luts))
    filled = axes.contourf(surface.rams, surface.address_bits, logarithm, levels=14, cmap="magma")
    figure.colorbar(filled, label="log10(1 + mean LUTs per pixel)")
    _tell_architectures(axes, surface)
    _architecture_axes(axes, surface, marked)


def _tell_architectures(axes: "Axes", surface: Surface) -> None:
    for row, n in enumerate(surface.address_bits):
        for column, k in enumerate(surface.rams):
            accuracy, luts = surface.accuracy[row, column], surface.luts[row, column]
            if np.isfinite(accuracy):
                place = axes.scatter(k, n, s=90, color=(0, 0, 0, 0), clip_on=False)
                text = f"{label((n, k))}: {100 * accuracy:.2f} %, {luts:.1f} LUTs on average"
                mark(place, text)


def _architecture_axes(axes: "Axes", surface: Surface, marked: Sequence[Cell]) -> None:
    # Neighbours on a ridge would write over each other's labels, so marks are numbered.
    for number, (n, k) in enumerate(marked, 1):
        axes.plot(k, n, "o", color="white", markeredgecolor="black", markersize=11, clip_on=False, zorder=3)
        axes.annotate(
            str(number), (k, n), ha="center", va="center", color="black", fontsize="small", zorder=4
        )
    if marked:
        names = [f"{number}: {bits}/{rams}" for number, (bits, rams) in enumerate(marked, 1)]
        axes.set_title("address bits/RAMs   " + "   ".join(names), fontsize="small", pad=10)
    axes.set_xlabel("RAMs")
    axes.set_ylabel("address bits")
    axes.set_xticks(surface.rams)
    axes.set_yticks(surface.address_bits)


def _histograms(figure: "Figure", finalists: Sequence[Finalist]) -> None:
    rows = figure.subplots(len(finalists), sharex=True, squeeze=False)[:, 0]
    figure.set_size_inches(_SIZE[0], max(_SIZE[1], 1.3 * len(finalists)))
    values = [100 * np.array(list(finalist.accuracies.values())) for finalist in finalists]
    low, high = min(x.min() for x in values), max(x.max() for x in values)
    edges = np.linspace(low, max(high, low + 0.1), 41)
    for axes, finalist, accuracies, colour in zip(rows, finalists, values, _COLOURS, strict=False):
        counts, _, bars = axes.hist(accuracies, bins=edges, color=colour)
        for count, low_edge, high_edge, bar in zip(counts, edges, edges[1:], bars, strict=False):
            if count:
                mark(bar, f"{low_edge:.2f} to {high_edge:.2f} %: {count:.0f} trials")
        axes.axvline(accuracies.mean(), color=INK, linestyle="--", linewidth=1)
        title = f"{label(finalist.cell)}: mean {accuracies.mean():.1f} %, {len(accuracies)} valid trials"
        axes.set_title(title, loc="left", fontsize="small")
    rows[-1].set_xlabel("accuracy on held-out images, %")
    figure.supylabel("trials")


def _fronts(figure: "Figure", clouds: Sequence[tuple[str, Points, Sequence[Record]]]) -> None:
    axes = figure.add_subplot()
    rng = np.random.default_rng(0)
    seen: list[float] = []
    for (name, (luts, accuracies), front), colour in zip(clouds, _COLOURS, strict=False):
        step = 1 + len(luts) // _LARGEST_CLOUD
        height = 100 * np.array(accuracies[::step])
        # LUTs are whole numbers: a little noise shows how many trials share a place.
        place = np.array(luts[::step]) * np.exp(rng.uniform(-0.06, 0.06, len(height)))
        # Thousands of dots as vectors make a file that no browser likes.
        axes.scatter(place, height, s=8, alpha=0.5, color=colour, linewidths=0, rasterized=True)
        steps = [record.luts or 0 for record in front]
        best = [100 * (record.circuit_accuracy or 0) for record in front]
        axes.step(steps, best, where="post", color=colour, label=f"{name}, front")
        for record, luts_, share in zip(front, steps, best, strict=True):
            (point,) = axes.plot(luts_, share, "o", markersize=4, color=colour)
            mark(point, f"{record.name}: {luts_:,} LUTs, {share:.2f} %")
        seen += [*height, *best]
    most = max(1, *(max(luts, default=1) for _, (luts, _), _ in clouds))
    axes.set_xscale("symlog", linthresh=1)
    axes.set_xlim(-0.1, 1.25 * most)
    # A few trials far below would press all others together.
    axes.set_ylim(np.percentile(seen, 1) - 1, max(seen) + 1)
    axes.set_xticks([tick for tick in _LUT_TICKS if tick <= most])
    axes.xaxis.set_major_formatter("{x:.0f}")
    axes.minorticks_off()
    axes.set_xlabel("LUTs per pixel")
    axes.set_ylabel("accuracy of the circuit on held-out images, %")
    axes.grid(visible=True)
    axes.legend(loc="lower right")
