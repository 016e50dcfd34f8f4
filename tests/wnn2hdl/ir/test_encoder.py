import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.ir import PIXEL_BIT_NAMES, PIXEL_BITS, BitSelect, Thermometer, codes_to_bits
from wnn2hdl.ir.encoder import encoder_from_json

selections = st.lists(st.sampled_from(sorted(PIXEL_BIT_NAMES)), min_size=1, unique=True).map(
    lambda names: BitSelect(tuple(names))
)
levels = st.lists(st.floats(allow_nan=False, allow_infinity=False), unique=True, max_size=5).map(
    lambda values: tuple(sorted(values))
)
thermometers = st.lists(levels, min_size=1, max_size=4).filter(any).map(lambda t: Thermometer(tuple(t)))
pixels = st.lists(st.tuples(*[st.integers(0, 255)] * 3), min_size=1, max_size=20)


def test_the_first_named_bit_is_code_bit_0() -> None:
    encoder = BitSelect(("R7", "B0"))
    assert encoder.codes(np.array([[128, 0, 0], [0, 0, 1], [127, 255, 254]], dtype=np.uint8)).tolist() == [
        1,
        2,
        0,
    ]
    assert encoder.names == ("R7", "B0")
    assert encoder.pixel_positions == (23, 0)


def test_every_bit_of_the_pixel_word_has_one_name() -> None:
    assert sorted(PIXEL_BIT_NAMES.values()) == list(range(PIXEL_BITS))
    assert (PIXEL_BIT_NAMES["R7"], PIXEL_BIT_NAMES["G0"], PIXEL_BIT_NAMES["B7"]) == (23, 8, 7)


@given(selections, pixels)
def test_codes_are_bits_of_the_24_bit_pixel_word(
    encoder: BitSelect, values: list[tuple[int, int, int]]
) -> None:
    array = np.array(values, dtype=np.uint8)
    words = array.astype(np.int64) @ [1 << 16, 1 << 8, 1]
    wired = codes_to_bits(words, PIXEL_BITS)[:, encoder.pixel_positions]
    assert np.array_equal(codes_to_bits(encoder.codes(array), encoder.width), wired)


def test_an_image_gives_an_image_of_codes() -> None:
    image = np.zeros((4, 5, 3), dtype=np.uint8)
    assert BitSelect(("G7",)).codes(image).shape == (4, 5)


def test_thermometer_bits_are_feature_major_and_include_the_threshold() -> None:
    encoder = Thermometer(((1.0, 2.0), (), (0.5,)))
    assert encoder.names == ("x0_t0", "x0_t1", "x2_t0")
    assert encoder.bits([[1.0, 9.0, 0.4], [2.5, 9.0, 0.5]]).tolist() == [
        [True, False, False],
        [True, True, True],
    ]


@given(thermometers, st.data())
def test_thermometer_bits_of_a_feature_never_rise(encoder: Thermometer, data: st.DataObject) -> None:
    finite = st.floats(allow_nan=False, allow_infinity=False)
    row = data.draw(st.lists(finite, min_size=len(encoder.thresholds), max_size=len(encoder.thresholds)))
    bits = encoder.bits([row])[0]
    assert len(bits) == encoder.width
    start = 0
    for value, thresholds in zip(row, encoder.thresholds, strict=True):
        own = bits[start : start + len(thresholds)]
        assert own.sum() == sum(value >= t for t in thresholds)
        assert not (~own[:-1] & own[1:]).any()
        start += len(thresholds)


@given(st.one_of(selections, thermometers))
def test_json_gives_the_encoder_back(encoder: BitSelect | Thermometer) -> None:
    assert encoder_from_json(json.loads(json.dumps(encoder.to_json()))) == encoder


@pytest.mark.parametrize(
    ("bits", "message"),
    [(("X9",), "'X9' is no pixel bit"), ((), "no bits were chosen"), (("R1", "R1"), "named twice")],
)
def test_bits_that_cannot_be_selected(bits: tuple[str, ...], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        BitSelect(bits)


@pytest.mark.parametrize(
    "thresholds", [((2.0, 1.0),), ((1.0, 1.0),), ((float("nan"),),), ((float("inf"),),), ((), ())]
)
def test_thresholds_that_no_thermometer_has(thresholds: tuple[tuple[float, ...], ...]) -> None:
    with pytest.raises(ValueError, match=r"do not rise|at least one threshold"):
        Thermometer(thresholds)
