"""What a folder of pictures tells the compiler: the codes and windows that occur, and the edges in them."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.edges import canny, filter_agreement, grey, learned, learned_under_budget
from wnn2hdl.edges.compare import Agreement
from wnn2hdl.images import list_images, read_rgb
from wnn2hdl.ir import WINDOW_CODES, EdgeFilter, PictureEncoder, WisardModel, pixel_encoder
from wnn2hdl.lower.table import code_histogram, window_histogram
from wnn2hdl.progress import Progress, reported
from wnn2hdl.wisard import PixelClassifier


@dataclass(frozen=True, eq=False)
class Survey:
    """What occurs in imagery.

    Attributes:
        codes: int64 ``[2**width]``, pixels of each code.
        windows: int64 ``[512]``, 3x3 windows of the model's answers.
    """

    codes: NDArray[np.int64]
    windows: NDArray[np.int64]


def survey(model: WisardModel, folder: Path, progress: Progress) -> Survey:
    """Count the pixel codes in a folder of pictures, and the binary windows that the model makes of them.

    Raises:
        InputError: the folder holds no pictures, or one cannot be read.
    """
    encoder, classifier = pixel_encoder(model), PixelClassifier(model)
    codes = np.zeros(1 << encoder.width, dtype=np.int64)
    windows = np.zeros(WINDOW_CODES, dtype=np.int64)
    for picture in _pictures(folder, progress):
        codes += code_histogram(encoder, [picture])
        windows += window_histogram([classifier.classify(picture) != 0])
    return Survey(codes, windows)


def survey_codes(encoder: PictureEncoder, folder: Path, progress: Progress) -> NDArray[np.int64]:
    """Count the codes in a folder of pictures, int64 ``[2**width]``; raises as `survey` does."""
    return code_histogram(encoder, _pictures(folder, progress))


def learn_edges(
    model: WisardModel, folder: Path, count: int, luts: int | None, progress: Progress
) -> EdgeFilter:
    """The patterns of the model's answers that best predict Canny's edges in a folder of pictures.

    Args:
        model: binarises the pictures.
        folder: the pictures.
        count: how many patterns.
        luts: only sets that fit so many LUTs are looked at, 1 to 3; None sets no limit.
        progress: told of each picture read.
    """
    pairs = _edge_pairs(model, folder, progress)
    return learned(pairs, count) if luts is None else learned_under_budget(pairs, luts, count)


def edge_agreement(
    edge_filter: EdgeFilter, model: WisardModel, folder: Path, progress: Progress
) -> Agreement:
    """How far a filter's edges of the model's answers are Canny's, within one pixel."""
    return filter_agreement(edge_filter, _edge_pairs(model, folder, progress))


def _edge_pairs(
    model: WisardModel, folder: Path, progress: Progress
) -> Iterator[tuple[NDArray[np.bool_], NDArray[np.bool_]]]:
    classifier = PixelClassifier(model)
    for picture in _pictures(folder, progress):
        yield classifier.classify(picture) != 0, canny(grey(picture))


def _pictures(folder: Path, progress: Progress) -> Iterator[NDArray[np.uint8]]:
    paths = list_images(folder)
    yield from map(read_rgb, reported(paths, f"reading {folder.name}", len(paths), progress))
