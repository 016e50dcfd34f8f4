"""A network lowered node by node answers as its model, whatever was shared or dropped on the way."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from tests.small_networks import WORDS, encoder_of, lut_network, wisard
from wnn2hdl.errors import InputError
from wnn2hdl.ir import codes_to_bits
from wnn2hdl.ir.models import Dynamic, LutGroupModel, SparseWisardModel
from wnn2hdl.lower.structural import core, known_bits, network


def all_words(model: LutGroupModel | SparseWisardModel, seed: int = 0) -> NDArray[np.int64]:
    """Every value of each feature, the others random: int64 ``[samples, features]``."""
    rng = np.random.default_rng(seed)
    values = np.arange(WORDS.lowest, WORDS.highest + 1)
    return np.concatenate(
        [np.where(np.arange(3) == f, values[:, None], rng.choice(values, (len(values), 3))) for f in range(3)]
    )


def answers(model: LutGroupModel | SparseWisardModel) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Classes by the circuit and by the model."""
    words = all_words(model)
    features = codes_to_bits(words & (1 << WORDS.bits) - 1, WORDS.bits).reshape(len(words), -1)
    found = network(model).evaluate({"features": features})["class_bits"]
    return found @ (1 << np.arange(found.shape[1])), model.evaluate(encoder_of(model).bits_of_words(words))


@given(st.integers(0, 10_000))
@settings(max_examples=40, deadline=None)
def test_tables_votes_and_winner_are_the_model(seed: int) -> None:
    for model in (
        lut_network(seed),
        lut_network(seed, layers=(10, 6)),
        wisard(seed),
        wisard(seed, ties="first"),
    ):
        found, expected = answers(model)
        assert np.array_equal(found, expected)


def test_the_encoder_makes_only_bits_that_are_read() -> None:
    model = lut_network(1)
    encoder = network(model).definitions()["encoder"]
    width = encoder.outputs[0].width
    assert width < model.encoder.width
    assert core(model).inputs[0].width == model.encoder.width


def test_thresholds_beyond_all_words_are_constant_and_equal_ones_are_one_bit() -> None:
    model = lut_network(0)
    levels = (-100.0, 0.01, 0.02, 100.0)
    encoder = replace(encoder_of(model), thresholds=(levels, (1.0,), (1.0,)), strict=False)
    assert known_bits(encoder) == {0: True, 2: 1, 3: False}


def test_a_threshold_found_anew_for_each_sample_is_no_circuit() -> None:
    with pytest.raises(InputError, match=r"threshold is found again for each sample.*--bleach"):
        core(replace(wisard(0), bleaching=Dynamic()))


def test_numbers_without_a_format_are_refused() -> None:
    model = lut_network(0)
    with pytest.raises(InputError, match="state the format of the words with --input"):
        network(replace(model, encoder=replace(encoder_of(model), input=None)))
