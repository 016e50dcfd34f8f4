import numpy as np
import pytest

from wnn2hdl.errors import CheckError
from wnn2hdl.ir import Cover, Cube, TruthTable
from wnn2hdl.minimise import require_equal
from wnn2hdl.minimise.check import wrong_codes

XOR = TruthTable.exact(("a", "b"), ("y",), np.array([[False], [True], [True], [False]]))
ONLY_A = Cover(("a", "b"), ("y",), (Cube(0b11, 0b01, 1),))


def test_a_wrong_function_is_refused() -> None:
    assert wrong_codes(XOR, ONLY_A).tolist() == [2]
    with pytest.raises(
        CheckError, match="the cover differs from its table on 1 cared-for codes: first code 2"
    ):
        require_equal(XOR, ONLY_A, "the cover")


def test_codes_without_care_may_differ() -> None:
    require_equal(XOR.with_care(np.array([True, True, False, True])), ONLY_A, "the cover")
