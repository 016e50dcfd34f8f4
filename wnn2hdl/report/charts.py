"""Charts as SVG that takes its colours from the page, so that one drawing serves light and dark."""

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from markupsafe import Markup

from wnn2hdl.errors import printable
from wnn2hdl.muted import muted
from wnn2hdl.report.drawing import ACCENT, INK, MUTED, PAPER, RULE, inlined, mark, saved

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.transforms import Bbox

_WIDTH, _NARROW_WIDTH = 11.0, 4.6
"""Inches, each of which a page shows about as 90 pixels; the narrow one is for phones."""

_BAR, _NARROW_BAR = 0.34, 0.48


def for_all_widths(draw: Callable[..., Markup], *arguments: Any) -> Markup:
    """A chart twice, the second time for narrow windows; the style sheet shows the one that fits."""
    return draw(*arguments) + draw(*arguments, narrow=True)


def published(report: Mapping[str, Any]) -> Sequence[Mapping[str, Any]]:
    """The published figures that a build can be compared with: they are of circuits for pictures."""
    return () if "network" in report["parts"] else report["published"]


def lut_bars(report: Mapping[str, Any], *, narrow: bool = False) -> Markup:
    """LUTs of each measured part, the Sobel baseline among them, and below them what was published.

    Measured bars are filled; published ones are outlined, with dashes, under their own heading.

    Args:
        report: the object of `report.json`.
        narrow: whether names stand above their bars and not beside them.

    Returns:
        The drawing; nothing where there is no figure.
    """
    measured = [
        (part, figures["luts"]) for part, figures in report["parts"].items() if figures["luts"] is not None
    ]
    quoted = [(figure["what"], figure["luts"]) for figure in published(report)]
    rows = [*measured, *quoted]
    if not rows:
        return Markup()

    height = 0.4 if narrow else 0.62

    def paint(axes: "Axes") -> None:
        places = [i + (i >= len(measured)) * 0.9 for i in range(len(rows))]
        for place, (name, luts) in zip(places, measured, strict=False):
            (bar,) = axes.barh(place, luts, height=height, color=MUTED if name == "sobel" else ACCENT)
            mark(bar, f"{name}: {luts:,} LUTs, measured here")
        for place, (name, luts) in zip(places[len(measured) :], quoted, strict=True):
            (bar,) = axes.barh(
                place,
                luts,
                height=height,
                facecolor="none",
                edgecolor=MUTED,
                linestyle=(0, (3, 2)),
                linewidth=1,
            )
            mark(bar, f"{name}: {luts:,} LUTs, published")
        most = max(1, *(luts for _, luts in rows))
        for place, (_, luts) in zip(places, rows, strict=True):
            axes.text(luts + most / 80, place, f"{luts:,}", va="center", color=INK, fontweight="bold")
        if narrow:
            axes.set_yticks([])
            for place, (name, _) in zip(places, rows, strict=True):
                axes.annotate(
                    _short(name),
                    (0, place - height / 2),
                    xytext=(0, 2),
                    textcoords="offset points",
                    color=INK,
                )
        else:
            axes.set_yticks(places, [_short(name) for name, _ in rows])
        axes.set_ylim(places[-1] + 0.6, -1.0 if narrow else -0.6)
        axes.set_xlim(0, most * 1.08)
        axes.set_xlabel("LUTs")
        if measured and quoted:
            line = len(measured) - (0.2 if narrow else 0.05)
            axes.axhline(line, color=RULE, linewidth=1)
            axes.text(
                most * 1.08,
                line - 0.12,
                "measured here",
                ha="right",
                va="bottom",
                color=MUTED,
                style="italic",
            )
            axes.text(
                most * 1.08, line + 0.12, "published", ha="right", va="top", color=MUTED, style="italic"
            )

    listed = ", ".join(f"{name} {luts}" for name, luts in measured)
    title = f"LUTs by part. Measured: {listed or 'nothing'}."
    if quoted:
        title += f" Published by others: {', '.join(f'{name} {luts}' for name, luts in quoted)}."
    bar = _NARROW_BAR if narrow else _BAR
    return _svg(paint, title, "luts", bar * (len(rows) + 2.6), narrow=narrow)


