"""Accuracy in changed light, and what speaks for other answers on brighter ground."""

import numpy as np
import pytest

from wnn2hdl.dataset import CLASSES, Dataset, LabelledImage
from wnn2hdl.encode import parse_bits
from wnn2hdl.evaluation.classifiers import PixelTable
from wnn2hdl.evaluation.light import (
    brighter_figures,
    brighter_warning,
    light_curve,
    steps,
    unread_high_bits,
    worst_image,
)
from wnn2hdl.images import UNLABELLED, Picture
from wnn2hdl.ir import Context, Neighbourhood, Relational, Tap


def silent(step: str, done: int, total: int) -> None:
    pass


def table(bits: str, answers: list[int]) -> PixelTable:
    return PixelTable(
        CLASSES, parse_bits(bits), np.array(answers, np.uint8), np.ones(len(answers), dtype=np.bool_)
    )


def reds(**images: list[int]) -> Dataset:
    """Images of grey pixels, in each of which the second half is deforested."""

    def load(name: str) -> LabelledImage:
        levels = np.array(images[name], dtype=np.uint8)
        labels = (np.arange(len(levels)) >= len(levels) // 2).astype(np.uint8)
        return LabelledImage(name, np.repeat(levels[:, np.newaxis], 3, axis=1), labels)

    return Dataset(CLASSES, tuple(sorted(images)), load)


def test_answers_are_compared_in_each_light() -> None:
    curve = light_curve(
        table("R7", [0, 1]), reds(a=[60, 200], b=[100, 120]), "exposure", (1.0, 1.2, 1.5), silent
    )
    # At 1.2 the clearing of b becomes bright enough, at 1.5 its forest, too.
    assert curve.shares == {1.0: 0.75, 1.2: 1.0, 1.5: 0.75}
    figures = curve.figures(seed=0)
    assert [point["value"] for point in figures] == [1.0, 1.2, 1.5]
    assert figures[0]["worst_image"] == {"name": "b", "accuracy": 0.5}
    low, high = figures[0]["interval"]
    assert low == 0.5
    assert high == 1.0


def test_haze_brightens_what_is_dark() -> None:
    curve = light_curve(table("R7", [0, 1]), reds(a=[0, 200]), "haze", (0.0, 0.4, 0.6), silent)
    assert curve.shares == {0.0: 1.0, 0.4: 1.0, 0.6: 0.5}


def test_of_a_scene_the_pixels_without_a_label_are_lit_and_not_counted() -> None:
    pixels = np.full((2, 2, 3), 100, dtype=np.uint8)
    picture = Picture(pixels, np.ones((2, 2), dtype=np.bool_))
    image = LabelledImage.of("a", picture, np.array([[0, 1], [UNLABELLED, 1]], dtype=np.uint8))
    curve = light_curve(
        table("R7", [0, 1]), Dataset(CLASSES, ("a",), lambda name: image), "exposure", (1.0, 2.0), silent
    )
    assert curve.shares == {1.0: pytest.approx(1 / 3), 2.0: pytest.approx(2 / 3)}
    assert curve.confusion.sum(axis=(1, 2, 3)).tolist() == [3, 3]


@pytest.mark.parametrize(
    ("low", "high", "quantity", "values"),
    [
        (0.8, 1.5, "exposure", (0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5)),
        (0.75, 1.25, "exposure", (0.75, 0.8, 0.85, 0.9, 0.95, 1.0, 1.05, 1.1, 1.15, 1.2, 1.25)),
        (0.97, 3.4, "exposure", (0.97, 1.0, 1.5, 2.0, 2.5, 3.0, 3.4)),
        (0.0, 0.1, "haze", (0.0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.08, 0.09, 0.1)),
        (0.001, 0.002, "haze", (0.001, 0.002)),
    ],
)
def test_a_range_is_walked_in_round_steps(
    low: float, high: float, quantity: str, values: tuple[float, ...]
) -> None:
    assert steps(low, high, quantity) == values


def test_the_worst_image_is_one_that_was_measured() -> None:
    confusion = np.array([[[0, 0], [0, 0]], [[3, 1], [0, 0]], [[4, 0], [0, 0]]])
    assert worst_image(("empty", "half", "whole"), confusion) == {"name": "half", "accuracy": 0.75}


def test_bits_above_those_that_are_read_wrap_around() -> None:
    assert unread_high_bits(parse_bits("R6,R5,B7")) == ("R7",)
    assert unread_high_bits(parse_bits("R7,G5")) == ("G7", "G6")
    assert unread_high_bits(Relational(("R7", "3R[6:0]>=4B[6:1]"))) == ("B7",)
    assert unread_high_bits(Context(("R7", "3x3(3R[6:0]>=4B[6:1])>=5"))) == ("B7",)
    assert unread_high_bits(Relational(("3R>=2B",))) == ()
    taps = (Tap(0, 0, parse_bits("R7"), 0b10), Tap(1, 1, parse_bits("R6"), 0b10))
    assert unread_high_bits(Neighbourhood(3, taps)) == ("R7",)


def test_a_classifier_that_brighter_ground_misleads_says_so_in_one_line() -> None:
    figures = brighter_figures({0.8: 0.2, 1.0: 0.9, 1.3: 0.5, 1.5: 0.88}, parse_bits("R6"))
    assert figures == {"exposure": 1.3, "accuracy": 0.5, "lost": 0.4, "unread_high_bits": ["R7"]}
    assert brighter_warning(figures) == (
        "brighter ground of the same kind may be answered differently: at x1.3 the light 50.00% of the "
        "pixels are right, 40.0 points fewer than at x1; R7 is not read, so levels wrap around"
    )
    assert brighter_warning(brighter_figures({}, parse_bits("R6,G6"))) == (
        "brighter ground of the same kind may be answered differently: "
        "R7, G7 are not read, so levels wrap around"
    )


def test_a_classifier_that_holds_its_ground_says_nothing() -> None:
    assert brighter_warning(brighter_figures({1.0: 0.9, 1.5: 0.89}, parse_bits("R7"))) == ""
