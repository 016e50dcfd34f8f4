"""A scan as one HTML page that needs no other file."""

import base64
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from urllib.parse import quote

import cv2
import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.output import OVERLAY_FILE, SUMMARY_HTML
from wnn2hdl.apps.deforestation.overlay import overlay_palette
from wnn2hdl.apps.deforestation.summary import how
from wnn2hdl.images import jpeg_bytes, read_rgb
from wnn2hdl.report.shell import environment, form

_WIDEST_PX = 1200
"""Of the map on the page; the file beside it is larger."""


def scan_page(summary: Mapping[str, Any], folder: Path) -> str:
    """The page of a scan; the same scan gives the same bytes.

    Args:
        summary: of one picture, or of a folder of them.
        folder: that holds the overlay of one picture, or the folders of several.
    """
    names = [entry["class"] for entry in summary["classes"]]
    change = summary.get("change", {})
    several = "pictures" in summary
    return (
        environment("wnn2hdl.apps.deforestation")
        .get_template("scan.html")
        .render(
            summary=summary,
            title=Path(summary["input"]).name,
            form=form,
            picture="" if several else _encoded(read_rgb(folder / OVERLAY_FILE)),
            legend=overlay_palette(tuple(names)).to_json().items(),
            changes=[
                {**change[key], "class": name}
                for key, name in (("newly_cleared", "newly cleared"), ("regrown", "regrown"))
                if key in change
            ],
            pictures=[_row(one) for one in summary.get("pictures", ())],
            how=how(summary),
        )
    )


def _row(summary: Mapping[str, Any]) -> tuple[str, str, Mapping[str, Any]]:
    """Name, address of the page, and summary of a picture of a folder."""
    picture = Path(summary["input"])
    return picture.name, f"{quote(os.fsencode(picture.stem))}/{SUMMARY_HTML}?index=../{SUMMARY_HTML}", summary


def _encoded(picture: NDArray[np.uint8]) -> str:
    scale = _WIDEST_PX / max(picture.shape[:2])
    if scale < 1:
        size = [max(1, round(side * scale)) for side in picture.shape[1::-1]]
        picture = np.asarray(cv2.resize(picture, size, interpolation=cv2.INTER_AREA), dtype=np.uint8)
    return base64.b64encode(jpeg_bytes(picture)).decode()
