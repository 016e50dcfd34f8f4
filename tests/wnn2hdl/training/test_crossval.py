from collections.abc import Sequence

import numpy as np
import pytest

from wnn2hdl.dataset import ColourHistogram, from_samples
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.accuracy import evaluate
from wnn2hdl.evaluation.classifiers import model_classifier
from wnn2hdl.ir import BitSelect, Neighbourhood, Tap, WisardModel
from wnn2hdl.training.bitselect import look_up_table
from wnn2hdl.training.crossval import (
    cross_validate,
    cross_validated,
    picture_shares_right,
    pixels_right,
)

ENCODER = BitSelect(("R7",))


def image(dark: tuple[int, int], bright: tuple[int, int]) -> ColourHistogram:
    """Pixels of (class 0, class 1) that are black and that are red."""
    return ColourHistogram(np.array([0x000000, 0xFF0000], np.uint32), np.array([dark, bright], np.int64).T)


def constant(answer: int) -> WisardModel:
    return look_up_table(ENCODER, ("a", "b"), np.full(2, answer), {})


def test_pixels_right_are_those_whose_class_the_model_names() -> None:
    model = look_up_table(ENCODER, ("a", "b"), np.array([0, 1]), {})
    assert pixels_right(model, image((5, 1), (2, 7))) == 5 + 7


@pytest.mark.parametrize("count", [2, 4, 5, 12])
def test_no_image_is_tested_by_a_model_that_saw_it_and_each_is_tested_once(count: int) -> None:
    images = [image((1, 0), (0, 1))] * count
    trained: list[set[int]] = []

    def train(chosen: Sequence[int]) -> WisardModel:
        trained.append(set(chosen))
        return constant(0)

    cross_validate(images, train)
    left_out = [set(range(count)) - chosen for chosen in trained]
    assert sorted(i for fold in left_out for i in fold) == list(range(count))
    assert len(left_out) == min(count, 5)


def test_accuracy_is_the_share_of_all_pixels() -> None:
    images = [image((90, 0), (0, 0)), image((0, 10), (0, 0))]
    assert cross_validate(images, lambda chosen: constant(0)) == 0.9


def test_one_image_cannot_be_cross_validated() -> None:
    with pytest.raises(InputError, match="needs two images: 1; give more"):
        cross_validate([image((1, 0), (0, 1))], lambda chosen: constant(0))


def test_other_light_moves_pixels_into_other_codes() -> None:
    model = look_up_table(BitSelect(("R7",)), ("dark", "bright"), np.array([0, 1]), {})
    picture = ColourHistogram(np.array([0x500000, 0x900000], dtype=np.uint32), np.array([[5, 0], [0, 7]]))
    found = [pixels_right(model, picture, exposure) for exposure in (0.5, 1.0, 1.7)]
    assert found == [5, 12, 7]
    right = cross_validated([picture, picture], lambda chosen: model, (0.5, 1.0, 1.7))
    assert right.tolist() == [found, found]


def test_shares_are_of_whole_pictures_whose_borders_are_repeated() -> None:
    dataset = from_samples(1, 48, seed=50)
    taps = tuple(Tap(row, 1, BitSelect(("R6", "B6")), 0b0111) for row in (0, 2))
    model = look_up_table(Neighbourhood(3, taps), dataset.classes, np.array([1, 0, 1, 0]), {})
    result = evaluate(model_classifier(model), dataset, lambda step, done, total: None)
    assert picture_shares_right(model, next(iter(dataset)))[1] == pytest.approx(result.accuracy)
