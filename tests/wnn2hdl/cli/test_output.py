"""The display of progress, and what goes to stdout."""

import pytest
from rich.console import Console

from wnn2hdl.cli import output


def test_where_nothing_is_reported_nothing_is_shown(capsys: pytest.CaptureFixture[str]) -> None:
    with output.progress():
        pass
    assert capsys.readouterr().err == ""


def test_a_step_that_begins_anew_gets_a_line_of_its_own(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with output.progress() as report:
        for done in (0, 1, 2, 0, 1):
            report("reading images", done, 2)
    lines = [line for line in capsys.readouterr().err.splitlines() if line]
    assert [line.split()[-3] for line in lines] == ["100", "50"]
    assert all(line.startswith("reading images") for line in lines)


def test_a_terminal_shows_the_step_that_runs_however_many_are_done(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(
        output,
        "Console",
        lambda **_: Console(stderr=True, force_terminal=True, width=90, height=8, color_system=None),
    )
    with output.progress() as report:
        for number in range(12):
            report(f"step {number}", 0, 1)
            if number < 11:
                report(f"step {number}", 1, 1)
    shown = capsys.readouterr().err
    # What rich puts where it cuts off.
    assert "..." not in shown
    assert all(f"step {number} " in shown.split("step 0 ")[-1] for number in range(1, 12))


def test_json_knows_no_nan(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(ValueError, match="not JSON compliant"):
        output.emit({"accuracy": float("nan")}, "", as_json=True)
    output.emit({"accuracy": None}, "", as_json=True)
    assert capsys.readouterr().out == '{\n "accuracy": null\n}\n'
