import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.errors import InputError
from wnn2hdl.wisard import draw_mapping


@given(st.integers(1, 30), st.integers(1, 20), st.integers(1, 20), st.integers(0, 2**32))
def test_inputs_are_read_equally_often_and_never_twice_by_a_ram(
    bits: int, rams: int, address_bits: int, seed: int
) -> None:
    address_bits = min(address_bits, bits)
    mapping = draw_mapping(bits, rams, address_bits, seed)
    assert mapping.shape == (1, rams, address_bits)
    reads = np.bincount(mapping.ravel(), minlength=bits)
    assert reads.max() - reads.min() <= 1
    assert all(len(set(ram)) == address_bits for ram in mapping[0].tolist())


def test_a_seed_gives_the_same_mapping_and_another_seed_another() -> None:
    first = draw_mapping(12, 16, 4, 0)
    assert np.array_equal(first, draw_mapping(12, 16, 4, 0))
    assert not np.array_equal(first, draw_mapping(12, 16, 4, 1))


def test_each_class_can_have_its_own_mapping() -> None:
    mapping = draw_mapping(12, 16, 4, 0, groups=3)
    assert mapping.shape == (3, 16, 4)
    assert np.array_equal(mapping[:1], draw_mapping(12, 16, 4, 0))
    assert (mapping[1] != mapping[2]).any()
    assert all(np.bincount(group.ravel(), minlength=12).max() <= 6 for group in mapping)


@pytest.mark.parametrize(
    ("bits", "rams", "address_bits", "line"),
    [
        (12, 0, 4, "at least one RAM: 0; choose 1 or more"),
        (12, 4, 0, "this number of address bits: 0; choose 1 to 64"),
        (99, 4, 65, "this number of address bits: 65; choose 1 to 64"),
        (12, 4, 13, "more address bits than the network has input bits: 13 of 12; choose at most 12"),
    ],
)
def test_a_mapping_that_cannot_be_drawn_gets_one_line(
    bits: int, rams: int, address_bits: int, line: str
) -> None:
    with pytest.raises(InputError, match=line):
        draw_mapping(bits, rams, address_bits, 0)
