"""Tables under construction."""

import numpy as np

from wnn2hdl.ir.wires import Slice
from wnn2hdl.lower.comparison import Tables

A, B = Slice("a"), Slice("b")


def flags(*codes: int) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    return np.isin(np.arange(4), codes)


def test_equal_tables_are_one_and_a_wire_is_none() -> None:
    tables = Tables("t")
    both = tables.add([A, B], flags(3), flags(0, 1, 2))
    assert tables.add([A, B], flags(3), flags(0, 1, 2)) == both
    assert tables.add([A, B], flags(1, 3), flags(0, 2)) == A
    assert len(tables.nodes) == 1


def test_codes_that_do_not_occur_save_signals() -> None:
    tables = Tables("t")
    assert tables.add([A, B], flags(3), flags(0)) == A


def test_a_constant_is_a_table_that_ignores_its_input() -> None:
    tables = Tables("t")
    tables.add([A, B], flags(), flags(0, 1, 2, 3))
    (node,) = tables.nodes
    assert node.word == (A,)
    assert not node.evaluate((np.array([[False], [True]]),))["t_0"].any()
