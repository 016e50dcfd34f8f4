"""How a result shows itself: a few facts as lines in a terminal, and as a table in a notebook."""

import base64
from abc import ABC, abstractmethod
from collections.abc import Mapping
from html import escape

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.images.writing import png_bytes

MOST_PIXELS = 512
"""Longer sides of pictures are thinned to this in a notebook."""


class Shown(ABC):
    """A result that says what it is.

    Sub-classes name a title and facts; some have a picture, too.
    """

    @property
    @abstractmethod
    def title(self) -> str:
        """What it is, in a few words."""

    @property
    @abstractmethod
    def facts(self) -> Mapping[str, str]:
        """What there is to know first, by name."""

    @property
    def picture(self) -> NDArray[np.uint8] | None:
        """Uint8 ``[height, width, 3]`` to look at; None if there is nothing to see."""
        return None

    def __repr__(self) -> str:
        width = max(map(len, self.facts), default=0)
        return "\n".join([self.title, *(f"  {name:<{width}}  {value}" for name, value in self.facts.items())])

    def _repr_html_(self) -> str:
        """What a notebook shows."""
        rows = "".join(
            f'<tr><th style="text-align:left">{escape(name)}</th>'
            f'<td style="text-align:left">{escape(value)}</td></tr>'
            for name, value in self.facts.items()
        )
        table = f"<table><caption>{escape(self.title)}</caption><tbody>{rows}</tbody></table>"
        return table if self.picture is None else f"{table}{_image(self.picture, self.title)}"


def _image(picture: NDArray[np.uint8], title: str) -> str:
    step = -(-max(picture.shape[:2]) // MOST_PIXELS)
    content = base64.b64encode(png_bytes(np.ascontiguousarray(picture[::step, ::step]))).decode()
    return f'<img alt="{escape(title)}" src="data:image/png;base64,{content}">'
