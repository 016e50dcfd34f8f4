"""Help says what each option does, in a sentence and on one screen; a wrong option leads to the right one."""

import re
from collections.abc import Callable
from typing import Any

import click
import pytest
from click.testing import CliRunner

from wnn2hdl.cli.commands import COMMANDS
from wnn2hdl.cli.help import SCREEN, Command
from wnn2hdl.cli.main import app


def command(name: str) -> Command:
    found = app.get_command(click.Context(app), name)
    assert isinstance(found, Command)
    return found


def options(name: str) -> list[click.Option]:
    return [parameter for parameter in command(name).params if isinstance(parameter, click.Option)]


@pytest.mark.parametrize("name", COMMANDS)
def test_each_option_is_explained_in_a_sentence(name: str) -> None:
    for option in options(name):
        text = re.sub(r"  \[default: .*\]$", "", option.help or "")
        assert re.fullmatch(r"[A-Z].* .*\.", text), f"{option.opts[0]}: {text!r}"


@pytest.mark.parametrize("name", COMMANDS)
def test_help_fits_a_screen(name: str) -> None:
    done = CliRunner().invoke(app, [name, "--help"], terminal_width=80)
    assert len(done.output.splitlines()) <= SCREEN


@pytest.mark.parametrize("name", COMMANDS)
def test_help_names_every_option_and_help_all_explains_them(name: str) -> None:
    shown = CliRunner().invoke(app, [name, "--help"], terminal_width=80).output
    every = CliRunner().invoke(app, [name, "--help-all"], terminal_width=80)
    known = every.output if every.exit_code == 0 else shown
    assert (every.exit_code == 0) == bool(command(name).sections)
    for option in options(name):
        assert max(option.opts, key=len) in shown
        first, *_ = (option.help or "").split(",")[0].split("  [")[0].rsplit(" ", 2)
        assert " ".join(first.split()) in " ".join(known.split())


def test_what_does_not_fit_is_listed_by_name() -> None:
    shown = CliRunner().invoke(app, ["compile", "--help"], terminal_width=80).output
    assert "More, explained by --help-all:\n  Edge filter" in shown
    assert "Learn N patterns." not in shown
    assert "More, explained" not in CliRunner().invoke(app, ["compile", "--help-all"]).output


def test_all_that_decides_a_circuit_stands_under_a_heading() -> None:
    listed = {option for names in command("compile").sections.values() for option in names}
    assert {max(option.opts, key=len) for option in options("compile")} - listed == {"--output", "--json"}


@pytest.mark.parametrize("name", COMMANDS)
def test_sections_name_options_that_exist_once(name: str) -> None:
    listed = [option for names in command(name).sections.values() for option in names]
    known = {spelling for option in options(name) for spelling in option.opts}
    assert len(listed) == len(set(listed))
    assert set(listed) <= known


def kind(option: click.Option) -> str:
    if option.is_flag:
        return "flag"
    return "place" if isinstance(option.type, click.Path) else "value"


def test_an_option_is_a_flag_a_place_or_a_value_in_all_commands() -> None:
    kinds: dict[str, set[str]] = {}
    for name in COMMANDS:
        for option in options(name):
            kinds.setdefault(option.opts[0], set()).add(kind(option))
    assert {name: found for name, found in kinds.items() if len(found) > 1} == {}


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        (("train", "--pixel-budget", "2"), "No such option '--pixel-budget'; did you mean --luts-per-pixel?"),
        (
            ("compile", "--luts-per-pixel", "2"),
            "No such option '--luts-per-pixel'; did you mean --edge-luts or --frames-per-second or "
            "--max-luts or --pixels-per-clock?",
        ),
        (("verify", "--fast"), "No such option '--fast'."),
    ],
)
def test_a_wrong_option_leads_to_those_that_share_a_word(
    run: Callable[..., Any], line: tuple[str, ...], complaint: str
) -> None:
    assert run(*line).complaint() == f"wnn2hdl: {complaint}"
