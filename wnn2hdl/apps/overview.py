"""All that the demo makes in one picture: photo, classes, edges, schematic, map and flight."""

import io
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.overlay import overlay_palette
from wnn2hdl.apps.navigation.flight import FlightRun
from wnn2hdl.apps.navigation.methods import WEIGHTLESS
from wnn2hdl.build.design import Design
from wnn2hdl.build.playback import Playback
from wnn2hdl.files import write_bytes
from wnn2hdl.report.schematic import Schematic, draw

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.path import Path as Curve

_WIDTH_IN, _HEIGHT_IN, _DPI = 9.6, 6.9, 125
_QUALITY = 80
"""Of the JPEG: photographs of this size then take about 200 kB."""

_INK, _PAPER, _BOX, _TRUTH, _FOUND = "#1c1f1d", "#ffffff", "#dfeadf", "#ffffff", "#f0e442"


@dataclass(frozen=True, eq=False)
class Overview:
    """What is shown.

    Attributes:
        photo: uint8 ``[height, width, 3]``: what the circuit is shown.
        playback: the circuit's answers on the photo.
        design: the circuit, of the target ``block``.
        luts: of each part, as counted.
        map: uint8 ``[height, width, 3]``, a larger scene with its classes; None if nothing was mapped.
        flight: the located flight; None if there is none.
    """

    photo: NDArray[np.uint8]
    playback: Playback
    design: Design
    luts: dict[str, int]
    map: NDArray[np.uint8] | None
    flight: FlightRun | None


def write_overview(path: Path, shown: Overview) -> None:
    """Write the picture, a JPEG of 1200x862 pixels.

    Raises:
        InputError: the folder does not exist or cannot be written.
    """
    # Not at the top: commands that draw nothing need not wait for it.
    from matplotlib.figure import Figure

    figure = Figure(figsize=(_WIDTH_IN, _HEIGHT_IN), layout="constrained", facecolor=_PAPER)
    panels = figure.subplots(2, 3).ravel().tolist()
    for panel in panels:
        panel.set_axis_off()
    palette = overlay_palette(("forest", "deforested"))
    classes = palette.paint(shown.playback.foreground.astype(np.uint8))
    _picture(panels[0], "1  Photo", shown.photo)
    _picture(panels[1], "2  Class of each pixel", classes)
    if shown.playback.edges is not None:
        _picture(panels[2], "3  Edges between classes", np.where(shown.playback.edges, 0, 255))
    _circuit(panels[3], shown)
    if shown.map is not None:
        _picture(panels[4], "5  Map of a larger scene", shown.map)
    if shown.flight is not None:
        _flight(panels[5], shown.flight)
    stream = io.BytesIO()
    figure.savefig(stream, format="jpeg", dpi=_DPI, pil_kwargs={"quality": _QUALITY, "optimize": True})
    write_bytes(path, stream.getvalue())


def _picture(axes: "Axes", title: str, picture: NDArray[np.generic]) -> None:
    # Numbered titles stand on the left, so that they read as steps.
    axes.set_title(title, loc="left", color=_INK)
    axes.imshow(picture, cmap="gray", interpolation="none" if picture.ndim == 2 else None)


def _circuit(axes: "Axes", shown: Overview) -> None:
    """The pixel classifier and the edge filter, as their pages draw them, one above the other."""
    pixel, edge, block = (shown.luts[part] for part in ("pixel", "edge", "block"))
    axes.set_title(f"4  Circuit: {block} LUTs", loc="left", color=_INK)
    networks = shown.design.networks
    parts = [
        (f"for each of 9 pixels: {_count(pixel)}", draw(networks["pixel"])),
        (f"edge filter: {_count(edge)}", draw(networks["edge"])),
    ]
    width = max(drawing.width for _, drawing in parts)
    top = 0.0
    for text, drawing in parts:
        axes.text(0, top + 10, text, color=_INK, fontsize="small", va="center")
        top += 24
        _schematic(axes, drawing, (width - drawing.width) / 2, top)
        top += drawing.height + 8
    axes.set_xlim(0, width)
    axes.set_ylim(top, 0)
    axes.set_aspect("equal")


def _count(luts: int) -> str:
    return f"{luts} LUT" if luts == 1 else f"{luts} LUTs"


def _schematic(axes: "Axes", drawing: Schematic, left: float, top: float) -> None:
    from matplotlib.patches import PathPatch, Rectangle

    for wire in drawing.wires:
        axes.add_patch(PathPatch(_curve(wire.path, left, top), fill=False, edgecolor=_INK, linewidth=0.7))
    for node in drawing.nodes:
        x, y = left + node.x, top + node.y
        if node.kind in ("lut", "mux"):
            corner = (x, y - node.height / 2)
            box = Rectangle(
                corner, node.width, node.height, facecolor=_BOX, edgecolor=_INK, linewidth=0.8, zorder=2
            )
            axes.add_patch(box)
        # Names of inputs end where their wires begin.
        align, at = {"input": ("right", x + node.width - 3), "output": ("left", x + 3)}.get(
            node.kind, ("center", x + node.width / 2)
        )
        text = "LUT" if node.kind == "lut" else node.name
        axes.text(at, y, text, ha=align, va="center", fontsize=6.5, color=_INK, zorder=3)


def _curve(path: str, left: float, top: float) -> "Curve":
    """An SVG path of one M and any number of C, as Matplotlib has it."""
    from matplotlib.path import Path as Curve

    points = np.array([float(number) for number in re.findall(r"-?\d+\.?\d*", path)]).reshape(-1, 2)
    codes = [Curve.MOVETO] + [Curve.CURVE4] * (len(points) - 1)
    return Curve(points + np.array([left, top]), codes)


def _flight(axes: "Axes", flight: FlightRun) -> None:
    """The true track and the positions found on the whole map, as far as frames were located."""
    search = flight.result.searches[-1]
    row = flight.rows(search)[WEIGHTLESS]
    mean = "" if row.mean_m is None else f", {row.mean_m:.1f} m off"
    _picture(axes, f"6  Flight found on the map{mean}", flight.grid.image)
    fixes = row.fixes
    truth = [(fix.truth_latitude, fix.truth_longitude) for fix in fixes if fix.truth_latitude is not None]
    found = [(fix.latitude, fix.longitude) for fix in fixes if fix.latitude is not None]
    _track(axes, flight, truth, color=_TRUTH, linewidth=3)
    _track(axes, flight, found, color=_FOUND, linewidth=0, marker="o", markersize=5, markeredgecolor=_INK)


def _track(
    axes: "Axes",
    flight: FlightRun,
    places: Sequence[tuple[float | None, float | None]],
    **style: Any,
) -> None:
    rows, columns = flight.grid.to_pixel(*np.array(places, dtype=np.float64).reshape(-1, 2).T)
    axes.plot(columns, rows, **style)
