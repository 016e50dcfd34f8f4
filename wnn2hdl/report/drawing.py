"""Matplotlib's figures as parts of a page: in the page's colours, with values that show when pointed at."""

import io
import re
from html import escape
from typing import TYPE_CHECKING

from markupsafe import Markup

from wnn2hdl.errors import printable

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.figure import Figure

INK, MUTED, RULE, ACCENT, PAPER = "#000001", "#000002", "#000003", "#000004", "#000005"
"""Colours that stand for the page's own while Matplotlib draws."""

_VARIABLES = {INK: "--ink", MUTED: "--muted", RULE: "--rule", ACCENT: "--accent", PAPER: "--paper"}

_TOLD = "tells: "
"""What the group's name of something that tells its value begins with."""


def mark(artist: "Artist", text: str) -> None:
    """Let a bar or a point tell its value when pointed at: `told` makes a title of it."""
    artist.set_gid(_TOLD + printable(text))


def told(svg: str) -> str:
    """An SVG of Matplotlib's, in which what was given to `mark` is a title of class ``mark``."""
    # Attributes are escaped more than text has to be.
    return re.sub(rf'<g id="{_TOLD}([^"]*)">', r'<g class="mark"><title>\1</title>', svg)


def saved(figure: "Figure") -> str:
    """A figure as an SVG without a ground and without a date."""
    stream = io.StringIO()
    figure.savefig(stream, format="svg", transparent=True, metadata={"Date": None, "Creator": None})
    return told(stream.getvalue())


def inlined(svg: str, title: str, prefix: str, kind: str) -> Markup:
    """An SVG of Matplotlib's as an element of a page: no head, no fixed size, the page's colours and font.

    Args:
        svg: as `saved` or `wnn2hdl.report.plots.save_plot` makes it.
        title: what it shows, for those who do not see it.
        prefix: of its names; no two drawings of a page have the same.
        kind: its classes in the style sheet.
    """
    text = svg[svg.index("<svg") :]
    text = re.sub(r"\s*<metadata>.*?</metadata>", "", text, flags=re.DOTALL)
    for colour, variable in _VARIABLES.items():
        text = text.replace(colour, f"var({variable})")
    # Its style sheet would reach the whole page, and its fonts are not the page's.
    text = re.sub(r"\s*<style.*?</style>|; font-family: [^;\"]*|<!--.*?-->", "", text, flags=re.DOTALL)
    text = re.sub(r' id="([^"]+)"', rf' id="{prefix}-\1"', text)
    text = re.sub(r'(xlink:href="#|url\(#)', rf"\1{prefix}-", text)
    box = re.search(r'viewBox="[^"]+"', text)
    assert box is not None
    head = f'<svg class="{kind}" role="img" aria-label="{escape(printable(title))}" {box[0]}'
    head = f'{head} xmlns:xlink="http://www.w3.org/1999/xlink">'
    # Matplotlib has escaped the texts.
    return Markup(re.sub(r"<svg[^>]*>", lambda _: head, text, count=1))  # noqa: S704
