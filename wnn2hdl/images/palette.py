"""The colours of classes, in masks and in pictures of results."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from PIL import ImageColor

from wnn2hdl.errors import InputError
from wnn2hdl.files import read_json
from wnn2hdl.images.codes import code_of, colour_of, parse_code

MOST_CLASSES = 255
"""Of a palette: one value of a byte is left for pixels without a class."""

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


IGNORED = "ignore"
"""The entry of a palette file whose codes are of no class: these pixels are unlabelled."""


@dataclass(frozen=True)
class Palette:
    """The colour of each class in pictures of results, and what stands for it in masks.

    Attributes:
        names: class names; the index of a name is the class index.
        colours: red, green and blue of each class, 0 to 255, all different.
        codes: what stands for each class in masks, as `wnn2hdl.images.codes` makes them; the colours' own if
            left out.
        ignored: codes of unlabelled pixels.
    """

    names: tuple[str, ...]
    colours: tuple[tuple[int, int, int], ...]
    codes: tuple[tuple[int, ...], ...] = ()
    ignored: frozenset[int] = frozenset()

    @classmethod
    def of(cls, names: tuple[str, ...]) -> Self:
        """The project's own colours for ``names``; names it does not know get hues apart from one another."""
        hues = (ImageColor.getrgb(f"hsv({(37 + 137 * i) % 360}, 85%, 90%)")[:3] for i in range(len(names)))
        return cls(names, tuple(CLASS_COLOURS.get(name, hue) for name, hue in zip(names, hues, strict=True)))

    @classmethod
    def read(cls, path: Path) -> Self:
        """Read a palette file: a JSON object of class names and what stands for them in masks.

        That is a colour, a number, or a list of these: ``{"forest": "#165c2c", "river": [26, 33], …}``. The
        first class is the background. Pixels of the entry `IGNORED` are left out.

        Raises:
            InputError: no such file, no JSON object, fewer than two or more than 255 classes, an entry that
                is neither a colour nor a number, or one for two classes.
        """
        entries = read_json(path, "a palette")
        codes = {name: _codes(path, name, entry) for name, entry in entries.items()}
        ignored = frozenset(codes.pop(IGNORED, ()))
        if not 2 <= len(codes) <= MOST_CLASSES:
            raise InputError(f"a palette has 2 to {MOST_CLASSES} classes", value=f"{path} ({len(codes)})")
        known = [*ignored, *(code for some in codes.values() for code in some)]
        if len(set(known)) != len(known):
            raise InputError(
                "two classes of the palette share a colour or a number", value=path, hint="change one of them"
            )
        names = tuple(codes)
        first = [
            colour_of(some[0]) if isinstance(_first(entries[name]), str) else None
            for name, some in codes.items()
        ]
        colours = tuple(own or other for own, other in zip(first, cls.of(names).colours, strict=True))
        if len(set(colours)) != len(colours):
            raise InputError(
                "two classes of the palette share a colour", value=path, hint="give both of them a colour"
            )
        return cls(names, colours, tuple(codes.values()), ignored)

    @property
    def mask_codes(self) -> tuple[tuple[int, ...], ...]:
        """What stands for each class in masks."""
        return self.codes or tuple((code_of(colour),) for colour in self.colours)

    def to_json(self) -> dict[str, str]:
        """The object of a palette file of these colours, read back by `read`."""
        return {
            name: "#{:02x}{:02x}{:02x}".format(*colour)
            for name, colour in zip(self.names, self.colours, strict=True)
        }

    def paint(self, labels: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """A picture of class indices: uint8 ``S`` to uint8 ``S + (3,)``."""
        return np.take(np.array(self.colours, dtype=np.uint8), labels, axis=0)


def _codes(path: Path, name: str, entry: Any) -> tuple[int, ...]:
    parts = entry if isinstance(entry, list) else [entry]
    try:
        if not parts:
            raise ValueError("nothing")
        return tuple(parse_code(part) for part in parts)
    except ValueError as error:
        raise InputError(
            f"the palette {path} gives {name!r} no colour",
            value=repr(entry),
            hint="write it as #rrggbb, or as the whole number that stands for it in the masks",
        ) from error


def _first(entry: Any) -> Any:
    return entry[0] if isinstance(entry, list) else entry
