"""Feature vectors with labels, from a CSV file."""

import csv
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError


@dataclass(frozen=True, eq=False)
class FeatureTable:
    """Samples of numbers, each with the name of its class.

    Attributes:
        columns: names of the features.
        features: float64 ``[samples, features]``, finite.
        labels: class name of each sample.
    """

    columns: tuple[str, ...]
    features: NDArray[np.float64]
    labels: tuple[str, ...]


def read_table(path: Path, label: str) -> FeatureTable:
    """Read a CSV file whose first line names the columns.

    Args:
        path: the file.
        label: the column of class names; all others are features.

    Raises:
        InputError: the file cannot be read, has no such column or no rows, names a column twice, or a row
            has another length, no label, or a feature that is not a finite number.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as stream:
            return _table(csv.reader(stream, strict=True), path, label)
    except OSError as error:
        raise InputError("cannot read a table", value=f"{path} ({error.strerror})") from error
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(
            "not a CSV table", value=f"{path} ({error})", hint="save it as UTF-8 text with commas"
        ) from error


def _table(lines: Iterator[list[str]], path: Path, label: str) -> FeatureTable:
    columns = [name.strip() for name in next(lines, [])]
    if label not in columns:
        raise InputError(
            "the table has no such column",
            value=f"{label} in {path}",
            hint=f"it has {', '.join(columns[:20])}",
        )
    if len(set(columns)) != len(columns) or len(columns) < 2:
        raise InputError("a table needs features, each with its own name", value=path)
    place = columns.index(label)
    labels, rows = [], []
    for number, row in enumerate(lines, 1):
        if not row:
            continue
        where = f"row {number} of {path}"
        if len(row) != len(columns) or not row[place].strip():
            raise InputError("a row has no label or another length than the first", value=where)
        labels.append(row.pop(place).strip())
        rows.append(_numbers(row, where))
    if not rows:
        raise InputError("the table has no rows", value=path)
    return FeatureTable(tuple(columns[:place] + columns[place + 1 :]), np.stack(rows), tuple(labels))


def _numbers(texts: list[str], where: str) -> NDArray[np.float64]:
    for text in texts:
        try:
            wrong = not math.isfinite(float(text))
        except ValueError:
            wrong = True
        if wrong:
            raise InputError(
                "a feature is not a finite number",
                value=f"{text[:40]!r} in {where}",
                hint="fill or drop such rows",
            )
    return np.array(texts, dtype=np.float64)
