"""What may stand in Verilog as it is, and that circuits are made of nothing else."""

import pytest

from wnn2hdl.ir import Lut, LutNetwork
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.nodes import Sum
from wnn2hdl.ir.verilog_text import check_comment, check_identifier
from wnn2hdl.ir.wires import Port, Slice

HOSTILE = [
    "",
    " ",
    "a b",
    "a;",
    "a\n",
    "a\\",
    "\\a",
    "a.b",
    "a$",
    "1a",
    "_a",
    "a_",
    "a__b",
    "é",
    "a" * 5000,
    "a[0]",
    "*/",
    None,
]


@pytest.mark.parametrize("name", ["R7", "t0", "x3_t0", "response_0", "a" * 200])
def test_letters_digits_and_underscores_are_a_name(name: str) -> None:
    check_identifier(name)


@pytest.mark.parametrize("name", HOSTILE)
def test_anything_else_is_none(name: object) -> None:
    with pytest.raises(ValueError, match="is not a name") as caught:
        check_identifier(name)
    assert len(str(caught.value)) < 200


@pytest.mark.parametrize("name", ["module", "always", "logic", "ENTITY", "Signal", "int"])
def test_no_name_is_a_reserved_word_of_any_language(name: str) -> None:
    with pytest.raises(ValueError, match="reserved word"):
        check_identifier(name)


@pytest.mark.parametrize(
    "line",
    ["a\nb", "a\rb", "a\fb", "a\vb", "a\x85b", "a\u2028b", "a\\", "a\0", "\ufeffa", 7],
)
def test_a_comment_ends_with_its_line_whatever_tool_reads_it(line: object) -> None:
    with pytest.raises(ValueError, match="is not a line of a comment"):
        check_comment(line)


@pytest.mark.parametrize(
    "line", ["synthesis translate_off", " Synopsys full_case", "pragma x", "verilator lint_off X"]
)
def test_a_comment_is_no_command_to_a_tool(line: str) -> None:
    with pytest.raises(ValueError, match="is a command to a tool"):
        check_comment(line)


def test_other_comments_may_name_tools() -> None:
    check_comment("LUTs counted by synthesis; */ and ` are harmless here.")


@pytest.mark.parametrize("name", ["a b", "wire"])
def test_circuits_and_networks_have_no_other_names(name: str) -> None:
    with pytest.raises(ValueError, match=r"not a name|reserved"):
        Port(name, 1)
    port, word = Port("a", 2), (Slice("a", 0, 2),)
    with pytest.raises(ValueError, match=r"not a name|reserved"):
        Circuit("c", "Counts.", (port,), (Sum(name, word),), {"y": (Slice(name, 0, 2),)})
    with pytest.raises(ValueError, match=r"not a name|reserved"):
        Circuit("c", "Counts.", (port,), (), {name: word})
    for network in (((name,), "x", "y"), (("a",), name, "y"), (("a",), "x", name)):
        inputs, cell, output = network
        with pytest.raises(ValueError, match=r"not a name|reserved"):
            LutNetwork(inputs, (Lut(cell, inputs, 1),), ((output, cell),))


def test_a_circuit_may_be_called_like_a_reserved_word_since_its_module_has_a_prefix() -> None:
    port = Port("a", 1)
    assert Circuit("edge", "An edge.", (port,), (), {"y": port.word}).name == "edge"
    with pytest.raises(ValueError, match="is not a name"):
        Circuit("edge;", "An edge.", (port,), (), {"y": port.word})
    with pytest.raises(ValueError, match="is not a line of a comment"):
        Circuit("edge", "An edge.\nmodule x; endmodule", (port,), (), {"y": port.word})
