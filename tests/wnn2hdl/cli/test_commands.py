"""The table of commands is that of the code, and asking for the list imports none of it."""

import subprocess
import sys

import click
import pytest

from wnn2hdl.cli.commands import COMMANDS
from wnn2hdl.cli.main import app

WIDTH = 80
HEAVY = ("numpy", "scipy", "sklearn", "cv2", "matplotlib", "jsonschema", "amaranth", "rich")


@pytest.mark.parametrize("name", COMMANDS)
def test_each_command_is_where_the_table_says(name: str) -> None:
    command = app.get_command(click.Context(app), name)
    assert command is not None
    assert command.name == name
    assert command.callback is not None
    assert command.callback.__module__ == f"wnn2hdl.cli.{COMMANDS[name].module}"
    # The pages of the documentation find it by this name.
    assert command.callback.__name__ == f"{name}_command"


def test_no_command_is_left_out_of_the_table() -> None:
    for name in COMMANDS:
        app.get_command(click.Context(app), name)
    assert app.commands.keys() == COMMANDS.keys()
    assert app.list_commands(click.Context(app)) == sorted(COMMANDS)


def test_each_help_is_a_sentence_that_fits_its_line() -> None:
    column = max(map(len, COMMANDS)) + 4
    for entry in COMMANDS.values():
        assert entry.help.endswith(".")
        assert column + len(entry.help) <= WIDTH


def test_an_unknown_command_is_none() -> None:
    assert app.get_command(click.Context(app), "wish") is None


@pytest.mark.parametrize("option", ["--help", "--version"])
def test_help_and_version_import_nothing_heavy(option: str) -> None:
    program = f"""
import sys
sys.argv = ["wnn2hdl", {option!r}]
from wnn2hdl.cli import main
status = main()
print([name for name in {HEAVY!r} if name in sys.modules], status)
"""
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=True
    )
    assert done.stdout.splitlines()[-1] == "[] 0"
