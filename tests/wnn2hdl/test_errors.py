import pytest

from wnn2hdl.errors import (
    CheckError,
    ExtraMissingError,
    InputError,
    ModelFileError,
    ToolError,
    Wnn2hdlError,
)


def test_a_line_names_fault_value_and_mend() -> None:
    error = InputError("no such pixel bit", value="X9", hint="use R, G or B")
    assert str(error) == "no such pixel bit: X9; use R, G or B"


def test_value_and_mend_may_be_missing() -> None:
    assert str(InputError("the folder is empty")) == "the folder is empty"
    assert str(InputError("too few", value=0)) == "too few: 0"
    assert str(InputError("too few", hint="give more")) == "too few; give more"


def test_line_breaks_of_a_value_do_not_break_the_line() -> None:
    assert str(InputError("a tool said", value="one\n  two\tthree\n")) == "a tool said: one two three"


@pytest.mark.parametrize(
    ("error", "status"),
    [(InputError, 2), (ModelFileError, 2), (ExtraMissingError, 2), (ToolError, 2), (CheckError, 1)],
)
def test_exit_status_tells_bad_input_from_a_failed_check(error: type[Wnn2hdlError], status: int) -> None:
    assert error("fault").exit_status == status


def test_a_tool_error_keeps_what_was_run_and_what_it_printed() -> None:
    error = ToolError("failed", value="yosys", command="yosys -p x", output="syntax error")
    assert (error.command, error.output) == ("yosys -p x", "syntax error")
    assert str(error) == "failed: yosys"


def test_a_line_is_short_and_holds_nothing_that_a_terminal_obeys() -> None:
    value = "\x1b[31m\u202e" + "x" * 5000 + "the end"
    line = InputError("wrong", value=value, hint="correct it").line()
    assert line.startswith(r"wrong: \x1b[31m\u202ex")
    assert line.endswith("the end; correct it")
    assert line.isprintable()
    assert len(line) < 2000
