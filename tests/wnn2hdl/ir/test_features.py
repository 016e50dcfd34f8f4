import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.ir import Encoder, FixedPoint, Thermometer, ThermometerBits, Words
from wnn2hdl.ir.encoder import encoder_from_json

finite = st.floats(allow_nan=False, allow_infinity=False)
levels = st.lists(finite, max_size=5).map(lambda values: tuple(sorted(values)))
formats = st.builds(FixedPoint, st.integers(1, 48), st.integers(0, 64), st.booleans())
thermometers = st.builds(
    Thermometer,
    st.lists(levels, min_size=1, max_size=4).filter(any).map(tuple),
    st.booleans(),
    st.none() | formats,
)
words = st.builds(Words, st.integers(1, 9), st.integers(1, 16))
bits = st.builds(ThermometerBits, st.integers(1, 9), st.integers(1, 9))

Q3_12 = FixedPoint(bits=16, fraction=12)


@given(thermometers, formats, st.data())
def test_words_give_the_bits_of_the_numbers_they_stand_for(
    encoder: Thermometer, words: FixedPoint, data: st.DataObject
) -> None:
    near = [
        min(max(level + step, words.lowest), words.highest)
        for levels in replace(encoder, input=words).levels
        for level in levels
        for step in (-1, 0)
    ]
    word = st.sampled_from(near) | st.integers(words.lowest, words.highest)
    row = np.array([data.draw(st.lists(word, min_size=encoder.features, max_size=encoder.features))])
    numbers = words.values(row)
    fixed = replace(encoder, input=words)
    assert np.array_equal(fixed.bits_of_words(row), replace(encoder, input=None).bits(numbers))
    assert np.array_equal(fixed.bits_of_words(row), fixed.bits(numbers))


def test_thermometer_bits_are_feature_major() -> None:
    encoder = Thermometer(((1.0, 2.0), (), (0.5,)))
    assert encoder.names == ("x0_t0", "x0_t1", "x2_t0")
    assert encoder.bits([[1.0, 9.0, 0.4], [2.5, 9.0, 0.5]]).tolist() == [
        [True, False, False],
        [True, True, True],
    ]


def test_a_strict_thermometer_leaves_out_the_threshold_itself() -> None:
    encoder = Thermometer(((1.0, 1.0, 2.0),), strict=True)
    assert encoder.bits([[1.0], [1.5]]).tolist() == [[False] * 3, [True, True, False]]


@given(thermometers, st.data())
def test_thermometer_bits_of_a_feature_never_rise(encoder: Thermometer, data: st.DataObject) -> None:
    real = replace(encoder, input=None)
    row = data.draw(st.lists(finite, min_size=real.features, max_size=real.features))
    bits = real.bits([row])[0]
    assert len(bits) == real.width == len(real.names)
    start = 0
    for value, thresholds in zip(row, real.thresholds, strict=True):
        own = bits[start : start + len(thresholds)]
        assert own.sum() == sum(value > t if real.strict else value >= t for t in thresholds)
        assert not (~own[:-1] & own[1:]).any()
        start += len(thresholds)


@pytest.mark.parametrize("thresholds", [((2.0, 1.0),), ((float("nan"),),), ((float("inf"),),), ((), ())])
def test_thresholds_that_no_thermometer_has(thresholds: tuple[tuple[float, ...], ...]) -> None:
    with pytest.raises(ValueError, match=r"do not rise|at least one threshold"):
        Thermometer(thresholds)


def test_real_numbers_have_no_levels() -> None:
    with pytest.raises(ValueError, match="reads real numbers"):
        _ = Thermometer(((1.0,),)).levels


def test_words_come_bit_by_bit_the_lowest_first() -> None:
    assert Words(2, 3).bits([[6, 1]]).tolist() == [[False, True, True, True, False, False]]
    assert Words(2, 3).names == ("x0_b0", "x0_b1", "x0_b2", "x1_b0", "x1_b1", "x1_b2")
    assert Words(2).bits(np.array([[True, False], [False, True]])).tolist() == [[True, False], [False, True]]
    assert Words(2).names == ("x0", "x1")


@pytest.mark.parametrize("row", [[4, 0], [-1, 0], [0.5, 0], [float("nan"), 0], [1, 2, 3]])
def test_numbers_that_are_no_words(row: list[float]) -> None:
    with pytest.raises(ValueError, match="features must be"):
        Words(2, 2).bits([row])


@pytest.mark.parametrize(
    "encoder", [Thermometer(((1.0,), (2.0,))), Thermometer(((1.0,), (2.0,)), input=Q3_12)]
)
def test_vectors_of_another_length_are_refused(encoder: Thermometer) -> None:
    with pytest.raises(ValueError, match=r"must be \[samples, 2\]"):
        encoder.bits([[1.0]])


@given(thermometers | words)
def test_json_gives_the_encoder_back(encoder: Any) -> None:
    again: Encoder = encoder_from_json(json.loads(json.dumps(encoder.to_json())))
    assert again == encoder


def test_a_port_takes_the_words_side_by_side() -> None:
    encoder = Thermometer(((0.5,), (1.0,)), input=FixedPoint(3, 1))
    assert encoder.port_bits([[0.5, -1.0], [9.0, 0.4]]).astype(int).tolist() == [
        [1, 0, 0, 0, 1, 1],
        [1, 1, 0, 0, 0, 0],
    ]
    assert Words(2, 2).port_bits([[1, 2]]).astype(int).tolist() == [[1, 0, 0, 1]]
    with pytest.raises(ValueError, match="reads real numbers, not words"):
        Thermometer(((0.5,),)).port_bits([[1.0]])


def test_bits_of_thermometers_stand_threshold_by_threshold() -> None:
    encoder = ThermometerBits(2, 3)
    assert encoder.names == ("x0_t0", "x1_t0", "x0_t1", "x1_t1", "x0_t2", "x1_t2")
    assert encoder.falling == ((0, 2, 4), (1, 3, 5))
    given = [[1, 1, 1, 0, 0, 0], [0, 0, 0, 0, 0, 0], [1, 1, 1, 1, 1, 1]]
    assert encoder.bits(given).tolist() == encoder.port_bits(given).tolist() == np.array(given, bool).tolist()


@pytest.mark.parametrize(
    ("given", "complaint"),
    [
        ([[0, 1, 1, 0, 0, 0]], "reaches a threshold, but not the one before"),
        ([[1, 2, 0, 0, 0, 0]], "must be 0 or 1"),
        ([[1, float("nan"), 0, 0, 0, 0]], "must be 0 or 1"),
        ([[1, 1, 0]], "features must be"),
    ],
)
def test_nothing_but_thermometer_bits_is_read(given: list[list[float]], complaint: str) -> None:
    with pytest.raises(ValueError, match=complaint):
        ThermometerBits(2, 3).bits(given)


def test_there_is_no_thermometer_of_no_bits() -> None:
    with pytest.raises(ValueError, match="no thermometers: 2 of 0 bits"):
        ThermometerBits(2, 0)
