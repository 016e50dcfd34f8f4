"""Encoders in hardware."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wnn2hdl.errors import InputError
from wnn2hdl.ir import FixedPoint, Thermometer, codes_to_bits
from wnn2hdl.lower.encoder import encoder_circuit, features_port


@settings(max_examples=20, deadline=None)
@given(st.data(), st.integers(2, 7), st.booleans(), st.booleans())
def test_the_bits_that_are_read_are_those_of_the_thermometer(
    data: st.DataObject, bits: int, signed: bool, strict: bool
) -> None:
    form = FixedPoint(bits, 2, signed)
    numbers = st.floats(-20, 40, allow_nan=False)
    thresholds = data.draw(st.lists(st.lists(numbers, max_size=5).map(sorted), min_size=2, max_size=2))
    encoder = Thermometer((*map(tuple, thresholds), (0.3,)), strict, form)
    read = sorted(data.draw(st.sets(st.integers(0, encoder.width - 1), min_size=1)))
    words = np.random.default_rng(0).integers(form.lowest, form.highest + 1, (400, 3))
    features = codes_to_bits(words & ((1 << bits) - 1), bits).reshape(len(words), -1)
    found = encoder_circuit(encoder, tuple(read)).evaluate({"features": features})["bits"]
    np.testing.assert_array_equal(found, encoder.bits_of_words(words)[:, read])


def test_hardware_needs_the_format_of_the_words() -> None:
    with pytest.raises(InputError, match="hardware reads words"):
        features_port(Thermometer(((0.5,),)))