def cube_bars(minimised: Mapping[str, Mapping[str, int]], *, narrow: bool = False) -> Markup:
    """Product terms of each table before and after minimising, on a logarithmic scale."""

    def paint(axes: "Axes") -> None:
        for place, (name, sizes) in enumerate(minimised.items()):
            before, after = sizes["cubes_before"], sizes["cubes_after"]
            # A constant table has no product term, and zero has no logarithm.
            axes.plot([max(after, 0.7), max(before, 0.7)], [place, place], color=RULE, linewidth=3, zorder=1)
            ring = axes.scatter(
                max(before, 0.7), place, s=46, facecolor=PAPER, edgecolor=MUTED, linewidth=1.4, zorder=2
            )
            mark(ring, f"{name}: {before:,} cubes as extracted")
            disc = axes.scatter(max(after, 0.7), place, s=46, color=ACCENT, zorder=3)
            mark(disc, f"{name}: {after:,} cubes minimised")
            for value, colour in ((before, MUTED), (after, INK)):
                axes.annotate(
                    f"{value:,}",
                    (max(value, 0.7), place),
                    xytext=(0, 8),
                    textcoords="offset points",
                    ha="center",
                    color=colour,
                    fontweight="bold" if colour == INK else "normal",
                )
        axes.set_xscale("log")
        most = max(sizes["cubes_before"] for sizes in minimised.values())
        axes.set_xlim(0.6, max(2, most) * 1.6)
        axes.xaxis.set_major_formatter("{x:,.0f}")
        axes.minorticks_off()
        width = _NARROW_NAME if narrow else _NAME
        axes.set_yticks(range(len(minimised)), [_short(name, width) for name in minimised])
        axes.set_ylim(len(minimised) - 0.5, -0.75)
        axes.set_xlabel("cubes, logarithmic: ○ as extracted, ● minimised")

    listed = "; ".join(
        f"{name} {sizes['cubes_before']} before, {sizes['cubes_after']} after"
        for name, sizes in minimised.items()
    )
    height = 0.55 * len(minimised) + 0.55
    return _svg(paint, f"Cubes of each table. {listed}.", "cubes", height, narrow=narrow)


def scatter(points: Sequence[tuple[str, int, float]], *, narrow: bool = False) -> Markup:
    """Accuracy against LUTs of several builds, each with its name; those at one place share a point.

    Args:
        points: name, LUTs and accuracy from 0 to 1.
        narrow: whether it is for narrow windows.
    """
    names: dict[tuple[float, float], list[str]] = {}
    for name, x, y in points:
        names.setdefault((x, 100 * y), []).append(name)

    def paint(axes: "Axes") -> None:
        from matplotlib.ticker import MaxNLocator

        for (x, y), shared in names.items():
            point = axes.scatter(x, y, s=40, color=ACCENT, zorder=2)
            mark(point, f"{', '.join(shared)}: {x:,} LUTs, {y:.2f} %")
        axes.margins(x=0.12, y=0.2)
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        axes.grid(color=RULE, linewidth=0.6)
        axes.set_axisbelow(True)
        axes.set_xlabel("LUTs of the target")
        axes.set_ylabel("accuracy of the circuit, %")
        width = _NARROW_NAME if narrow else _NAME
        _label(axes, {place: _short(", ".join(shared), width) for place, shared in names.items()})

    listed = "; ".join(f"{name}: {x} LUTs, {100 * y:.2f} %" for name, x, y in points)
    return _svg(paint, f"Accuracy against LUTs. {listed}.", "scatter", 3.0, narrow=narrow)


