"""Answers against labels: pixels, neighbourhoods and squares."""

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.dataset import CLASSES, Dataset, LabelledImage, from_samples
from wnn2hdl.encode import parse_bits
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.accuracy import Squares, evaluate, majority_labels, with_halo
from wnn2hdl.evaluation.classifiers import PixelTable, model_classifier
from wnn2hdl.images import Picture
from wnn2hdl.ir import WisardModel


def silent(step: str, done: int, total: int) -> None:
    pass


def red_table(answers: list[int], classes: tuple[str, ...] = CLASSES) -> PixelTable:
    """What answers for dark red and for bright red; it knows the dark one only."""
    return PixelTable(classes, parse_bits("R7"), np.array(answers, np.uint8), np.array([True, False]))


def one_image(reds: list[list[int]], labels: list[list[int]], *, whole: bool = True) -> Dataset:
    pixels = np.zeros((np.size(reds), 3), dtype=np.uint8)
    pixels[:, 0] = np.ravel(reds)
    shape = (len(reds), len(reds[0])) if whole else None
    image = LabelledImage("a", pixels, np.ravel(labels).astype(np.uint8), shape)
    return Dataset(CLASSES, ("a",), lambda name: image)


class LeftNeighbour:
    """Deforested where the pixel to the left is bright."""

    classes = CLASSES
    halo = 1

    def classify(self, picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
        return (picture[1:-1, :-2, 0] > 127).astype(np.uint8)

    def answer(self, picture: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
        classes = self.classify(picture)
        return classes, np.ones(classes.shape, dtype=np.bool_)


def test_pixels_are_counted_by_true_class_and_answer() -> None:
    data = one_image([[0, 0, 255], [255, 255, 0]], [[0, 1, 0], [1, 0, 0]])
    result = evaluate(red_table([0, 1]), data, silent)
    # Of the forest two pixels are called deforested, of the clearing one is called forest.
    assert result.confusion.tolist() == [[[2, 2], [1, 1]]]
    assert result.accuracy == 3 / 6
    assert result.coverage == 3 / 6


def test_pixels_that_make_no_picture_are_enough_for_a_classifier_of_pixels() -> None:
    data = one_image([[0, 255]], [[0, 1]], whole=False)
    assert evaluate(red_table([0, 1]), data, silent).accuracy == 1
    with pytest.raises(InputError, match="neighbours are needed"):
        evaluate(LeftNeighbour(), data, silent)


def test_a_neighbourhood_sees_the_border_repeated() -> None:
    data = one_image([[255, 0, 0], [0, 255, 0]], [[1, 1, 0], [0, 0, 1]])
    assert evaluate(LeftNeighbour(), data, silent).accuracy == 1
    picture = np.arange(12, dtype=np.uint8).reshape(2, 2, 3)
    assert with_halo(picture, 2)[:, :, 0].tolist() == [[0, 0, 0, 3, 3, 3]] * 3 + [[6, 6, 6, 9, 9, 9]] * 3


def partly(reds: list[list[int]], labels: list[list[int]], valid: list[list[int]]) -> Dataset:
    """An image; pixels of the label 255 are not labelled."""
    pixels = np.zeros((*np.shape(reds), 3), dtype=np.uint8)
    pixels[..., 0] = reds
    picture = Picture(pixels, np.array(valid, dtype=np.bool_))
    image = LabelledImage.of("a", picture, np.array(labels, dtype=np.uint8))
    return Dataset(CLASSES, ("a",), lambda name: image)


def test_what_is_left_out_is_neither_right_nor_wrong() -> None:
    data = partly([[0, 255, 255], [0, 0, 255]], [[0, 0, 255], [0, 1, 1]], [[1, 1, 1], [1, 0, 1]])
    result = evaluate(red_table([0, 1]), data, silent)
    assert result.confusion.tolist() == [[[2, 1], [0, 1]]]
    assert result.left_out.tolist() == [2]
    assert result.left_out_share == 2 / 6


def test_neighbours_must_be_data_and_need_no_label() -> None:
    data = partly([[255, 0, 0, 0, 0]] * 3, [[255, 1, 0, 0, 0]] * 3, [[1, 1, 1, 1, 0]] * 3)
    result = evaluate(LeftNeighbour(), data, silent)
    # The fourth column is beside one that is no data.
    assert result.confusion.tolist() == [[[3, 0], [0, 3]]]
    assert result.left_out.tolist() == [9]


def test_only_data_votes_in_squares_and_only_labels_make_their_truth() -> None:
    data = partly(
        [[255, 255], [255, 0]],
        [[0, 255], [255, 0]],
        [
            [
                0,
                0,
            ],
            [0, 1],
        ],
    )
    squares = Squares(side=2, share=1.0, seed=0)
    assert evaluate(red_table([0, 1]), data, silent, squares).confusion.tolist() == [[[1, 0], [0, 0]]]
    labelled = partly([[0, 0], [0, 0]], [[1, 255], [255, 255]], [[1, 1], [1, 1]])
    assert majority_labels(labelled, 2).load("a").labels.tolist() == [1]


def test_images_without_a_label_are_refused() -> None:
    with pytest.raises(InputError, match="no pixel can be measured"):
        evaluate(red_table([0, 1]), partly([[0]], [[255]], [[1]]), silent)


def test_squares_go_with_the_majority_of_their_pixels() -> None:
    data = one_image([[0, 0, 255], [0, 255, 255]], [[0, 0, 1], [0, 1, 0]])
    squares = Squares(side=2, share=1.0, seed=0)
    # Pixel by pixel two are wrong; of the squares none, the draw of labels in the right one aside.
    assert evaluate(red_table([0, 1]), data, silent, squares).confusion.tolist() == [[[3, 1], [1, 1]]]
    assert majority_labels(data, 2).load("a").label_picture.tolist() == [[0, 0, 0], [0, 0, 0]]


def test_a_share_of_the_pixels_votes_as_the_seed_draws_it() -> None:
    reds = np.zeros((40, 40), dtype=np.int64)
    reds[::2] = 255
    data = one_image(reds.tolist(), (np.arange(1600).reshape(40, 40) // 20 % 2).tolist())
    votes = [
        evaluate(red_table([0, 1]), data, silent, Squares(side=20, share=0.5, seed=seed)).confusion.tolist()
        for seed in (0, 0, *range(1, 9))
    ]
    assert votes[0] == votes[1]
    assert any(vote != votes[0] for vote in votes)


def test_other_classes_than_the_labels_are_refused() -> None:
    data = one_image([[0]], [[0]])
    with pytest.raises(InputError, match="different classes: forest, burnt soil, river / forest, deforested"):
        evaluate(red_table([0, 1], ("forest", "burnt soil", "river")), data, silent)
    with pytest.raises(InputError, match="different classes"):
        evaluate(red_table([0, 1], ("deforested", "forest")), data, silent)


def test_images_are_evaluated_one_by_one(model: WisardModel) -> None:
    result = evaluate(model_classifier(model), from_samples(2, 96, seed=50), silent)
    assert result.names == ("landscape-00050", "landscape-00051")
    assert result.confusion.sum(axis=(1, 2)).tolist() == [96 * 96] * 2
    assert result.accuracy > 0.8
