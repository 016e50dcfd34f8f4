import json
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.errors import ModelFileError
from wnn2hdl.ir import Lut, LutNetwork, Mux, bits_to_codes


def adder() -> LutNetwork:
    """A full adder: sum and carry of a, b, c."""
    return LutNetwork(
        ("a", "b", "c"),
        (
            Lut("half", ("a", "b"), 0b0110),
            Lut("sum", ("half", "c"), 0b0110),
            Lut("carry", ("a", "b", "c"), 0xE8),
        ),
        (("s", "sum"), ("co", "carry"), ("a_out", "a"), ("high", "1"), ("low", "0")),
    )


def wide_table() -> LutNetwork:
    """Four LUTs of one input joined by two MUXF7 and a MUXF8."""
    luts = tuple(Lut(f"lut{i}", ("a",), 1 + i % 2) for i in range(4))
    muxes = (Mux("f7a", "lut0", "lut1", "b"), Mux("f7b", "lut2", "lut3", "b"), Mux("f8", "f7a", "f7b", "c"))
    return LutNetwork(("a", "b", "c"), luts + muxes, (("y", "f8"),))


@st.composite
def networks(draw: st.DrawFn) -> LutNetwork:
    inputs = tuple(f"i{x}" for x in range(draw(st.integers(1, 5))))
    known = list(inputs)
    cells: list[Lut | Mux] = []
    free: list[list[str]] = [[], []]  # LUTs and MUXF7 that no multiplexer joins yet
    for number in range(draw(st.integers(0, 8))):
        name = f"n{number}"
        heights = [height for height in (0, 1) if len(free[height]) > 1]
        join = draw(st.booleans())
        if heights and join:
            height = draw(st.sampled_from(heights))
            low, high = free[height].pop(), free[height].pop()
            cells.append(Mux(name, low, high, draw(st.sampled_from(known))))
            if height == 0:
                free[1].append(name)
        else:
            pins = draw(
                st.lists(st.sampled_from(known), min_size=1, max_size=min(6, len(known)), unique=True)
            )
            cells.append(Lut(name, tuple(pins), draw(st.integers(0, 2 ** (2 ** len(pins)) - 1))))
            free[0].append(name)
        known.append(name)
    outputs = draw(st.lists(st.sampled_from([*known, "0", "1"]), max_size=4))
    return LutNetwork(inputs, tuple(cells), tuple((f"o{j}", signal) for j, signal in enumerate(outputs)))


def slow_value(network: LutNetwork, code: int) -> list[bool]:
    signals = {"0": 0, "1": 1} | {name: code >> i & 1 for i, name in enumerate(network.inputs)}
    for cell in network.cells:
        if isinstance(cell, Lut):
            address = sum(signals[name] << j for j, name in enumerate(cell.inputs))
            signals[cell.name] = cell.init >> address & 1
        else:
            signals[cell.name] = signals[cell.high if signals[cell.select] else cell.low]
    return [bool(signals[signal]) for _, signal in network.outputs]


def test_a_full_adder_adds() -> None:
    for code in range(8):
        ones = code.bit_count()
        expected = [ones % 2 == 1, ones > 1, code % 2 == 1, True, False]
        assert adder().evaluate(code).tolist() == expected


@given(networks())
def test_evaluation_follows_the_definition(network: LutNetwork) -> None:
    codes = np.arange(1 << len(network.inputs))
    assert network.evaluate(codes).tolist() == [slow_value(network, code) for code in codes.tolist()]


@given(networks(), st.integers(0, 20), st.integers(0, 99))
def test_bits_are_evaluated_as_their_codes_are(network: LutNetwork, samples: int, seed: int) -> None:
    bits = np.random.default_rng(seed).random((samples, len(network.inputs))) < 0.5
    assert network.evaluate_bits(bits).tolist() == network.evaluate(bits_to_codes(bits)).tolist()


def test_a_network_may_be_wider_than_any_code() -> None:
    inputs = tuple(f"i{x}" for x in range(100))
    network = LutNetwork(inputs, (Lut("n", ("i3", "i99"), 0b0110),), (("y", "n"), ("one", "1")))
    bits = np.zeros((3, 100), dtype=np.bool_)
    bits[1, 3] = bits[2, [3, 99]] = True
    assert network.evaluate_bits(bits).tolist() == [[False, True], [True, True], [False, True]]


