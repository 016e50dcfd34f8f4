"""The commands and what each does, known without importing the code behind them."""

from collections.abc import Mapping
from importlib import import_module
from typing import NamedTuple

import click
from click.shell_completion import CompletionItem

from wnn2hdl.cli.help import Command


class Entry(NamedTuple):
    """Where a command is and what it does.

    Attributes:
        module: of `wnn2hdl.cli`; importing it adds the command to the group.
        help: one line for the list of commands.
    """

    module: str
    help: str


COMMANDS: Mapping[str, Entry] = {
    "compile": Entry("build", "Compile a model to proved Verilog and count its LUTs."),
    "demo": Entry("demo", "Run every stage on built-in sample data."),
    "doctor": Entry("doctor", "Show which tools are found and how to install the others."),
    "evaluate": Entry("evaluate", "Measure how accurate a model or a build is."),
    "import": Entry("import_", "Turn another tool's trained model into a model file."),
    "locate": Entry("locate", "Locate the frames of a flight on a map."),
    "narrow": Entry("narrow", "Narrow the words that a model of features reads."),
    "report": Entry("report", "Show builds on pages, compare them, and gate a merge."),
    "samples": Entry("samples", "Write sample landscapes or a sample flight to files."),
    "scan": Entry("scan", "Map deforestation in pictures and GeoTIFFs."),
    "simulate": Entry("check", "Run a build's circuit over a picture."),
    "sweep": Entry("sweep", "Train and cost a grid of architectures, and choose one."),
    "synth": Entry("check", "Count the LUTs of a build again."),
    "train": Entry("learn", "Train a model on labelled pictures."),
    "verify": Entry("check", "Check a build from its files alone."),
}


class LazyGroup(click.Group):
    """A group that imports a command's module when the command is asked for."""

    command_class = Command

    def list_commands(self, ctx: click.Context) -> list[str]:  # noqa: ARG002  # click's signature
        """The names, in the order of the list."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import a command; None if there is none of this name."""
        if cmd_name in COMMANDS and cmd_name not in self.commands:
            import_module(f"wnn2hdl.cli.{COMMANDS[cmd_name].module}")
        return super().get_command(ctx, cmd_name)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:  # noqa: ARG002
        """Write the list of commands."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, entry.help) for name, entry in COMMANDS.items()])

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        """The commands that begin with what was typed, then the group's own options."""
        names = [
            CompletionItem(name, help=entry.help)
            for name, entry in COMMANDS.items()
            if name.startswith(incomplete)
        ]
        return names + click.Command.shell_complete(self, ctx, incomplete)
