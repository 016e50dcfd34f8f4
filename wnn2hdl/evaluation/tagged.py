"""Pictures tagged as a whole: does the share called deforested separate cleared land from forest?"""

import csv
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.dataset import cleared_classes
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.accuracy import with_halo
from wnn2hdl.evaluation.classifiers import PictureClassifier
from wnn2hdl.evaluation.measures import percentile_bootstrap
from wnn2hdl.images import by_stem, read_picture, whole_windows
from wnn2hdl.progress import Progress, reported
from wnn2hdl.raster import Reading

COLUMNS = ("image_name", "tags")

FOREST = frozenset({"clear", "primary"})
"""The tags of a picture of untouched forest, no more and no fewer."""

CLEARED = frozenset(
    {
        "agriculture",
        "artisinal_mine",
        "bare_ground",
        "conventional_mine",
        "cultivation",
        "habitation",
        "road",
        "selective_logging",
        "slash_burn",
    }
)
"""Tags of land that is no longer forest, spelt as on the Planet chips."""

RULE = (
    "negative: tagged clear and primary alone; positive: tagged clear and any of "
    + ", ".join(sorted(CLEARED))
    + "; left out: not tagged clear (clouds, haze), or neither"
)

NOT_CLEAR = "not tagged clear"
NEITHER = "neither forest alone nor cleared"
"""Why a picture is left out."""


@dataclass(frozen=True)
class TaggedEvaluation:
    """The outcome over tagged pictures.

    Attributes:
        shares: of each picture used, the share of its valid pixels of classes that count as deforested.
        cleared: of the same pictures, whether the tags say so.
        left_out: pictures left out, by reason.
        auc: area under the ROC curve of the share as a score; None if one side has no picture.
        interval: of the area, by the percentile bootstrap of either side; None if it has fewer than two.
    """

    shares: dict[str, float]
    cleared: dict[str, bool]
    left_out: dict[str, int]
    auc: float | None
    interval: tuple[float, float] | None


def evaluate_tagged(
    classifier: PictureClassifier,
    chips: Path,
    tags: Path,
    seed: int,
    progress: Progress,
    reading: Reading = Reading(),  # noqa: B008  # frozen
) -> TaggedEvaluation:
    """Rank tagged pictures by the share of pixels that a classifier calls deforested; see `RULE`.

    Deforested are `cleared_classes`, as in a scan: a river was never felled.

    Args:
        classifier: what answers.
        chips: the folder of pictures.
        tags: a CSV file with the columns `COLUMNS`: the picture's stem, and its tags with blanks between.
        seed: of the bootstrap.
        progress: called with each picture read.
        reading: how pictures are read.

    Raises:
        InputError: the tags or a picture cannot be read, a picture holds no data, or a tagged picture is not
            in the folder, or there twice.
    """
    kinds = {name: kind(words) for name, words in read_tags(tags).items()}
    cleared = {name: found for name, found in kinds.items() if isinstance(found, bool)}
    left_out = Counter(found for found in kinds.values() if isinstance(found, str))
    files = by_stem(chips)
    counted = cleared_classes(classifier.classes)
    shares = {}
    for name in reported(cleared, "classifying chips", len(cleared), progress):
        if name not in files:
            raise InputError(
                f"there is no picture of this name in {chips}",
                value=name,
                hint="correct the file of tags",
            )
        picture = read_picture(files[name], reading)
        answers = classifier.classify(with_halo(picture.pixels, classifier.halo))
        used = whole_windows(picture.valid, classifier.halo)
        if not used.any():
            raise InputError("no pixel of the picture is data", value=files[name], hint="take it out")
        shares[name] = float(np.isin(answers[used], counted).mean())
    positive = np.array([share for name, share in shares.items() if cleared[name]])
    negative = np.array([share for name, share in shares.items() if not cleared[name]])
    auc = float(_auc(positive, negative)) if len(positive) and len(negative) else None
    return TaggedEvaluation(shares, cleared, dict(left_out), auc, _interval(positive, negative, seed))


def kind(tags: frozenset[str]) -> bool | str:
    """By `RULE`: cleared (True), forest (False), or the reason to leave the picture out."""
    if "clear" not in tags:
        return NOT_CLEAR
    if tags & CLEARED:
        return True
    return False if tags == FOREST else NEITHER


def read_tags(path: Path) -> dict[str, frozenset[str]]:
    """The tags of each picture, in the order of the file.

    Raises:
        InputError: the file cannot be read, has other columns, names a picture twice, or names none.
    """
    rows: dict[str, frozenset[str]] = {}
    try:
        with path.open(encoding="utf-8-sig", newline="") as stream:
            reader = csv.DictReader(stream, strict=True, restval="")
            columns = tuple(reader.fieldnames or ())
            if columns != COLUMNS:
                raise InputError(
                    "the file of tags has other columns",
                    value=f"{path} ({','.join(columns)})",
                    hint=f"its first line should be {','.join(COLUMNS)}",
                )
            for row in reader:
                if None in row:
                    raise InputError(
                        f"row {reader.line_num} of {path} has more than two columns",
                        value=",".join([*list(row.values())[:2], *row[None]]),
                        hint="put blanks between the tags",
                    )
                if row["image_name"] in rows:
                    raise InputError(
                        f"row {reader.line_num} of {path} repeats a picture", value=row["image_name"]
                    )
                rows[row["image_name"]] = frozenset(row["tags"].split())
    except OSError as error:
        raise InputError("cannot read the file of tags", value=f"{path} ({error.strerror})") from error
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError("the file of tags is not CSV text", value=f"{path} ({error})") from error
    if not rows:
        raise InputError("the file of tags has no rows", value=path, hint="add the tags of a picture")
    return rows


def _auc(positive: NDArray[np.float64], negative: NDArray[np.float64], axis: int = -1) -> NDArray[np.float64]:
    """The chance that a positive has a higher share than a negative, draws counting half.

    It is the area under the ROC curve (Hanley and McNeil 1982), here from ranks, so that all resamples are
    done at once: ``[..., n]`` and ``[..., m]`` to ``[...]``.
    """
    from scipy.stats import rankdata

    count, others = positive.shape[axis], negative.shape[axis]
    ranks = rankdata(np.concatenate([positive, negative], axis=axis), axis=axis)
    rank_sum = np.take(ranks, np.arange(count), axis=axis).sum(axis=axis)
    return np.asarray((rank_sum - count * (count + 1) / 2) / (count * others))


def _interval(
    positive: NDArray[np.float64], negative: NDArray[np.float64], seed: int
) -> tuple[float, float] | None:
    if min(len(positive), len(negative)) < 2:
        return None
    return percentile_bootstrap((positive, negative), _auc, seed)
