from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays
from numpy.typing import NDArray
from sklearn.utils.estimator_checks import parametrize_with_checks

from wnn2hdl.encode import ThermometerEncoder, fit_thermometer, high_bits, parse_bits, whole_words
from wnn2hdl.errors import InputError
from wnn2hdl.ir import PIXEL_BIT_NAMES
from wnn2hdl.ir.fixed_point import FixedPoint

tables = arrays(
    np.float64,
    array_shapes(min_dims=2, max_dims=2, max_side=30),
    elements=st.integers(-5, 5) | st.floats(-1e6, 1e6),
)


def test_bits_are_taken_in_the_order_given() -> None:
    assert parse_bits("R6,B3, G7").bits == ("R6", "B3", "G7")


@given(st.lists(st.sampled_from(sorted(PIXEL_BIT_NAMES)), min_size=1, unique=True))
def test_every_list_of_names_is_read_back(names: list[str]) -> None:
    assert parse_bits(",".join(names)).bits == tuple(names)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("X9", "no such pixel bit: 'X9'; use R, G or B and a number from 0 to 7"),
        ("R7,R8", "no such pixel bit: 'R8'; use"),
        ("R7,,G7", "no such pixel bit: ''; use"),
        ("", "no such pixel bit: ''; use"),
        ("r7", "no such pixel bit: 'r7'; use"),
        ("R7,G7,R7", "a pixel bit is named twice: R7,G7,R7; name each bit once"),
    ],
)
def test_a_bad_list_of_bits_gets_one_line(text: str, line: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_bits(text)
    assert str(caught.value).startswith(line)


def test_the_reference_pixel_is_the_high_nibbles_red_first() -> None:
    assert ",".join(high_bits().bits) == "R7,R6,R5,R4,G7,G6,G5,G4,B7,B6,B5,B4"
    assert high_bits(1).bits == ("R7", "G7", "B7")
    assert high_bits(8).width == 24


@pytest.mark.parametrize("per_channel", [0, 9])
def test_a_channel_has_eight_bits(per_channel: int) -> None:
    with pytest.raises(InputError, match="choose 1 to 8"):
        high_bits(per_channel)


def test_thresholds_split_the_samples_evenly() -> None:
    features = np.arange(100).reshape(-1, 1)
    encoder = fit_thermometer(features, 3)
    assert encoder.thresholds == ((25.0, 50.0, 75.0),)
    assert np.bincount(encoder.bits(features).sum(axis=1)).tolist() == [25, 25, 25, 25]


def test_a_feature_of_few_values_gets_a_threshold_between_each() -> None:
    assert fit_thermometer([[3.0], [1.0], [2.0], [1.0]], 8).thresholds == ((2.0, 3.0),)


def test_a_value_most_samples_share_does_not_use_up_the_bits() -> None:
    features = np.r_[np.zeros(90), np.arange(1, 11)].reshape(-1, 1)
    assert fit_thermometer(features, 4).thresholds == ((1.0, 4.0, 7.0, 10.0),)


def test_a_constant_feature_gets_no_bits() -> None:
    assert fit_thermometer([[0.0, 5.0], [1.0, 5.0]], 2).thresholds == ((1.0,), ())


def test_uniform_thresholds_split_the_range_evenly() -> None:
    features = np.array([0.0, 1.0, 1.5, 10.0]).reshape(-1, 1)
    assert fit_thermometer(features, 4, "uniform").thresholds == ((2.0, 4.0, 6.0, 8.0),)


def test_gaussian_thresholds_split_a_normal_distribution_evenly() -> None:
    features = np.random.default_rng(0).normal(5, 2, size=(100_000, 1))
    (levels,) = fit_thermometer(features, 3, "gaussian").thresholds
    assert levels == pytest.approx((5 - 2 * 0.6745, 5, 5 + 2 * 0.6745), abs=0.03)


def test_thresholds_that_no_sample_reaches_are_left_out() -> None:
    features = np.r_[np.zeros(99), 1000.0].reshape(-1, 1)
    (levels,) = fit_thermometer(features, 5, "gaussian").thresholds
    assert levels
    assert all(0 < level <= 1000 for level in levels)


@given(tables, st.integers(1, 9), st.sampled_from(["quantiles", "uniform", "gaussian"]))
def test_thresholds_in_words_are_words(features: NDArray[np.float64], bits: int, spacing: Any) -> None:
    words = FixedPoint(12, 3)
    if (np.ptp(words.words(features), axis=0) == 0).all():
        return
    encoder = fit_thermometer(features, bits, spacing, words)
    assert encoder.input == words
    encoded = encoder.bits(features)
    for levels in encoder.thresholds:
        assert np.array_equal(words.values(words.words(levels)), levels)
    assert encoded.any(axis=0).all()
    assert not encoded.all(axis=0).any()


@pytest.mark.parametrize(
    ("features", "words"),
    [
        ([[0.0], [255.0]], "UQ8.0"),
        ([[0.0], [256.0]], "UQ9.0"),
        ([[-5.0], [3.0]], "Q3.0"),
        ([[-4.0], [4.0]], "Q3.0"),
        ([[-1.0], [0.0]], "Q0.0"),
        ([[0.0], [0.0]], "UQ1.0"),
        ([[0.5], [1.0]], "None"),
        ([[0.0], [1e300]], "None"),
    ],
)
def test_whole_features_have_a_format(features: list[list[float]], words: str) -> None:
    assert str(whole_words(features)) == words


@given(tables, st.integers(1, 9))
def test_every_bit_tells_samples_apart(features: NDArray[np.float64], bits: int) -> None:
    distinct = [len(np.unique(column)) for column in features.T]
    if max(distinct) == 1:
        with pytest.raises(InputError, match="every feature is constant"):
            fit_thermometer(features, bits)
        return
    encoder = fit_thermometer(features, bits)
    assert [len(levels) for levels in encoder.thresholds] == [min(bits, d - 1) for d in distinct]
    encoded = encoder.bits(features)
    assert encoded.any(axis=0).all()
    assert not encoded.all(axis=0).any()


@pytest.mark.parametrize(
    ("features", "bits", "line"),
    [
        ([[0.0], [float("nan")]], 2, "a feature is not finite"),
        ([[0.0], [float("inf")]], 2, "a feature is not finite"),
        ([[0.0], [1.0]], 0, "a feature cannot have this number of bits: 0; choose at least 1"),
        ([], 2, "features must be a filled array"),
        ([1.0, 2.0], 2, "features must be a filled array"),
    ],
)
def test_what_no_thermometer_fits_gets_one_line(features: object, bits: int, line: str) -> None:
    with pytest.raises(InputError, match=line):
        fit_thermometer(np.array(features), bits)


def test_the_transformer_is_fit_thermometer() -> None:
    features = np.random.default_rng(0).normal(size=(50, 3))
    transformer = ThermometerEncoder(bits=4, spacing="uniform").fit(features)
    assert transformer.thermometer_ == fit_thermometer(features, 4, "uniform")
    assert np.array_equal(transformer.transform(features), transformer.thermometer_.bits(features))
    assert transformer.get_feature_names_out()[:5].tolist() == ["x0_t0", "x0_t1", "x0_t2", "x0_t3", "x1_t0"]


@parametrize_with_checks([ThermometerEncoder()])
@pytest.mark.filterwarnings("ignore::sklearn.exceptions.SkipTestWarning")
def test_the_transformer_keeps_scikit_learns_contract(estimator: object, check: object) -> None:
    check(estimator)  # type: ignore[operator]