def light_lines(quantity: str, points: Sequence[Mapping[str, Any]], *, narrow: bool = False) -> Markup:
    """Accuracy against light: of all pixels with its interval, and of the worst image.

    Args:
        quantity: what varies, ``exposure`` or ``haze``.
        points: as in `wnn2hdl.report.LightFigures`, ascending.
        narrow: whether it is for narrow windows.
    """
    values = [point["value"] for point in points]
    shares = [100 * point["accuracy"] for point in points]
    worst = [100 * point["worst_image"]["accuracy"] for point in points]

    def paint(axes: "Axes") -> None:
        if all(point["interval"] for point in points):
            low, high = ([100 * point["interval"][end] for point in points] for end in (0, 1))
            axes.fill_between(values, low, high, color=RULE, linewidth=0)
        axes.plot(values, shares, color=ACCENT)
        axes.plot(values, worst, color=MUTED, linestyle=(0, (3, 2)), linewidth=1)
        for line, size, colour, what in (
            (shares, 5, ACCENT, "all images"),
            (worst, 3, MUTED, "the worst image"),
        ):
            for value, share in zip(values, line, strict=True):
                (point,) = axes.plot(value, share, color=colour, marker="o", markersize=size)
                mark(point, f"{quantity} {value:g}: {share:.2f} % of {what}")
        for line, text in ((shares, "all images"), (worst, "worst image")):
            axes.annotate(
                text, (values[-1], line[-1]), xytext=(0, 8), textcoords="offset points", ha="right", color=INK
            )
        axes.set_ylim(min(0.98 * min(worst), 50), 102)
        axes.set_xlabel(quantity)
        axes.set_ylabel("pixels right, %")

    listed = "; ".join(
        f"{value:g}: {share:.2f} %, worst image {least:.2f} %"
        for value, share, least in zip(values, shares, worst, strict=True)
    )
    return _svg(paint, f"Accuracy against {quantity}. {listed}.", f"light-{quantity}", 2.6, narrow=narrow)


_CORNERS = ((7, 5), (7, -14), (-7, 5), (-7, -14), (7, 19), (7, -28), (-7, 19), (-7, -28))
"""Where a label may stand, in points from its place; on the left it ends there."""


def _label(axes: "Axes", texts: Mapping[tuple[float, float], str]) -> None:
    """Write texts beside their places, each where it meets none before it, if there is such a corner."""
    # The layout, which decides where places lie, is made when the figure is drawn.
    figure = axes.get_figure(root=True)
    assert figure is not None
    figure.draw_without_rendering()
    taken: list[Bbox] = []
    for place, text in texts.items():
        label = axes.annotate(text, place, xytext=_CORNERS[0], textcoords="offset points", color=INK)
        for corner in _CORNERS:
            label.set_position(corner)
            label.set_horizontalalignment("left" if corner[0] > 0 else "right")
            if not label.get_window_extent().count_overlaps(taken):
                break
        taken.append(label.get_window_extent())


_NAME, _NARROW_NAME = 56, 20
"""Characters of a name that are shown."""


def _short(text: str, width: int = _NAME) -> str:
    text = printable(text)
    return text if len(text) <= width else text[: width - 1].rstrip() + "…"


def _svg(paint: "Callable[[Axes], None]", title: str, prefix: str, height: float, *, narrow: bool) -> Markup:
    # Not at the top: Matplotlib takes a fifth of a second to import, which other commands need not wait for.
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    style: dict[Any, Any] = {
        "svg.hashsalt": prefix,
        # Names are no formulas, whatever dollar signs they hold.
        "text.parse_math": False,
        "svg.fonttype": "none",
        "font.size": 10,
        "text.color": INK,
        "axes.labelcolor": MUTED,
        "axes.edgecolor": RULE,
        "xtick.color": MUTED,
        "ytick.color": MUTED,
        "ytick.labelcolor": INK,
        "xtick.labelcolor": MUTED,
        "axes.spines.top": False,
        "axes.spines.right": False,
    }
    # The browser draws the text, with whatever fonts it has.
    unfit = "Glyph .* missing from font|Matplotlib currently does not support"
    with rc_context(style), muted(message=unfit):
        figure = Figure(figsize=(_NARROW_WIDTH if narrow else _WIDTH, height), layout="constrained")
        axes = figure.add_subplot()
        axes.tick_params(axis="y", length=0)
        axes.spines["left"].set_visible(prefix not in ("luts", "cubes"))
        paint(axes)
        kind = "chart narrow" if narrow else "chart"
        return inlined(saved(figure), title, f"{prefix}-narrow" if narrow else prefix, kind)
