"""From cells to statements."""

from collections.abc import Mapping, Sequence

import pytest

from wnn2hdl.emit.netlist import BitVector, Cell, Module, Net
from wnn2hdl.emit.statements import statements

A, B, Y = (2, 3, 4, 5), (6, 7, 8, 9), (20, 21, 22, 23)
UNSIGNED = {"A_SIGNED": "0", "B_SIGNED": "0"}
SIGNED = {"A_SIGNED": "1", "B_SIGNED": "1"}


def cell(kind: str, output: BitVector = Y, *, signs: dict[str, str] = UNSIGNED, **inputs: BitVector) -> Cell:
    return Cell(f"${output[0]}", kind, signs, {}, inputs or {"A": A, "B": B}, {"Y": output})


def text(
    cells: Sequence[Cell], output: BitVector = Y, nets: Mapping[str, Net] | None = None
) -> dict[str, str]:
    """The expression of each net."""
    module = Module(
        "m", {"a": A, "b": B}, {"y": output}, {"y": Net(output, False, None), **(nets or {})}, tuple(cells)
    )
    return {statement.drives[0]: statement.text for statement in statements(module)[0]}


@pytest.mark.parametrize(
    ("kind", "expected"),
    [
        ("$and", "a & b"),
        ("$or", "a | b"),
        ("$xor", "a ^ b"),
        ("$add", "a + b"),
        ("$sub", "a - b"),
        ("$mul", "a * b"),
    ],
)
def test_operators_of_words(kind: str, expected: str) -> None:
    assert text([cell(kind)]) == {"y": expected}


@pytest.mark.parametrize(
    ("kind", "expected"),
    [
        ("$ge", "a >= b"),
        ("$gt", "a > b"),
        ("$le", "a <= b"),
        ("$lt", "a < b"),
        ("$eq", "a == b"),
        ("$ne", "a != b"),
    ],
)
def test_comparisons_have_one_bit_and_may_be_of_signed_words(kind: str, expected: str) -> None:
    assert text([cell(kind, (20,))], (20,)) == {"y": expected}
    left, operator, right = expected.split()
    signed = f"$signed({left}) {operator} $signed({right})"
    assert text([cell(kind, (20,), signs=SIGNED)], (20,)) == {"y": signed}


@pytest.mark.parametrize(
    ("kind", "expected"),
    [
        ("$reduce_or", "|a"),
        ("$reduce_bool", "|a"),
        ("$reduce_and", "&a"),
        ("$reduce_xor", "^a"),
        ("$logic_not", "~|a"),
    ],
)
def test_reductions(kind: str, expected: str) -> None:
    assert text([cell(kind, (20,), A=A)], (20,)) == {"y": expected}


def test_one_operand() -> None:
    assert text([cell("$not", A=A)]) == {"y": "~a"}
    assert text([cell("$neg", A=A)]) == {"y": "-a"}
    assert text([cell("$mux", A=A, B=B, S=(2,))]) == {"y": "a[0] ? b : a"}


def test_operands_get_the_width_of_their_operator() -> None:
    assert text([cell("$add", A=(2, 3), B=B)]) == {"y": "{2'h0, a[1:0]} + b"}
    assert text([cell("$add", signs=SIGNED, A=(2, 3), B=B)]) == {"y": "{a[1], a[1], a[1:0]} + b"}
    assert text([cell("$ge", (20,), signs=SIGNED, A=(2, 3), B=B)], (20,)) == {
        "y": "$signed({a[1], a[1], a[1:0]}) >= $signed(b)"
    }
    assert text([cell("$sub", (20, 21))], (20, 21)) == {"y": "a[1:0] - b[1:0]"}


def test_one_bit_operations_that_are_read_once_stand_where_they_are_read() -> None:
    inner = cell("$and", (30,), A=(2,), B=(3,))
    inverter = cell("$not", (31,), A=(30,))
    outer = cell("$or", (20,), A=(31,), B=(4,))
    nets = {name: Net((bit,), True, None) for name, bit in (("$1", 30), ("$2", 31))}
    assert text([inner, inverter, outer], (20,), nets) == {"y": "~(a[0] & a[1]) | a[2]"}
    named = nets | {"both": Net((30,), False, None)}
    assert text([inner, inverter, outer], (20,), named) == {"both": "a[0] & a[1]", "y": "~both | a[2]"}


def test_what_is_read_twice_has_a_wire() -> None:
    inner = cell("$and", (30,), A=(2,), B=(3,))
    outer = cell("$or", (20,), A=(30,), B=(4,)), cell("$xor", (21,), A=(30,), B=(5,))
    found = text([inner, *outer], (20, 21), {"$1": Net((30,), True, None)})
    assert found["term_30"] == "a[0] & a[1]"
    assert found["y"] == "{term_21, term_20}"


def test_what_nothing_reads_is_left_out_but_for_the_wire_of_the_unused() -> None:
    useless, unused = cell("$and", (30,), A=(2,), B=(3,)), cell("$reduce_or", (31,), A=(4, 5))
    nets = {"useless": Net((30,), False, None), "unused": Net((31,), False, None)}
    assert text([cell("$and"), useless, unused], nets=nets) == {"y": "a & b", "unused": "|a[3:2]"}


def test_two_ports_of_the_same_bits_are_both_driven() -> None:
    nets = {name: Net(Y, False, None) for name in ("y", "z")}
    module = Module("m", {"a": A, "b": B}, {"y": Y, "z": Y, "w": A}, nets, (cell("$and"),))
    assert {x.drives[0]: x.text for x in statements(module)[0]} == {"y": "a & b", "z": "y", "w": "a"}


def test_a_flip_flop_has_an_edge_and_a_start_value() -> None:
    register = Cell("$1", "$dff", {"CLK_POLARITY": "1"}, {}, {"CLK": (2,), "D": B}, {"Q": Y})
    module = Module("m", {"clk": (2,), "b": B}, {"y": Y}, {"y": Net(Y, False, 5)}, (register,))
    ((statement,), widths) = statements(module)
    assert (statement.text, statement.clock, statement.initial) == ("y <= b;", "posedge clk", 5)
    assert widths == {"clk": 1, "b": 4, "y": 4}


def test_an_instance_has_its_attributes_parameters_and_pins() -> None:
    lut = Cell(
        "n0_cell", "LUT2", {"INIT": "1000"}, {"DONT_TOUCH": "yes"}, {"I0": (2,), "I1": (7,)}, {"O": (20,)}
    )
    module = Module("m", {"a": A, "b": B}, {"y": (20,)}, {"y": Net((20,), False, None)}, (lut,))
    ((statement,), _) = statements(module)
    assert statement.head == '(* DONT_TOUCH = "yes" *) LUT2 #(.INIT(4\'h8)) n0_cell'
    assert statement.text == ".I0(a[0]), .I1(b[1]), .O(y)"


@pytest.mark.parametrize("kind", ["$shiftx", "$adff", "$dlatch"])
def test_cells_that_no_statement_is_known_for_are_refused(kind: str) -> None:
    with pytest.raises(NotImplementedError, match=f"m has a \\{kind}, for which there is no Verilog"):
        text([cell(kind)])
