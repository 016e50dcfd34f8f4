"""Plots of results, as files for a person to look at."""

import io
from collections.abc import Sequence
from pathlib import Path

from wnn2hdl.files import write_bytes


def plot_pareto(
    points: Sequence[tuple[int, float, str]], front: Sequence[tuple[int, float, str]], path: Path
) -> tuple[Path, Path]:
    """Accuracy against LUTs: all points grey, the front as a staircase with its methods' names.

    Args:
        points: (LUTs a pixel, accuracy from 0 to 1, method) of every candidate.
        front: those that no other beats, by rising LUTs.
        path: the picture without its suffix.

    Returns:
        The two files written: PNG and SVG. The same points give the same bytes.

    Raises:
        InputError: the folder does not exist or cannot be written.
    """
    # Not at the top: commands that draw nothing need not wait for it.
    from matplotlib import rc_context
    from matplotlib.figure import Figure
    from matplotlib.ticker import ScalarFormatter

    with rc_context({"svg.hashsalt": "wnn2hdl"}):
        figure = Figure(figsize=(6.4, 4.0), layout="constrained")
        axes = figure.add_subplot()
        axes.scatter([x for x, _, _ in points], [100 * y for _, y, _ in points], color="0.65", label="tried")
        luts, accuracies = [x for x, _, _ in front], [100 * y for _, y, _ in front]
        axes.step(luts, accuracies, where="post", marker="o", color="tab:green", label="best")
        for x, y, (_, _, method) in zip(luts, accuracies, front, strict=True):
            axes.annotate(method, (x, y), xytext=(6, 4), textcoords="offset points", fontsize="small")
        # Linear up to 1, since a classifier that is a single wire takes no LUT.
        axes.set_xscale("symlog", base=2, linthresh=1)
        axes.xaxis.set_major_formatter(ScalarFormatter())
        axes.set_xlabel("LUTs a pixel")
        axes.set_ylabel("accuracy on unseen images, %")
        axes.grid(visible=True, alpha=0.3)
        figure.legend(loc="outside upper right", ncols=2)
        written = path.with_suffix(".png"), path.with_suffix(".svg")
        for file in written:
            stream = io.BytesIO()
            # A date in the file would make equal plots differ.
            metadata = {"Date": None} if file.suffix == ".svg" else {"Software": None}
            figure.savefig(stream, format=file.suffix[1:], dpi=150, metadata=metadata)
            write_bytes(file, stream.getvalue())
    return written
