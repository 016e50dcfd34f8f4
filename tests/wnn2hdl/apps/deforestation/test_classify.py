"""One window: its classes are those that the whole picture gets there."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.classify import Method, classify_window, unpack
from wnn2hdl.apps.deforestation.cleanup import despeckle
from wnn2hdl.apps.deforestation.windows import Window
from wnn2hdl.evaluation.classifiers import PictureClassifier, model_classifier
from wnn2hdl.evaluation.squares import vote
from wnn2hdl.images import PlainPicture, whole_windows
from wnn2hdl.ir import WisardModel
from wnn2hdl.raster import NODATA


def by_windows(
    source: PlainPicture, classifier: PictureClassifier, method: Method, height: int, width: int
) -> tuple[NDArray[np.uint8], int, int]:
    """The whole picture's classes, window by window; valid and covered pixels."""
    classes = np.full((source.height, source.width), 99, dtype=np.uint8)
    valid = covered = 0
    for row in range(0, source.height, height):
        for column in range(0, source.width, width):
            size = min(height, source.height - row), min(width, source.width - column)
            window = Window(0, row, column, *size)
            result = classify_window(source, classifier, method, window)
            classes[row : row + size[0], column : column + size[1]] = unpack(result.packed, window)
            valid, covered = valid + result.valid, covered + result.covered
    return classes, valid, covered


def test_without_options_the_classifier_answers_alone(
    pixels: NDArray[np.uint8], red_model: WisardModel
) -> None:
    classifier = model_classifier(red_model)
    classes, valid, covered = by_windows(PlainPicture(pixels), classifier, Method(), 64, 50)
    assert np.array_equal(classes, pixels[..., 0] >= 96)
    assert valid == pixels[..., 0].size
    assert covered == (pixels[..., 0] >= 64).sum()
    assert 0 < covered < valid


def test_a_neighbourhood_sees_the_picture_beyond_its_window_and_repeated_borders(
    pixels: NDArray[np.uint8], neighbourhood: PictureClassifier
) -> None:
    padded = np.pad(pixels, ((2, 2), (2, 2), (0, 0)), mode="edge")
    classes, _, covered = by_windows(PlainPicture(pixels), neighbourhood, Method(), 31, 47)
    assert np.array_equal(classes, neighbourhood.classify(padded))
    assert covered == neighbourhood.answer(padded)[1].sum()


@settings(deadline=None, max_examples=30)
@given(
    square=st.one_of(st.none(), st.integers(1, 12)),
    smooth=st.integers(0, 5),
    share=st.floats(0.1, 1),
    rows=st.integers(1, 5),
    columns=st.integers(1, 5),
    clouded=st.booleans(),
)
def test_windows_change_nothing(
    pixels: NDArray[np.uint8],
    neighbourhood: PictureClassifier,
    square: int | None,
    smooth: int,
    share: float,
    rows: int,
    columns: int,
    clouded: bool,
) -> None:
    pixels = pixels[:70, :90]
    valid = np.random.default_rng(0).random(pixels.shape[:2]) < 0.99 if clouded else None
    expected = neighbourhood.classify(np.pad(pixels, ((2, 2), (2, 2), (0, 0)), mode="edge"))
    # What has a pixel in its neighbourhood that is no data is not classified.
    seen = None if valid is None else whole_windows(valid, 2)
    if square:
        expected = vote(expected, seen, side=square, share=share, seed=3, count=3)
    everywhere = np.ones(pixels.shape[:2], dtype=np.bool_) if seen is None else seen
    expected = np.where(everywhere, despeckle(expected, everywhere, smooth), NODATA)

    method = Method(square, share, 3, smooth)
    side = 12 // method.side * method.side
    found, count, _ = by_windows(
        PlainPicture(pixels, valid), neighbourhood, method, side * rows, side * columns
    )
    assert np.array_equal(found, expected)
    assert count == everywhere.sum()


@pytest.mark.parametrize(("square", "smooth", "margin"), [(None, 3, 3), (20, 3, 20), (2, 3, 4), (5, 0, 0)])
def test_the_margin_holds_whole_squares(square: int | None, smooth: int, margin: int) -> None:
    assert Method(square, smooth=smooth).margin == margin


def test_clouds_are_neither_classified_nor_counted(pixels: NDArray[np.uint8], red_model: WisardModel) -> None:
    valid = np.ones(pixels.shape[:2], dtype=np.bool_)
    valid[:, :100] = False
    classes, count, covered = by_windows(
        PlainPicture(pixels, valid), model_classifier(red_model), Method(square=20), 40, 60
    )
    assert (classes[:, :100] == NODATA).all()
    assert (classes[:, 100:] < 2).all()
    assert count == valid.sum()
    assert covered == (pixels[:, 100:, 0] >= 64).sum()
