"""What the compiler learns from a folder of pictures: codes and windows that occur, and edges in them."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.edges import canny, filter_agreement, grey, learned, learned_under_budget
from wnn2hdl.edges.compare import Agreement
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.accuracy import with_halo
from wnn2hdl.evaluation.classifiers import model_classifier
from wnn2hdl.images import Picture, list_images, read_picture, whole_windows
from wnn2hdl.ir import WINDOW_CODES, EdgeFilter, WisardModel, picture_encoder, window_codes
from wnn2hdl.ir.window import SIDE, framed_window_codes
from wnn2hdl.lower.table import code_histogram
from wnn2hdl.progress import Progress, reported
from wnn2hdl.raster import Reading


@dataclass(frozen=True)
class Imagery:
    """A folder of pictures.

    Attributes:
        folder: where they lie.
        reading: how they are read.
    """

    folder: Path
    reading: Reading

    def pictures(self, progress: Progress) -> Iterator[Picture]:
        """Each picture, read when it is wanted; raises InputError if there is none or one is unreadable."""
        paths = list_images(self.folder)
        for path in reported(paths, f"reading {self.folder.name}", len(paths), progress):
            yield read_picture(path, self.reading)


@dataclass(frozen=True, eq=False)
class Survey:
    """What occurs in imagery.

    Attributes:
        codes: int64 ``[2**width]``, pixels or neighbourhoods of each code.
        windows: int64 ``[512]``, 3x3 windows of the model's answers; of a model that looks at neighbours
            where borders are counted.
        left_out: share of the pixels without data, or beside one where neighbours count, 0 to 1.
    """

    codes: NDArray[np.int64]
    windows: NDArray[np.int64]
    left_out: float


def survey(model: WisardModel, imagery: Imagery, progress: Progress, *, framed: bool = False) -> Survey:
    """Count the codes of a model in imagery, and the binary windows that it makes of it.

    Pixels and windows that are not all data are left out.

    Args:
        model: the model.
        imagery: the pictures.
        progress: called with each picture read.
        framed: count also what lies at the border of a picture, beyond which its nearest pixel is repeated.

    Raises:
        InputError: the folder holds no pictures, one cannot be read, none holds data, or the model is too
            wide for a table.
    """
    encoder = picture_encoder(model)
    foreground = model.evaluate_all_codes() != 0
    codes = code_histogram(encoder, ())
    windows = np.zeros(WINDOW_CODES, dtype=np.int64)
    counted = pixels = 0
    for picture in imagery.pictures(progress):
        whole = whole_windows(picture.valid, encoder.halo) if framed else _inside(picture, encoder.halo)
        found = encoder.codes(with_halo(picture.pixels, encoder.halo) if framed else picture.pixels)
        codes += np.bincount(found[whole], minlength=len(codes))
        counted, pixels = counted + int(whole.sum()), pixels + whole.size
        if framed:
            seen, inside = framed_window_codes(foreground[found]), whole_windows(whole, SIDE // 2)
        elif encoder.halo or min(picture.valid.shape) < SIDE:
            continue
        else:
            seen, inside = window_codes(foreground[found]), _inside(picture, SIDE // 2)
        windows += np.bincount(seen[inside], minlength=WINDOW_CODES)
    if not counted:
        raise InputError("no pixel of the pictures is data", value=imagery.folder, hint="give others")
    return Survey(codes, windows, 1 - counted / pixels)


def learn_edges(
    model: WisardModel, imagery: Imagery, count: int, luts: int | None, progress: Progress
) -> EdgeFilter:
    """The patterns of the model's answers that best predict Canny's edges in imagery.

    Args:
        model: binarises the pictures.
        imagery: the pictures.
        count: how many patterns.
        luts: only sets that fit this many LUTs are considered, 1 to 3; None sets no limit.
        progress: called with each picture read.
    """
    pairs = _edge_pairs(model, imagery, progress)
    return learned(pairs, count) if luts is None else learned_under_budget(pairs, luts, count)


def edge_agreement(
    edge_filter: EdgeFilter, model: WisardModel, imagery: Imagery, progress: Progress
) -> Agreement:
    """How far a filter's edges of the model's answers are Canny's, within one pixel."""
    return filter_agreement(edge_filter, _edge_pairs(model, imagery, progress))


def _edge_pairs(
    model: WisardModel, imagery: Imagery, progress: Progress
) -> Iterator[tuple[NDArray[np.bool_], NDArray[np.bool_]]]:
    """For each picture the model's answers and Canny's edges.

    Where there is no data both see the nearest data, so that its rim is not an edge.
    """
    classifier = model_classifier(model)
    for picture in imagery.pictures(progress):
        pixels = picture.pixels
        if picture.left_out:
            # Not at the top: whole pictures, and commands that read none, need not wait for it.
            from scipy.ndimage import distance_transform_edt

            nearest = distance_transform_edt(~picture.valid, return_distances=False, return_indices=True)
            pixels = pixels[tuple(nearest)]
        yield classifier.classify(with_halo(pixels, classifier.halo)) != 0, canny(grey(pixels))


def _inside(picture: Picture, halo: int) -> NDArray[np.bool_]:
    """Which windows that lie in a picture hold data alone, bool ``[height - 2 * halo, width - 2 * halo]``."""
    height, width = picture.valid.shape
    return whole_windows(picture.valid, halo)[halo : max(height - halo, 0), halo : max(width - halo, 0)]
