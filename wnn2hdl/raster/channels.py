"""Which bands of a raster are red, green and blue: what the file states or the user says, never a guess."""

from dataclasses import dataclass
from pathlib import Path

from wnn2hdl.errors import InputError

_COLOURS = ("red", "green", "blue")


@dataclass(frozen=True)
class Channels:
    """Bands to read.

    Attributes:
        indexes: band numbers from 1: of red, green and blue, or of the one band that stands for all three.
        palette: whether that one band holds indices of the file's colour table.
        note: what had to be assumed, for the summary; empty if nothing.
    """

    indexes: tuple[int, ...]
    palette: bool = False
    note: str = ""


def choose_channels(
    path: Path,
    interpretations: tuple[str, ...],
    descriptions: tuple[str | None, ...] = (),
    bands: tuple[int, ...] | None = None,
) -> Channels:
    """Choose the bands.

    Args:
        path: the file, for errors.
        interpretations: GDAL's colour interpretation of each band: ``red``, ``gray``, ``undefined`` …
        descriptions: the name that each band is given, such as ``Red``; None for a band without one.
        bands: the user's choice: three bands, or one.

    Raises:
        InputError: the user names bands that do not exist, or the file does not say which bands to take, or
            says it in two ways that differ.
    """
    count = len(interpretations)
    if bands is not None:
        _check_choice(path, bands, count)
        return Channels(bands, palette=len(bands) == 1 and interpretations[bands[0] - 1] == "palette")
    stated = [_of_colours(interpretations), _of_colours([(x or "").strip().lower() for x in descriptions])]
    found = {indexes for indexes in stated if indexes}
    if len(found) > 1:
        raise InputError(
            "the colours and the names of the file's bands differ",
            value=f"{path} ({', '.join(interpretations)} / {', '.join(str(x) for x in descriptions)})",
            hint="give --bands RED,GREEN,BLUE, as in --bands 3,2,1",
        )
    if found:
        return Channels(found.pop())
    opaque = tuple(name for name in interpretations if name != "alpha")
    if len(opaque) == 1 and interpretations[0] != "alpha":
        return Channels((1,), palette=opaque[0] == "palette")
    if count == 3 and set(interpretations) <= {"gray", "undefined"}:
        return Channels((1, 2, 3), note="the file does not name its three bands; taken as red, green, blue")
    raise InputError(
        f"the file does not say which of its {count} bands are red, green and blue",
        value=f"{path} ({', '.join(interpretations)})",
        hint="give --bands RED,GREEN,BLUE, as in --bands 3,2,1",
    )


def _of_colours(names: list[str] | tuple[str, ...]) -> tuple[int, ...]:
    """The bands whose names are those of the three colours, if each colour has just one."""
    if any(names.count(colour) != 1 for colour in _COLOURS):
        return ()
    return tuple(names.index(colour) + 1 for colour in _COLOURS)


def _check_choice(path: Path, bands: tuple[int, ...], count: int) -> None:
    if len(bands) not in (1, 3):
        raise InputError(
            "one band or three are read", value=",".join(map(str, bands)), hint="as in --bands 3,2,1"
        )
    if not all(1 <= band <= count for band in bands):
        raise InputError(
            f"the file has bands 1 to {count}",
            value=f"{path} (asked for {','.join(map(str, bands))})",
            hint="name others with --bands",
        )
