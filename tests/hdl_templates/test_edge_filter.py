"""The edge filter."""

import pytest

from hdl_templates.edge_filter import Parameters
from hdl_templates.lookup import SumOfProducts


def test_the_golden_model_looks_windows_up() -> None:
    names = tuple(f"bit{i}" for i in range(9))
    centre_without_top = SumOfProducts(names, ("edge_bit",), (((0b000010010, 0b000010000),),))
    assert Parameters(centre_without_top).compute([0b000010000, 0b000010010, 0]).tolist() == [
        True,
        False,
        False,
    ]


def test_only_nine_bits_make_a_window() -> None:
    with pytest.raises(ValueError, match="an edge filter looks up 9 bits for 1, not 1 for 1"):
        Parameters(SumOfProducts(("a",), ("y",), ((),)))
