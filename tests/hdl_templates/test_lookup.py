"""Lookups: what they accept and what they compute."""

import numpy as np
import pytest

from hdl_templates.lookup import LutCell, LutNetwork, MuxCell, SumOfProducts


def test_a_sum_of_products_is_one_where_a_term_fits() -> None:
    lookup = SumOfProducts(("a", "b", "c"), ("y", "z"), (((0b011, 0b001), (0b100, 0b100)), ((0, 0),)))
    assert lookup.compute(range(8))[:, 0].tolist() == [False, True, False, False, True, True, True, True]
    assert lookup.compute(range(8))[:, 1].all()
    assert lookup.used == 0b111


def test_a_network_evaluates_luts_and_multiplexers_in_order() -> None:
    cells = (
        LutCell("both", ("a", "b"), 0b1000),
        LutCell("either", ("a", "b"), 0b1110),
        MuxCell("chosen", "both", "either", "c"),
    )
    network = LutNetwork(("a", "b", "c", "d"), cells, (("y", "chosen"), ("z", "d"), ("one", "1")))
    codes = np.arange(16)
    a, b, c, d = (codes >> i & 1 for i in range(4))
    expected = np.stack([np.where(c, a | b, a & b), d, np.ones(16)], axis=-1)
    np.testing.assert_array_equal(network.compute(codes), expected)
    assert network.used == 0b1111
    assert network.luts == 2


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: SumOfProducts(("a",), ("y",), ()), "1 outputs need as many lists of terms, not 0"),
        (lambda: SumOfProducts(("a",), ("y",), (((1, 2),),)), "does not fit 1 inputs"),
        (lambda: SumOfProducts(("a b",), ("y",), ((),)), "'a b' cannot name a signal"),
        (lambda: LutNetwork(("a",), (LutCell("x", ("b",), 1),), ()), "reads \\['b'\\] before it is driven"),
        (lambda: LutNetwork(("a",), (LutCell("x", ("a",), 4),), ()), "x is no LUT"),
        (lambda: LutNetwork(("a",), (), (("y", "b"),)), "output y reads b, which nothing drives"),
        (lambda: LutNetwork(("a",), (), (), "rows"), "'rows' is no style; use one of equations, cells"),  # type: ignore[arg-type]
    ],
)
def test_what_makes_no_sense_is_refused(make: object, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        make()  # type: ignore[operator]