@pytest.mark.parametrize("shape", [(), (3,), (2, 3), (0,)])
def test_codes_have_any_shape(shape: tuple[int, ...]) -> None:
    codes = np.arange(np.prod(shape, dtype=int)).reshape(shape)
    assert adder().evaluate(codes).shape == (*shape, 5)


@given(networks())
def test_json_gives_the_network_back(network: LutNetwork) -> None:
    assert LutNetwork.from_json(json.loads(json.dumps(network.to_json()))) == network


def test_depth_counts_luts_on_the_longest_path() -> None:
    assert adder().depth == 2
    assert LutNetwork(("a",), (), (("y", "a"), ("z", "1"))).depth == 0
    assert wide_table().depth == 1


def test_a_multiplexer_chooses_by_its_select() -> None:
    network = wide_table()
    assert [cell.name for cell in network.muxes] == ["f7a", "f7b", "f8"]
    assert len(network.luts) == 4
    # lut0 and lut2 invert a, lut1 and lut3 pass it; b chooses between them and c between two equal halves.
    assert network.evaluate(range(8))[:, 0].tolist() == [True, False, False, True] * 2


@pytest.mark.parametrize(
    ("mux", "message"),
    [
        (Mux("m", "l0", "l0", "a"), "must join two LUTs"),
        (Mux("m", "l0", "a", "a"), "must join two LUTs"),
        (Mux("m", "l2", "f7", "a"), "must join two LUTs"),
        (Mux("m", "l0", "l2", "a"), r"joins \['l0'\], as another"),
        (Mux("m", "l2", "l3", "nobody"), "before it is driven"),
        (Mux("f7", "l2", "l3", "a"), "driven twice"),
    ],
)
def test_multiplexers_that_no_slice_has(mux: Mux, message: str) -> None:
    luts = tuple(Lut(f"l{i}", ("a",), i) for i in range(4))
    with pytest.raises(ValueError, match=message):
        LutNetwork(("a",), (*luts, Mux("f7", "l0", "l1", "a"), mux), ())


def test_nothing_joins_two_muxf8() -> None:
    luts = tuple(Lut(f"l{i}", ("a",), 1) for i in range(8))
    sevens = tuple(Mux(f"f7_{i}", f"l{2 * i}", f"l{2 * i + 1}", "a") for i in range(4))
    eights = tuple(Mux(f"f8_{i}", f"f7_{2 * i}", f"f7_{2 * i + 1}", "a") for i in range(2))
    with pytest.raises(ValueError, match="must join two LUTs"):
        LutNetwork(("a",), (*luts, *sevens, *eights, Mux("f9", "f8_0", "f8_1", "a")), ())


@pytest.mark.parametrize(
    ("luts", "outputs", "message"),
    [
        ((Lut("n", (), 0),), (), "has 0 inputs"),
        ((Lut("n", ("a",) * 7, 0),), (), "has 7 inputs"),
        ((Lut("n", ("a",), 4),), (), "too wide"),
        ((Lut("n", ("a",), -1),), (), "too wide"),
        ((Lut("a", ("a",), 1),), (), "driven twice"),
        ((Lut("1", ("a",), 1),), (), "driven twice"),
        ((Lut("n", ("m",), 1), Lut("m", ("a",), 1)), (), "before it is driven"),
        ((), (("y", "n"),), "nothing drives"),
    ],
)
def test_networks_that_cannot_be_built(
    luts: tuple[Lut, ...], outputs: tuple[tuple[str, str], ...], message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        LutNetwork(("a",), luts, outputs)


@pytest.mark.parametrize(
    "change",
    [
        {"cells": [{"name": "n", "inputs": ["a"], "init": "zz"}]},
        {"cells": [{"name": "n", "inputs": ["a"]}]},
        {"cells": [{"name": ["n"], "inputs": ["a"], "init": "1"}]},
        {"cells": [{"name": "n", "low": "a", "select": "a"}]},
        {"cells": 3},
        {"outputs": [["y"]]},
        {"outputs": [["y", "nobody"]]},
        {"inputs": None},
    ],
)
def test_a_saved_network_that_was_damaged(change: dict[str, Any]) -> None:
    with pytest.raises(ModelFileError, match="not a LUT network"):
        LutNetwork.from_json({**adder().to_json(), **change})
