"""The lines of a pose log: a strict CSV, whose near misses are named rather than guessed at."""

import csv
import re
from collections.abc import Iterator, Mapping, Sequence
from difflib import get_close_matches
from pathlib import Path

from wnn2hdl.errors import InputError

COLUMNS = (
    "frame",
    "latitude_deg",
    "longitude_deg",
    "height_above_ground_m",
    "yaw_deg",
    "pitch_deg",
    "roll_deg",
)
"""The columns of a file of poses; others are left out. Where a position is not known, its two are empty."""

POSITION = ("latitude_deg", "longitude_deg")

_NAMES_OF_OTHERS: Mapping[str, frozenset[str]] = {
    "frame": frozenset({"file", "filename", "image", "img", "photo", "picture", "frames"}),
    "latitude_deg": frozenset({"lat", "latitude"}),
    "longitude_deg": frozenset({"lon", "lng", "long", "longitude"}),
    "height_above_ground_m": frozenset({"alt", "altitude", "height", "agl", "amsl", "elevation"}),
    "yaw_deg": frozenset({"yaw", "heading", "hdg", "azimuth", "kappa"}),
    "pitch_deg": frozenset({"pitch", "phi"}),
    "roll_deg": frozenset({"roll", "omega"}),
}
"""Words in the headers of other programs' logs."""

_MEANING = {
    "height_above_ground_m": "if it holds metres above the ground, not above sea level",
    "yaw_deg": "if it holds degrees clockwise from north",
    "pitch_deg": "if it holds degrees with the aircraft's nose up, 0 for level flight",
    "roll_deg": "if it holds degrees with the right side down",
}

_NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")
_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+")


def read_rows(path: Path) -> Iterator[tuple[str, dict[str, str]]]:
    """Each line of a CSV whose first line names `COLUMNS`, in any order among others.

    Both columns of the position may be missing together. Blanks around names and values do not count, and
    neither do lines without any value.

    Yields:
        where the line stands, for complaints, and its values by the names of the columns.

    Raises:
        InputError: the file cannot be read or is not CSV; a column is missing or named twice; a line has more
            or fewer cells than the first.
    """
    try:
        with path.open(newline="", encoding="utf-8-sig") as stream:
            reader = csv.reader(stream, strict=True)
            names = [name.strip() for name in next(reader, [])]
            _check_names(path, names)
            for cells in reader:
                values = [cell.strip() for cell in cells]
                if any(values):
                    where = f"line {reader.line_num} of {path}"
                    _check_length(where, names, values)
                    yield where, dict(zip(names, values, strict=True))
    except OSError as error:
        raise InputError("cannot read the poses", value=f"{path} ({error.strerror})") from error
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(
            "the poses are not CSV", value=f"{path} ({error})", hint="save them as CSV in UTF-8"
        ) from error


def number(text: str, name: str, where: str) -> float:
    """A cell as a number.

    Raises:
        InputError: it is not a number as programs write it everywhere: digits and a decimal point.
    """
    if _NUMBER.fullmatch(text):
        return float(text)
    hint = ""
    if "," in text:
        hint = "write decimals with a point"
    elif re.search("[°'\"NSEWnsew]", text) and re.search("[0-9]", text):
        hint = "write decimal degrees, negative in the south and in the west"
    raise InputError(f"{where}: {name} is not a number", value=repr(text), hint=hint)


def _check_names(path: Path, names: Sequence[str]) -> None:
    separators = {";": "semicolons", "\t": "tabs"} if len(names) == 1 else {}
    if other := next((word for mark, word in separators.items() if mark in names[0]), None):
        raise InputError(
            f"the poses have {other} between their cells",
            value=path,
            hint="save them with commas between cells, and decimals with points",
        )
    twice = [name for name in COLUMNS if names.count(name) > 1]
    if twice:
        raise InputError(
            f"the poses {path} name a column twice",
            value=", ".join(twice),
            hint="keep the one that is meant",
        )
    missing = [name for name in COLUMNS if name not in names]
    alike = {name: found for name in missing if (found := _alike(name, names))}
    if {*missing} == {*POSITION} and not alike:
        return
    if missing:
        renamed = [
            " ".join(filter(None, [f"rename {found} to {name}", _MEANING.get(name, "")]))
            for name, found in alike.items()
        ]
        raise InputError(
            f"the poses {path} lack a column",
            value=", ".join(missing),
            hint=" and ".join(renamed) or f"the first line names {','.join(COLUMNS)}",
        )


def _alike(name: str, names: Sequence[str]) -> str | None:
    """A header that is probably meant for a missing column, by its words or its spelling."""
    others = [other for other in names if other not in COLUMNS]
    for other in others:
        if {word.lower() for word in _WORD.findall(other)} & _NAMES_OF_OTHERS[name]:
            return other
    spelt = {other.lower(): other for other in others}
    close = get_close_matches(name, spelt, n=1, cutoff=0.85)
    return spelt[close[0]] if close else None


def _check_length(where: str, names: Sequence[str], values: Sequence[str]) -> None:
    if len(values) < len(names):
        raise InputError(
            f"{where} ends before the column {names[len(values)]}",
            value=f"{len(values)} cells, not {len(names)}",
            hint="give every line all cells, empty where a value is not known",
        )
    if len(values) > len(names):
        raise InputError(
            f"{where} has more cells than columns are named, the first too many",
            value=f"{values[len(names)]!r}, cell {len(names) + 1}",
            hint="put quotes around a text with a comma, and write decimals with a point",
        )
