"""Plots of results, as files for a person to look at: a PNG on white, and an SVG that follows the theme."""

import io
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from wnn2hdl.files import write_bytes
from wnn2hdl.report.drawing import INK, mark, told

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_THEME = (
    "<style>:root { color: #1c1f1d; background: #fdfdfb; }"
    " @media (prefers-color-scheme: dark) { :root { color: #e6e9e6; background: #141716; } }</style>"
)
"""Ink and paper as the pages have them. An SVG in an ``img`` follows the colour scheme of that element."""


@contextmanager
def plot_style() -> Iterator[None]:
    """While a figure is drawn, everything without its own colour is drawn in `INK`, on no ground."""
    # Not at the top: commands that draw nothing need not wait for it.
    from matplotlib import rc_context

    inked = ("text.color", "axes.edgecolor", "axes.labelcolor", "xtick.color", "ytick.color", "grid.color")
    style: dict[Any, Any] = {
        **dict.fromkeys(inked, INK),
        **{f"axes3d.{axis}axis.panecolor": (0.5, 0.5, 0.5, 0.12) for axis in "xyz"},
        "axes.facecolor": "none",
        "grid.alpha": 0.25,
        "legend.frameon": False,
        # Names drawn at random would make equal plots differ.
        "svg.hashsalt": "wnn2hdl",
    }
    with rc_context(style):
        yield


def save_plot(figure: "Figure", path: Path) -> tuple[Path, Path]:
    """Write a figure that was drawn in `plot_style`, and is saved in it; equal figures give equal bytes.

    Args:
        figure: what was drawn.
        path: the picture without its suffix.

    Returns:
        The two files written: PNG on white, and SVG, of which whatever is drawn in `INK` is dark on a light
        page and light on a dark one; what `wnn2hdl.report.drawing.mark` was called for tells its value.

    Raises:
        InputError: the folder does not exist or cannot be written.
    """
    picture, drawing = path.with_suffix(".png"), path.with_suffix(".svg")
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=150, facecolor="white", metadata={"Software": None})
    write_bytes(picture, stream.getvalue())
    stream = io.BytesIO()
    figure.savefig(stream, format="svg", dpi=150, facecolor="none", metadata={"Date": None})
    text = told(stream.getvalue().decode()).replace(INK, "currentColor")
    write_bytes(drawing, text.replace("<defs>", f"{_THEME}\n <defs>", 1).encode())
    return picture, drawing


@plot_style()
def plot_pareto(
    points: Sequence[tuple[int, float, str]],
    front: Sequence[tuple[int, float, str]],
    path: Path,
    *,
    cost: str = "LUTs per pixel",
    worth: str = "accuracy on unseen images",
) -> tuple[Path, Path]:
    """Accuracy against LUTs: all points grey, the front as a staircase with its methods' names.

    Args:
        points: (LUTs, accuracy from 0 to 1, method) of every candidate.
        front: those that no other beats, by rising LUTs.
        path: the picture without its suffix.
        cost: what the LUTs are of.
        worth: what the accuracy is of.

    Returns:
        The two files written, as by `save_plot`.

    Raises:
        InputError: the folder does not exist or cannot be written.
    """
    # Not at the top: commands that draw nothing need not wait for it.
    from matplotlib.figure import Figure
    from matplotlib.ticker import ScalarFormatter

    figure = Figure(figsize=(6.4, 4.0), layout="constrained")
    axes = figure.add_subplot()
    axes.scatter([x for x, _, _ in points], [100 * y for _, y, _ in points], color="0.6", label="tried")
    luts, accuracies = [x for x, _, _ in front], [100 * y for _, y, _ in front]
    axes.step(luts, accuracies, where="post", marker="o", color="tab:green", label="best")
    for x, y, method in points:
        mark(axes.scatter(x, 100 * y, color="none"), f"{method}: {x:,} LUTs, {100 * y:.2f} %")
    for x, y, (_, _, method) in zip(luts, accuracies, front, strict=True):
        axes.annotate(method, (x, y), xytext=(6, 4), textcoords="offset points", fontsize="small")
    # Linear up to 1, since a classifier that is a single wire takes no LUT.
    axes.set_xscale("symlog", base=2, linthresh=1)
    axes.xaxis.set_major_formatter(ScalarFormatter())
    axes.set_xlabel(cost)
    axes.set_ylabel(f"{worth}, %")
    axes.grid(visible=True)
    figure.legend(loc="outside upper right", ncols=2)
    return save_plot(figure, path)
