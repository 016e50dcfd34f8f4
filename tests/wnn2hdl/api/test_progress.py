"""Progress is shown where somebody watches, and nowhere else."""

import io
import sys

import pytest

from wnn2hdl.api.progress import silent, watched


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_a_terminal_shows_a_line_that_is_wiped(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    with watched(None) as report:
        report("reading images", 1, 3)
    shown = terminal.getvalue()
    assert "\rreading images: 1 of 3 " in shown
    assert shown.endswith(" \r")
    assert "\n" not in shown


def test_a_file_gets_nothing() -> None:
    with watched(None) as report:
        assert report is silent


def test_the_caller_may_listen() -> None:
    heard: list[tuple[str, int, int]] = []
    with watched(lambda *step: heard.append(step)) as report:
        report("reading images", 1, 3)
    assert heard == [("reading images", 1, 3)]
