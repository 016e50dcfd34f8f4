# amaranth: UnusedElaboratable=no
"""Values of ports."""

import numpy as np
import pytest
from amaranth.lib.wiring import Component, In, Out
from numpy.typing import NDArray

from hdl_templates.vectors import pack, port_widths


class Ports(Component):
    """Two inputs, one output."""

    def __init__(self) -> None:
        super().__init__({"bits": In(2), "match_count": Out(2), "reference_bits": In(10)})


def flags(*rows: str) -> NDArray[np.bool_]:
    """Rows of ports, the most significant bit first, as one reads numbers."""
    return np.array([[digit == "1" for digit in reversed(row)] for row in rows])


def test_bit_i_of_a_number_is_element_i() -> None:
    inputs = {"reference_bits": flags("1000000010", "0000000001"), "bits": flags("10", "11")}
    assert pack(Ports(), inputs, {"match_count": flags("01", "00")}) == (
        {"bits": [2, 3], "reference_bits": [514, 1]},
        {"match_count": [1, 0]},
    )


@pytest.mark.parametrize(
    "values",
    [np.zeros((2, 3), dtype=np.bool_), np.zeros((2, 2), dtype=np.int64), np.zeros(2, dtype=np.bool_)],
)
def test_values_that_do_not_fit_are_refused(values: np.ndarray) -> None:
    others = {"reference_bits": np.zeros((2, 10), dtype=np.bool_)}
    with pytest.raises(ValueError, match=r"port bits takes bools \[vectors, 2\], not "):
        pack(Ports(), {"bits": values} | others, {"match_count": flags("01", "00")})


def test_every_port_is_given_equally_many_vectors() -> None:
    assert port_widths(Ports()) == ({"bits": 2, "reference_bits": 10}, {"match_count": 2})
    two, three = flags("00", "00"), flags("00", "00", "00")
    with pytest.raises(ValueError, match=r"given for \['bits'\]; the ports are \['bits', 'reference_bits'\]"):
        pack(Ports(), {"bits": two}, {"match_count": two})
    reference = np.zeros((2, 10), dtype=np.bool_)
    with pytest.raises(ValueError, match=r"different numbers of vectors: \[2, 3\]"):
        pack(Ports(), {"bits": two, "reference_bits": reference}, {"match_count": three})
