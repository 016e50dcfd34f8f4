"""All thresholds of one number in few look-up tables."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from wnn2hdl.ir import codes_to_bits
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.packing import Gate, pairs
from wnn2hdl.ir.wires import Port, Slice
from wnn2hdl.lower.thresholds import compare


def circuit(bits: int, levels: list[int], *, signed: bool) -> Circuit:
    word = [Slice("x", bit) for bit in range(bits)]
    tables, answers = compare(word, levels, signed=signed, name="t")
    return Circuit("c", "Thresholds.", (Port("x", bits),), tuple(tables), {"o": tuple(answers)})


def luts(of: Circuit) -> int:
    gates = [Gate(frozenset(node.reads[0]), (Slice(node.name),), True) for node in of.nodes]
    return len(gates) - len(pairs(gates))


def assert_exact(of: Circuit, words: NDArray[np.int64], levels: list[int], *, signed: bool) -> None:
    bits = of.inputs[0].width
    answers = of.evaluate({"x": codes_to_bits(words, bits)})["o"]
    numbers = words ^ (1 << (bits - 1) if signed else 0)
    np.testing.assert_array_equal(answers, numbers[:, np.newaxis] >= np.array(levels))


@settings(max_examples=40, deadline=None)
@given(st.data(), st.integers(1, 11), st.booleans())
def test_every_word_is_compared_exactly(data: st.DataObject, bits: int, signed: bool) -> None:
    levels = sorted(data.draw(st.sets(st.integers(1, (1 << bits) - 1), min_size=1, max_size=12)))
    of = circuit(bits, levels, signed=signed)
    assert_exact(of, np.arange(1 << bits), levels, signed=signed)
    assert all(sum(part.width for part in node.reads[0]) <= 6 for node in of.nodes)


@pytest.mark.parametrize("signed", [False, True])
@pytest.mark.parametrize("bits", [16, 48])
def test_wide_words_are_compared_exactly_around_each_threshold(bits: int, signed: bool) -> None:
    rng = np.random.default_rng(0)
    middle = rng.normal(1 << (bits - 1), 1 << (bits - 4), 18).astype(np.int64)
    levels = sorted({*middle.tolist(), 1, (1 << bits) - 1})
    near = np.array(levels)[:, np.newaxis] + np.arange(-3, 4)
    numbers = np.concatenate([near.ravel(), rng.integers(0, 1 << bits, 20_000)])
    words = np.clip(numbers, 0, (1 << bits) - 1) ^ (1 << (bits - 1) if signed else 0)
    assert_exact(circuit(bits, levels, signed=signed), words, levels, signed=signed)


def test_a_bit_test_takes_no_table() -> None:
    assert circuit(16, [1 << 15], signed=False).nodes == ()


@pytest.mark.parametrize(
    ("bits", "levels", "count"),
    [
        (16, [0x8001], 3),
        (16, [0x4321, 0x8765, 0xCBA9], 8),
        (16, list(range(0x700F, 0x9000, 0x511)), 14),
        (8, list(range(9, 256, 8)), 31),
    ],
)
def test_thresholds_take_few_luts(bits: int, levels: list[int], count: int) -> None:
    assert luts(circuit(bits, levels, signed=False)) <= count


def test_the_result_depends_on_the_thresholds_only() -> None:
    levels = [9, 70, 71, 130, 200, 201, 202, 250]
    first, second = (circuit(8, levels, signed=True) for _ in range(2))
    assert [node.reads for node in first.nodes] == [node.reads for node in second.nodes]
    assert first.drivers == second.drivers
