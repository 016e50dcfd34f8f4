"""Sums of tables are proved by substitution, however they are added, and nothing else is."""

from dataclasses import replace

import numpy as np
import pytest

from wnn2hdl.elaborate import component
from wnn2hdl.emit import verilog
from wnn2hdl.errors import CheckError, ToolError
from wnn2hdl.ir import Style, TruthTable, codes_to_bits
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.nodes import Sum, Table
from wnn2hdl.ir.wires import Port, Slice, word_values
from wnn2hdl.minimise.circuit import minimise
from wnn2hdl.verify.addition import Sums, TableSum, is_sum_of_tables, is_wrong_on_samples
from wnn2hdl.verify.equivalence import Circuit as Module
from wnn2hdl.verify.signals import Signals, read_signals

WORDS, SIZE = 6, 4
CONTENTS = np.random.default_rng(0).integers(0, 32, (WORDS, 1 << SIZE))


def silent(step: str, done: int, total: int) -> None:
    pass


def adder(style: Style, *, flip: int = 0) -> Signals:
    """Six words, of which each adds five tables and its lowest bit, less seven times its highest bit.

    Args:
        style: how its LUTs are written.
        flip: is mixed into one table.
    """
    port = Port("words", WORDS * SIZE)
    names = tuple(f"i{place}" for place in range(SIZE))
    nodes: list[Table | Sum] = []
    weights: dict[Slice, int] = {}
    for word, values in enumerate(CONTENTS):
        bits = tuple(Slice("words", SIZE * word + place) for place in range(SIZE))
        columns = codes_to_bits(values ^ (flip if word == 2 else 0), 5)
        for place, column in enumerate(columns.T):
            table = Table(f"t{word}_{place}", bits, TruthTable.exact(names, ("o",), column[:, np.newaxis]))
            nodes.append(table)
            weights[Slice(table.name)] = 1 << place
        weights |= {bits[0]: 1, bits[-1]: -7}
    total = Sum("total", tuple(weights), tuple(weights.values()), 50, modulus_bits=8)
    circuit = Circuit("adder", "Adds.", (port,), (*nodes, total), {"y": (Slice("total", 0, 8),)})
    mapped = minimise(circuit, 0, silent).circuit
    return read(verilog(component(mapped, style=style), prefix="x_", header=[]), "x_adder")


def read(text: str, top: str, latency: int = 0) -> Signals:
    (signals,) = read_signals([Module((text,), top, latency)])
    assert signals is not None
    return signals


def claim(constant: int = 50) -> Sums:
    codes = np.arange(1 << SIZE)
    tables = {word: values + (codes & 1) - 7 * (codes >> 3) for word, values in enumerate(CONTENTS)}
    everything = [np.ones(1 << SIZE, dtype=np.bool_)] * WORDS
    return Sums("words", SIZE, everything, (TableSum("y", 8, tables, constant),))


@pytest.mark.parametrize("style", ["cells", "equations"])
def test_an_adder_of_tables_is_proved_in_either_style(style: Style) -> None:
    signals = adder(style)
    assert is_sum_of_tables(signals, claim())
    assert not is_wrong_on_samples(signals, claim())
    assert not is_sum_of_tables(signals, claim(constant=51))
    assert is_wrong_on_samples(signals, claim(constant=51))
    bits = np.random.default_rng(1).random((50, WORDS * SIZE)) < 0.5
    words = (bits.reshape(50, WORDS, SIZE) @ (1 << np.arange(SIZE))).T
    (total,) = claim().totals
    wanted = 50 + sum(table[words[word]] for word, table in total.words.items())
    assert word_values(signals.answers({"words": bits})["y"]) == (np.asarray(wanted) % 256).tolist()


def test_one_wrong_table_or_counter_is_not_proved() -> None:
    assert not is_sum_of_tables(adder("cells", flip=4), claim())


def test_what_cannot_occur_does_not_matter() -> None:
    signals, sums = adder("cells", flip=4), claim()
    kept = CONTENTS[2] & 4 == 0
    assert not is_sum_of_tables(
        signals, replace(sums, occurring=[*sums.occurring[:2], kept, *sums.occurring[3:]])
    )
    wrong_by_four = replace(sums.totals[0], constant=54)
    occurring = [*sums.occurring[:2], kept, *sums.occurring[3:]]
    assert is_sum_of_tables(signals, replace(sums, occurring=occurring, totals=(wrong_by_four,)))


