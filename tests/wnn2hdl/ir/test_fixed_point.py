"""Fixed-point words and the numbers they stand for."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.ir import FixedPoint

finite = st.floats(allow_nan=False, allow_infinity=False)
formats = st.builds(FixedPoint, st.integers(1, 48), st.integers(0, 64), st.booleans())

Q3_12 = FixedPoint(bits=16, fraction=12)


def test_q3_12_is_what_its_name_says() -> None:
    assert (Q3_12.lowest, Q3_12.highest) == (-32768, 32767)
    assert Q3_12.words([0.5, -0.5, 7.99999, 8, -9, np.inf, -np.inf]).tolist() == [
        *(2048, -2048, 32767, 32767, -32768, 32767, -32768)
    ]
    assert Q3_12.values([2048, -1]).tolist() == [0.5, -1 / 4096]


def test_words_are_rounded_down() -> None:
    assert FixedPoint(8, 0).words([1.9, -1.1]).tolist() == [1, -2]
    assert FixedPoint(8, 0, signed=False).words([255.9, -1.1]).tolist() == [255, 0]


def test_nan_has_no_word() -> None:
    with pytest.raises(ValueError, match="NaN"):
        Q3_12.words([0.0, float("nan")])


@pytest.mark.parametrize(("bits", "fraction"), [(0, 0), (49, 0), (8, -1), (8, 65)])
def test_words_that_no_hardware_has(bits: int, fraction: int) -> None:
    with pytest.raises(ValueError, match="a word has"):
        FixedPoint(bits, fraction)


@given(formats, st.data(), st.booleans())
def test_a_level_is_the_lowest_word_that_passes(words: FixedPoint, data: st.DataObject, strict: bool) -> None:
    near = st.integers(words.lowest - 2, words.highest + 2).map(lambda w: w / 2**words.fraction)
    threshold = data.draw(finite | near)
    level = words.level(threshold, strict=strict)

    def passes(word: int) -> bool:
        number = Fraction(word, 2**words.fraction)
        return number > Fraction(threshold) if strict else number >= Fraction(threshold)

    assert words.lowest <= level <= words.highest + 1
    assert level == words.highest + 1 or passes(level)
    assert level == words.lowest or not passes(level - 1)
