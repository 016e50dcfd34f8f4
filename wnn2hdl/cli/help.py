"""A command whose help groups its options, and that suggests an option for one it does not have."""

from collections.abc import Mapping, Sequence
from typing import Any

import click

Sections = Mapping[str, Sequence[str]]
"""Headings of a command's help, each with its options by their long names, as in ``--seed``."""


class Command(click.Command):
    """A command of wnn2hdl.

    Args:
        sections: the options under each heading; all others are listed under "Options" at the end.
    """

    def __init__(self, *args: Any, sections: Sections | None = None, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.sections = sections or {}

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the options under their headings."""
        rows: dict[str, list[tuple[str, str]]] = {heading: [] for heading in (*self.sections, "Options")}
        for parameter in self.get_params(ctx):
            record = parameter.get_help_record(ctx)
            if record is not None and isinstance(parameter, click.Option):
                rows[self._heading(parameter)].append(record)
        for heading, records in rows.items():
            if records:
                with formatter.section(heading):
                    formatter.write_dl(records)

    def _heading(self, parameter: click.Parameter) -> str:
        return next(
            (heading for heading, names in self.sections.items() if set(names) & set(parameter.opts)),
            "Options",
        )

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse the arguments; where click knows no similar option, suggest those that share a word."""
        try:
            return super().parse_args(ctx, args)
        except click.NoSuchOption as error:
            words = _words(error.option_name)
            alike = [name for parameter in self.params for name in parameter.opts if words & _words(name)]
            if error.possibilities or not alike:
                raise
            message = f"No such option '{error.option_name}'; did you mean {' or '.join(sorted(alike))}?"
            raise click.UsageError(message, ctx) from error


def _words(option: str) -> set[str]:
    """The words of a long option; none of a short one."""
    return {word for word in option.removeprefix("--").split("-") if len(word) > 1}