def test_a_function_of_two_words_that_is_no_sum_is_not_proved() -> None:
    text = "module x(input [13:0] words, output y); assign y = words[3] & words[4]; endmodule"
    tables = {word: np.array([0, 1]) for word in range(14)}
    sums = Sums("words", 1, [np.ones(2, dtype=np.bool_)] * 14, (TableSum("y", 1, tables, 0),))
    assert not is_sum_of_tables(read(text, "x"), sums)


def test_cells_that_are_no_gates_are_refused() -> None:
    text = "module x(input [1:0] words, output reg y); always @* if (words[0]) y = words[1]; endmodule"
    with pytest.raises(ToolError, match=r"a cell is not a gate: .*DLATCH"):
        read(text, "x")


def test_what_is_no_function_of_the_inputs_is_refused() -> None:
    register = "module x(input clk, input a, output reg y); always @(posedge clk) y <= a; endmodule"
    with pytest.raises(CheckError, match="the circuit has registers, so it is not combinational: x"):
        read(register, "x")
    with pytest.raises(CheckError, match=r"reads an undefined value \(x\)"):
        read("module x(input a, output y); assign y = 1'bx; endmodule", "x")


COUNTER = """
  wire odd = bits[0] ^ bits[1] ^ bits[2];
  wire carry = bits[0] & bits[1] | bits[0] & bits[2] | bits[1] & bits[2];
"""


@pytest.mark.parametrize(
    ("total", "weights", "offset", "is_shown"),
    [
        ("{carry, odd}", (1, 1, 1), 0, True),
        ("{carry, odd}", (1, 1, 0), 0, False),
        ("{carry, odd}", (1, 1, 1), 1, False),
        ("{odd, carry}", (1, 1, 1), 0, False),
        ("{carry, ~odd}", (1, 1, 1), 0, False),
        ("{1'b0, carry, odd}", (1, 1, 1), 0, False),
    ],
)
def test_a_counter_of_bits_is_shown_to_add_them_and_nothing_else(
    total: str, weights: tuple[int, ...], offset: int, is_shown: bool
) -> None:
    width = 3 if "1'b0" in total else 2
    text = (
        f"module x(input [2:0] bits, output [{width - 1}:0] total);{COUNTER}assign total = {total}; endmodule"
    )
    assert is_sum_of_tables(read(text, "x"), Sums.of_bits(weights, offset)) == is_shown


FULL_ADDER = (
    "module add(input a, b, c, output s, k); assign s = a ^ b ^ c, k = a & b | (a ^ b) & c; endmodule\n"
)


def ripple(width: int, registers: str, last: str) -> str:
    """``2 * width`` bits, the weight of bit ``i`` is ``2**(i // 2)``, one cycle late."""
    lines = [f"module x(input clk, input [{2 * width - 1}:0] bits, output [{width}:0] total);"]
    lines += [f"  wire [{width}:0] k; wire [{width}:0] s; reg [{width}:0] kept;", "  assign k[0] = 1'b0;"]
    for i in range(width):
        pins = f".a(bits[{2 * i}]), .b(bits[{2 * i + 1}]), .c(k[{i}]), .s(s[{i}]), .k(k[{i + 1}])"
        lines.append(f"  add add_{i} ({pins});")
    lines += [f"  assign s[{width}] = k[{width}];", f"  always @(posedge clk) {registers}"]
    return FULL_ADDER + "\n".join([*lines, f"  assign total = {last};", "endmodule"])


@pytest.mark.parametrize(
    ("registers", "last", "is_shown"),
    [
        ("kept <= s;", "kept", True),
        ("kept <= s;", "{kept[8:1], s[0]}", False),
        ("kept <= s ^ (kept & 2);", "kept", False),
    ],
    ids=["in step", "a bit too early", "fed back"],
)
def test_registers_of_a_sum_have_to_be_in_step(registers: str, last: str, is_shown: bool) -> None:
    sums = Sums.of_bits([1 << i // 2 for i in range(16)], 0)
    module = Module((ripple(8, registers, last),), "x", 1)
    (signals,) = read_signals([module])
    assert (signals is not None and is_sum_of_tables(signals, sums, 1)) == is_shown
    assert signals is None or not is_sum_of_tables(signals, sums, 2)
