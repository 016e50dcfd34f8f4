"""Values of ports."""

import numpy as np
import pytest

from hdl_templates.bit_match import Parameters
from hdl_templates.vectors import pack, port_values, port_widths


def test_words_stand_side_by_side_the_first_lowest() -> None:
    assert port_values(np.array([[1, 2, 3]], dtype=np.uint8), 24) == [0x030201]
    assert port_values(np.array([[True, False, True]]), 3) == [0b101]
    assert port_values(np.array([7, 0]), 3) == [7, 0]


@pytest.mark.parametrize(
    ("values", "width", "message"),
    [
        (np.array([8]), 3, "cannot hold 8 to 8"),
        (np.array([-1]), 3, "cannot hold -1 to -1"),
        (np.zeros((1, 2), dtype=int), 3, "cannot take 2 words"),
        (np.zeros(1), 3, "whole numbers"),
    ],
)
def test_values_that_do_not_fit_are_refused(values: np.ndarray, width: int, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        port_values(values, width)


def test_every_port_is_given_equally_many_vectors() -> None:
    component = Parameters(2).create()
    assert port_widths(component) == ({"bits": 2, "reference": 2}, {"match_count": 2})
    two, three = np.zeros(2, dtype=int), np.zeros(3, dtype=int)
    with pytest.raises(ValueError, match=r"given for \['bits'\]; the ports are \['bits', 'reference'\]"):
        pack(component, {"bits": two}, {"match_count": two})
    with pytest.raises(ValueError, match=r"different numbers of vectors: \[2, 3\]"):
        pack(component, {"bits": two, "reference": two}, {"match_count": three})
