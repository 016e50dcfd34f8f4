"""Training of classifiers that count bits in the square around a pixel."""

from dataclasses import replace

import numpy as np
import pytest

from wnn2hdl.dataset import Dataset, LabelledImage, from_samples
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.accuracy import evaluate
from wnn2hdl.evaluation.classifiers import model_classifier
from wnn2hdl.images import UNLABELLED, Picture
from wnn2hdl.ir import Context, WisardModel
from wnn2hdl.training.budget import LIGHT, NESTED
from wnn2hdl.training.context import _draw, _logits, _right_outside, train_context


def silent(step: str, done: int, total: int) -> None:
    pass


@pytest.fixture(scope="module")
def trained() -> WisardModel:
    return train_context(from_samples(4, 96, seed=1), 7, seed=0, progress=silent)


def test_a_trained_classifier_counts_two_bits_and_answers_for_other_landscapes(trained: WisardModel) -> None:
    encoder = trained.encoder
    assert isinstance(encoder, Context)
    assert (encoder.width, encoder.halo, encoder.widths) == (8, 3, (1, 1, 6, 6))
    result = evaluate(model_classifier(trained), from_samples(3, 96, seed=50), silent)
    assert result.accuracy > 0.87
    assert trained.training["images"] == [f"landscape-{seed:05d}" for seed in range(1, 5)]


def test_its_promise_is_made_by_other_images_than_those_that_choose(trained: WisardModel) -> None:
    figures = trained.training[LIGHT]
    assert list(figures) == ["0.8", "1", "1.25", "1.5"]
    assert 0.7 < figures["1"]["worst_image"] <= figures["1"]["accuracy"] <= 1
    assert len(trained.training[NESTED]) == 4


def test_the_seed_decides_the_pixels_that_are_drawn() -> None:
    image = next(iter(from_samples(1, 64, seed=1)))
    one, again, other = (_draw(image, 3, np.random.default_rng(seed)) for seed in (0, 0, 1))
    assert np.array_equal(one.sums, again.sums)
    assert not np.array_equal(one.sums, other.sums)
    assert one.sums.max() == 9
    assert one.own.shape == one.sums.shape


def test_the_table_answers_as_a_regression_on_the_bits() -> None:
    # Bit 0 decides, bit 1 says nothing; code 3 was never seen.
    counted = np.array([[900, 100, 450, 0], [100, 900, 50, 0]])
    assert (_logits(counted) > 0).tolist() == [False, True, False, True]
    assert _logits(counted)[2] == pytest.approx(np.log(1 / 9), abs=0.02)


def test_bits_are_judged_on_images_that_the_regression_has_not_seen() -> None:
    one = np.array([[100, 0], [0, 100]])
    opposed = np.stack([one, one[::-1]])
    assert _right_outside(opposed) == 0
    assert _right_outside(np.stack([one, one])) == 1
    assert _right_outside(one[np.newaxis]) == 1


def test_pixels_that_are_not_labelled_are_not_drawn() -> None:
    pixels = np.full((40, 40, 3), 10, dtype=np.uint8)
    classes = np.full((40, 40), UNLABELLED, dtype=np.uint8)
    classes[:4] = 1
    valid = np.ones((40, 40), dtype=np.bool_)
    samples = _draw(LabelledImage.of("a", Picture(pixels, valid), classes), 3, np.random.default_rng(0))
    assert set(samples.labels.tolist()) == {1}
    nothing = LabelledImage.of("a", Picture(pixels, ~valid), classes)
    assert not len(_draw(nothing, 3, np.random.default_rng(0)).labels)


def test_what_no_context_can_be_trained_on_is_refused() -> None:
    with pytest.raises(InputError, match="three images at least: 2"):
        train_context(from_samples(2, 32, seed=0), 7, seed=0, progress=silent)
    with pytest.raises(InputError, match="smaller than the square: landscape-00000 of 8x8"):
        train_context(from_samples(3, 8, seed=0), 15, seed=0, progress=silent)
    dataset = from_samples(3, 32, seed=0)
    with pytest.raises(InputError, match="two classes: a, b, c"):
        train_context(replace(dataset, classes=("a", "b", "c")), 7, seed=0, progress=silent)
    some = LabelledImage("some", np.zeros((5, 3), np.uint8), np.zeros(5, np.uint8))
    parts = Dataset(("forest", "deforested"), ("a", "b", "c"), lambda _: some)
    with pytest.raises(InputError, match="only some pixels"):
        train_context(parts, 7, seed=0, progress=silent)
    forest = LabelledImage("forest", np.zeros((64, 3), np.uint8), np.zeros(64, np.uint8), (8, 8))
    with pytest.raises(InputError, match="a class has no training pixels: deforested"):
        train_context(replace(parts, load=lambda _: forest), 7, seed=0, progress=silent)
