"""What each kind of node drives and computes."""

from typing import Any

import numpy as np
import pytest

from wnn2hdl.ir import Lut, LutNetwork, TruthTable, bits_to_codes, codes_to_bits
from wnn2hdl.ir.nodes import MAX_CYCLES, ArgMax, Leaf, Match, Register, Sum, Table, Threshold
from wnn2hdl.ir.wires import Slice, width_of

A, B, C = (Slice("a", 0, 3),), (Slice("b", 0, 3),), (Slice("c", 0, 2),)
WIDE = (Slice("wide", 0, 64),)
CODES = np.arange(8)
WORDS = codes_to_bits(CODES, 3)


def value(node: Leaf, *words: np.ndarray) -> list[int]:
    (bits,) = node.evaluate(words).values()
    assert bits.dtype == np.bool_
    assert bits.shape[1] == node.drives[node.name]
    codes: list[int] = bits_to_codes(bits).tolist()
    return codes


def test_a_table_looks_its_word_up() -> None:
    values = np.stack([CODES % 3 == 0, CODES > 4], axis=1)
    table = Table("t", A, TruthTable.exact(("x", "y", "z"), ("p", "q"), values))
    assert (table.reads, table.drives, table.latency) == ((A,), {"t": 2}, 0)
    assert value(table, WORDS) == (values @ [1, 2]).tolist()


def test_a_table_may_be_mapped_to_luts() -> None:
    network = LutNetwork(("x", "y", "z"), (Lut("n", ("x", "z"), 0b1000),), (("p", "n"), ("q", "1")))
    assert value(Table("t", A, network), WORDS) == [2, 2, 2, 2, 2, 3, 2, 3]


def test_a_threshold_compares_unsigned_words() -> None:
    node = Threshold("t", A, 5)
    assert (node.reads, node.drives, node.latency) == ((A,), {"t": 1}, 0)
    assert value(node, WORDS) == [0, 0, 0, 0, 0, 1, 1, 1]


def test_a_sum_counts_set_bits_or_adds_their_weights() -> None:
    node = Sum("s", A)
    assert (node.reads, node.drives, node.latency, node.weights) == ((A,), {"s": 2}, 0, (1, 1, 1))
    assert value(node, WORDS) == [0, 1, 1, 2, 1, 2, 2, 3]
    assert value(Sum("s", A, (5, 1, 2)), WORDS) == [0, 5, 1, 6, 2, 7, 3, 8]
    assert value(Sum("s", A, (-5, 1, 2), 5), WORDS) == [5, 0, 6, 1, 7, 2, 8, 3]
    assert value(Sum("s", A, (-5, 1, 2), modulus_bits=2), WORDS) == [0, 3, 1, 0, 2, 1, 3, 2]


def test_a_match_counts_equal_places() -> None:
    node = Match("m", A, B)
    assert (node.reads, node.drives, node.latency) == ((A, B), {"m": 2}, 0)
    assert value(node, WORDS, WORDS) == [3] * 8
    assert value(node, WORDS, WORDS ^ [[True, False, True]]) == [1] * 8


@pytest.mark.parametrize(("tie", "winner"), [("first", 0), ("last", 1)])
def test_the_largest_word_wins_and_the_rule_decides_ties(tie: Any, winner: int) -> None:
    node = ArgMax("w", (A, B, C), tie)
    assert (node.reads, node.drives, node.latency) == ((A, B, C), {"w": 2}, 0)
    a, b, c = codes_to_bits([7, 1, 0, 2], 3), codes_to_bits([3, 6, 0, 2], 3), codes_to_bits([1, 2, 1, 1], 2)
    assert value(node, a, b, c) == [0, 1, 2, winner]


def test_a_register_keeps_values_and_takes_cycles() -> None:
    node = Register("r", A, 4)
    assert (node.reads, node.drives, node.latency) == ((A,), {"r": 3}, 4)
    assert value(node, WORDS) == CODES.tolist()


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Table("t", A, TruthTable.exact(("x",), ("y",), WORDS[:2, :1])), "t reads 3 bits for"),
        (lambda: Sum("s", A, (1, 2)), "s adds 3 bits with the weights"),
        (lambda: Sum("s", A, (1, 2, 0)), "s adds 3 bits with the weights"),
        (lambda: Sum("s", A, (1, 2, -3), 2), "s adds the constant 2, so that sums may be negative"),
        (lambda: Sum("s", A, modulus_bits=64), r"s adds modulo 2\*\*64"),
        (lambda: Match("m", A, C), "m compares 3 with 2 bits"),
        (lambda: ArgMax("w", (A,)), "w cannot choose among 1 words"),
        (lambda: ArgMax("w", (A, B), "any"), "ties: any"),  # type: ignore[arg-type]
        (lambda: Register("r", A, 0), "r delays by 0 cycles; it may be 1 to 65536"),
        (lambda: Register("r", A, MAX_CYCLES + 1), "r delays by 65537 cycles"),
        (lambda: Threshold("t", WIDE, 1), "t compares words of more than 63 bits"),
        (lambda: ArgMax("m", (WIDE, WIDE)), "m compares words of more than 63 bits"),
        (lambda: Sum("s", A, (1 << 63,) * width_of(A)), "s adds"),
    ],
)
def test_what_makes_no_sense_is_refused(make: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        make()
