"""Bits that can be read, and models that read them."""

import numpy as np
import pytest

from wnn2hdl.errors import InputError
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.training.gradient.inputs import choose_inputs
from wnn2hdl.training.gradient.layer import VotingLayer

BYTE = FixedPoint.parse("UQ8.0")


def test_the_most_significant_bit_comes_first_and_quantiles_after() -> None:
    features = np.stack([np.arange(256), np.arange(256) / 4, np.full(256, 7)], axis=1)
    one = choose_inputs(features, BYTE, 1, None)
    assert one.encoder.thresholds == ((128.0,), (32.0,), ())
    assert one.luts.tolist() == [0, 1]
    three = choose_inputs(features, BYTE, 3, None)
    assert three.encoder.thresholds == ((84.0, 128.0, 168.0), (16.0, 32.0, 47.0), ())
    assert three.luts.tolist() == [1, 0, 1, 1, 1, 1]


def test_the_sign_of_a_signed_word_is_free() -> None:
    features = np.linspace(-2, 2, 100)[:, np.newaxis]
    inputs = choose_inputs(features, FixedPoint.parse("Q3.12"), 1, None)
    assert inputs.encoder.thresholds == ((0.0,),)
    assert inputs.luts.tolist() == [0]


def test_blocks_of_a_picture_are_ors_of_four_pixels() -> None:
    rng = np.random.default_rng(0)
    pictures = rng.integers(0, 256, (60, 3, 4)).astype(np.float64)
    inputs = choose_inputs(pictures.reshape(60, 12), BYTE, 1, (3, 4))
    assert inputs.width == 12 + 6
    assert inputs.luts.tolist() == [0] * 12 + [1] * 6
    bright = pictures >= 128
    rows = inputs.rows(pictures.reshape(60, 12))
    assert np.array_equal(rows[:12], bright.reshape(60, 12).T)
    assert np.array_equal(rows[12], bright[:, :2, :2].any(axis=(1, 2)))
    assert np.array_equal(rows[17], bright[:, 1:, 2:].any(axis=(1, 2)))


def test_a_dark_pixel_of_a_block_that_varies_gets_its_threshold() -> None:
    pictures = np.random.default_rng(1).integers(0, 256, (60, 4)).astype(np.float64)
    pictures[:, 0] = 0
    inputs = choose_inputs(pictures, BYTE, 1, (2, 2))
    assert inputs.encoder.thresholds == ((128.0,),) * 4
    assert np.array_equal(inputs.rows(pictures)[4], (pictures >= 128).any(axis=1))


@pytest.mark.parametrize("reads_blocks", [False, True])
def test_a_model_has_only_what_is_read_and_answers_as_the_layer(reads_blocks: bool) -> None:
    rng = np.random.default_rng(2)
    pictures = rng.integers(0, 256, (200, 16)).astype(np.float64)
    inputs = choose_inputs(pictures, BYTE, 2, (4, 4))
    first, last = (20, inputs.width) if reads_blocks else (3, 12)
    weights = rng.uniform(-1, 1, (6, 64)).astype(np.float32)
    layer = VotingLayer(rng.integers(first, last, (6, 6)), weights, classes=3)
    model = inputs.model(layer, ("a", "b", "c"))
    assert len(model.layers) == 1 + reads_blocks
    assert model.encoder.width < inputs.encoder.width
    answers = model.evaluate(model.encoder.bits(pictures))
    assert np.array_equal(answers, layer.predict(inputs.rows(pictures)))
    assert len(np.unique(answers)) == 3


def test_what_cannot_be_read_is_refused() -> None:
    with pytest.raises(InputError, match=r"no feature tells samples apart in this format of words: UQ8\.0"):
        choose_inputs(np.random.default_rng(0).random((50, 3)), BYTE, 4, None)
    with pytest.raises(InputError, match="another number of pixels than there are features: 3x5, not 16"):
        choose_inputs(np.zeros((5, 16)), BYTE, 1, (3, 5))
