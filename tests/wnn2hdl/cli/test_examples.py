"""Every command line shown to a reader, in help, README and documentation, has options that exist."""

import re
import shlex
from pathlib import Path

import click
import pytest

from wnn2hdl.cli.commands import COMMANDS
from wnn2hdl.cli.main import app

ROOT = Path(__file__).parents[3]
SHOWN = re.compile(r"^ *(?:\$ )?wnn2hdl ((?:[^\n\\]|\\\n|\\(?!\n))+)", re.MULTILINE)

HELP = {
    name: command.help or "" for name in COMMANDS if (command := app.get_command(click.Context(app), name))
}

SOURCES = {
    **{f"{name} --help": text for name, text in HELP.items()},
    **{
        str(path.relative_to(ROOT)): path.read_text(encoding="utf-8")
        for path in (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")))
    },
}


def examples(text: str) -> list[list[str]]:
    """The words of each command line; what follows a pipe or a comment is left out."""
    lines = (match.group(1).replace("\\\n", " ") for match in SHOWN.finditer(text))
    return [shlex.split(re.split(r" \| | #", line)[0], comments=True) for line in lines]


def require_options(words: list[str]) -> None:
    """Raise click's error if a command or an option of the line does not exist."""
    if words[0].startswith("-"):
        return
    command = app.get_command(click.Context(app), words[0])
    assert command is not None, f"no such command: {words[0]}"
    # A synopsis puts optional parts in brackets.
    arguments = [word.strip("[]()") for word in words[1:] if word not in {"|", "…"}]
    command.make_parser(click.Context(command)).parse_args([word for word in arguments if word])


@pytest.mark.parametrize("source", SOURCES)
def test_the_lines_shown_are_lines_that_work(source: str) -> None:
    for words in examples(SOURCES[source]):
        require_options(words)


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_shows_two_examples(name: str) -> None:
    assert len(examples(HELP[name])) == 2


def test_a_wrong_option_would_be_seen() -> None:
    (words,) = examples("  wnn2hdl compile model.json --no-such -o x")
    with pytest.raises(click.NoSuchOption):
        require_options(words)
