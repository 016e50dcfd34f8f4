"""The colours of classes, in masks and in pictures of results."""

from dataclasses import dataclass
from pathlib import Path
from typing import Self

import numpy as np
from numpy.typing import NDArray
from PIL import ImageColor

from wnn2hdl.errors import InputError
from wnn2hdl.files import read_json

CLASS_COLOURS = {
    "forest": (22, 92, 44),
    "deforested": (226, 104, 52),
    "pasture": (202, 206, 110),
    "burnt soil": (74, 44, 52),
    "bare ground": (206, 160, 116),
    "river": (58, 120, 192),
    "road": (238, 230, 214),
}
"""Colours of the classes this project names itself."""


@dataclass(frozen=True)
class Palette:
    """The colour of each class, for masks of more than two classes and for pictures of results.

    Attributes:
        names: class names; the index of a name is the class index.
        colours: red, green and blue of each class, 0 to 255, all different.
    """

    names: tuple[str, ...]
    colours: tuple[tuple[int, int, int], ...]

    @classmethod
    def of(cls, names: tuple[str, ...]) -> Self:
        """The project's own colours for ``names``; names it does not know get hues apart from one another."""
        hues = (ImageColor.getrgb(f"hsv({(37 + 137 * i) % 360}, 85%, 90%)")[:3] for i in range(len(names)))
        return cls(names, tuple(CLASS_COLOURS.get(name, hue) for name, hue in zip(names, hues, strict=True)))

    @classmethod
    def read(cls, path: Path) -> Self:
        """Read a palette file: a JSON object of class names and colours, ``{"forest": "#165c2c", …}``.

        The first class is the background.

        Raises:
            InputError: no such file, no JSON object, fewer than two or more than 256 classes, a colour that
                is none, or one colour for two classes.
        """
        entries = read_json(path, "a palette")
        if not 2 <= len(entries) <= 256:
            raise InputError("a palette has 2 to 256 classes", value=f"{path} ({len(entries)})")
        colours = []
        for name, text in entries.items():
            try:
                colours.append(ImageColor.getrgb(text)[:3])
            except (ValueError, AttributeError, TypeError) as error:
                raise InputError(
                    f"the palette {path} gives {name!r} no colour",
                    value=repr(text),
                    hint="write it as #rrggbb",
                ) from error
        if len(set(colours)) != len(colours):
            raise InputError(
                "two classes of the palette share a colour", value=path, hint="change one of them"
            )
        return cls(tuple(entries), tuple(colours))

    def to_json(self) -> dict[str, str]:
        """The object of a palette file, read back by `read`."""
        return {
            name: "#{:02x}{:02x}{:02x}".format(*colour)
            for name, colour in zip(self.names, self.colours, strict=True)
        }

    def paint(self, labels: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """A picture of class indices: uint8 ``S`` to uint8 ``S + (3,)``."""
        return np.take(np.array(self.colours, dtype=np.uint8), labels, axis=0)
