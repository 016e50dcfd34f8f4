"""Sums of tables are proved by substitution, however they are added, and nothing else is."""

from dataclasses import replace

import numpy as np
import pytest

from wnn2hdl.elaborate import component
from wnn2hdl.emit import verilog
from wnn2hdl.errors import ToolError
from wnn2hdl.ir import Style, TruthTable, codes_to_bits
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.nodes import Sum, Table
from wnn2hdl.ir.wires import Port, Slice, word_values
from wnn2hdl.minimise.circuit import minimise
from wnn2hdl.verify.addition import Sums, TableSum, answers, is_sum_of_tables
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
    return read_signals(Module((verilog(component(mapped, style=style), prefix="x_", header=[]),), "x_adder"))


def claim(constant: int = 50) -> Sums:
    codes = np.arange(1 << SIZE)
    tables = {word: values + (codes & 1) - 7 * (codes >> 3) for word, values in enumerate(CONTENTS)}
    everything = [np.ones(1 << SIZE, dtype=np.bool_)] * WORDS
    return Sums("words", SIZE, everything, (TableSum("y", tables, constant),))


@pytest.mark.parametrize("style", ["cells", "equations"])
def test_an_adder_of_tables_is_proved_in_either_style(style: Style) -> None:
    signals = adder(style)
    assert is_sum_of_tables(signals, claim())
    assert not is_sum_of_tables(signals, claim(constant=51))
    bits = np.random.default_rng(1).random((50, WORDS * SIZE)) < 0.5
    words = (bits.reshape(50, WORDS, SIZE) @ (1 << np.arange(SIZE))).T
    (total,) = claim().totals
    wanted = 50 + sum(table[words[word]] for word, table in total.words.items())
    assert word_values(answers(signals, {"words": bits})["y"]) == (np.asarray(wanted) % 256).tolist()


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
    sums = Sums("words", 1, [np.ones(2, dtype=np.bool_)] * 14, (TableSum("y", tables, 0),))
    assert not is_sum_of_tables(read_signals(Module((text,), "x")), sums)


def test_cells_that_are_no_gates_are_refused() -> None:
    text = "module x(input [1:0] words, output y); BLACK_BOX it (.A(words), .Y(y)); endmodule"
    with pytest.raises(ToolError, match="a cell is not a gate: it, a BLACK_BOX"):
        read_signals(Module((text,), "x"))
