"""Networks written by hand."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from hdl_templates.builder import Function, NetworkBuilder, choose, function

PINS = ("0", "1", "a", "b", "c")


@given(st.lists(st.sampled_from(PINS), min_size=1, max_size=5), st.integers(0, (1 << 32) - 1))
def test_a_signal_is_what_was_computed_whatever_its_pins_are(pins: list[str], contents: int) -> None:
    def compute(*bits: int) -> int:
        return contents >> sum(bit << place for place, bit in enumerate(bits)) & 1

    builder = NetworkBuilder(("a", "b", "c"))
    network = builder.network([("o", builder.add(pins, compute))])
    for code in range(8):
        values = {"0": 0, "1": 1, **{name: code >> i & 1 for i, name in enumerate("abc")}}
        assert network.evaluate(code)[0] == compute(*(values[pin] for pin in pins))


def test_constants_wires_and_older_cells_take_no_cell() -> None:
    builder = NetworkBuilder(("a", "b"))
    assert builder.add(["a"], lambda a: 1) == "1"
    assert builder.add(["a", "0"], lambda a, zero: a | zero) == "a"
    both = [builder.add(pins, lambda x, y: x & y) for pins in (["a", "b"], ["a", "b"])]
    assert both[0] == both[1]
    assert len(builder.network([("o", both[0])]).luts) == 1


def test_choosing_between_functions_that_read_too_much_is_left_to_the_caller() -> None:
    low = function(["a", "b", "c"], lambda a, b, c: a ^ b ^ c)
    assert choose("s", low, function(["d", "e", "f"], lambda d, e, f: d ^ e ^ f)) is None
    found = choose("s", low, Function((), (1,)))
    assert found is not None
    assert np.mean(found.contents) == 0.75
