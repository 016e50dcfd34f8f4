"""Feature vectors with labels, from a CSV file or from NumPy arrays."""

import csv
import math
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

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
        grid: rows and columns, if each sample came as an array of two axes; its features are row by row.
    """

    columns: tuple[str, ...]
    features: NDArray[np.float64]
    labels: tuple[str, ...]
    grid: tuple[int, int] | None = None

    def owned(self) -> tuple[tuple[str, ...], NDArray[np.int64]]:
        """The class names in alphabetical order, and the class index of each sample, int64 ``[samples]``.

        Raises:
            InputError: all samples are of one class.
        """
        classes = tuple(sorted(set(self.labels)))
        if len(classes) < 2:
            raise InputError(
                "the table has one class only", value=classes[0], hint="give rows of another class"
            )
        return classes, np.searchsorted(classes, self.labels)


def read_table(path: Path, label: str | None, part: Literal["train", "test"] = "test") -> FeatureTable:
    """Read a CSV file whose first line names the columns, or the arrays of an ``.npz`` file.

    Args:
        path: the file, recognised by its content. Arrays are ``x_train`` and ``y_train``, or ``x_test`` and
            ``y_test``: numbers ``[samples, …]``, whose further axes are flattened, and a label each.
        label: of a CSV file the column of class names, all others being features; None for arrays.
        part: which of the arrays.

    Raises:
        InputError: the file cannot be read, has no such column or arrays or no rows, names a column twice,
            or a row has another length, no label, or a feature that is not a finite number; or a label
            column is named for arrays, or none for a CSV file.
    """
    try:
        if zipfile.is_zipfile(path):
            return _arrays(path, label, part)
        if label is None:
            raise InputError("which column has the labels?", value=path, hint="name it with --label")
        with path.open(encoding="utf-8-sig", newline="") as stream:
            return _table(csv.reader(stream, strict=True), path, label)
    except OSError as error:
        raise InputError("cannot read a table", value=f"{path} ({error.strerror})") from error
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(
            "not a CSV table", value=f"{path} ({error})", hint="save it as UTF-8 text with commas"
        ) from error


def _arrays(path: Path, label: str | None, part: str) -> FeatureTable:
    if label is not None:
        raise InputError("arrays have no columns", value=f"--label {label}", hint="leave --label out")
    names = (f"x_{part}", f"y_{part}")
    try:
        # Nothing is unpickled, so nothing in the file is run.
        with np.load(path, allow_pickle=False) as arrays:
            missing = [name for name in names if name not in arrays]
            if missing:
                raise InputError(
                    "the file has no such array",
                    value=f"{missing[0]} in {path}",
                    hint=f"it has {', '.join(list(arrays)[:20])}",
                )
            features, labels = (arrays[name] for name in names)
    except (ValueError, EOFError, zipfile.BadZipFile) as error:
        raise InputError("not a file of NumPy arrays", value=f"{path} ({error})") from error
    if features.dtype.kind not in "biuf" or labels.dtype.kind not in "biuU":
        raise InputError(
            "features must be numbers, and labels whole numbers or texts",
            value=f"{features.dtype} and {labels.dtype} in {path}",
        )
    if features.ndim < 2 or not features.size or labels.shape != features.shape[:1]:
        raise InputError(
            "there must be one label for each row of features",
            value=f"shapes {list(features.shape)} and {list(labels.shape)} in {path}",
        )
    rows = features.reshape(len(features), -1).astype(np.float64)
    if not np.isfinite(rows).all():
        raise InputError("a feature is not a finite number", value=path, hint="fill or drop such rows")
    columns = tuple(f"x{position}" for position in range(rows.shape[1]))
    grid = features.shape[1:] if features.ndim == 3 else None
    return FeatureTable(columns, rows, tuple(map(str, labels.tolist())), grid)


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
