"""Parameters of the population count; the hardware is tested with the compressors."""

import pytest

from hdl_templates.popcount import Parameters


def test_the_count_has_as_many_bits_as_the_width_needs() -> None:
    assert [Parameters(width).count_width for width in (1, 3, 4, 9, 220, 484)] == [1, 2, 3, 4, 8, 9]


def test_an_empty_word_is_refused() -> None:
    with pytest.raises(ValueError, match="at least 1 bit, not 0"):
        Parameters(0)
