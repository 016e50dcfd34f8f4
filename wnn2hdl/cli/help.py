"""A command whose help groups its options, and that suggests an option for one it does not have."""

import textwrap
from collections.abc import Mapping, Sequence
from typing import Any

import click

Sections = Mapping[str, Sequence[str]]
"""Headings of a command's help, each with its options by their long names, as in ``--seed``."""


SCREEN = 45
"""Lines that a terminal shows at once, about."""

MORE = "More, explained by --help-all"

_NAMES_LEFT = 24
"""Columns left of the names of options in that section."""

_EVERYTHING = "wnn2hdl.help_all"
"""In a context's `meta` while all options are to be explained."""


def _explain_all(context: click.Context, _: click.Parameter, asked: bool) -> None:
    if asked and not context.resilient_parsing:
        context.meta[_EVERYTHING] = True
        click.echo(context.get_help(), color=context.color)
        context.exit()


_help_all = click.Option(
    ["--help-all"],
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_explain_all,
    help="Show this message with all options explained.",
)


class Command(click.Command):
    """A command of wnn2hdl.

    Args:
        sections: the options under each heading; all others are listed under "Options" at the end.
    """

    def __init__(self, *args: Any, sections: Sections | None = None, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.sections = sections or {}

    def get_params(self, ctx: click.Context) -> list[click.Parameter]:
        """The parameters; a command with sections has one that explains what does not fit a screen."""
        parameters = super().get_params(ctx)
        return [*parameters, _help_all] if self.sections else parameters

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the options under their headings.

        From the last section on, those that would not fit a screen are listed by their names alone.
        """
        rows: dict[str, list[tuple[str, str]]] = {heading: [] for heading in (*self.sections, "Options")}
        names: dict[str, list[str]] = {heading: [] for heading in rows}
        for parameter in self.get_params(ctx):
            record = parameter.get_help_record(ctx)
            if record is not None and isinstance(parameter, click.Option):
                heading = self._heading(parameter)
                rows[heading].append(record)
                names[heading].append(max(parameter.opts, key=len))
        shown = {
            heading: _section(heading, records, formatter) for heading, records in rows.items() if records
        }
        named: list[tuple[str, str]] = []
        before = formatter.getvalue()
        for heading in reversed(list(self.sections)[1:]):
            lines = "".join([before, *shown.values(), _section(MORE, named, formatter)]).count("\n")
            if lines <= SCREEN or ctx.meta.get(_EVERYTHING):
                break
            del shown[heading]
            named.insert(0, (heading, _unbroken(names[heading], formatter.width)))
        options = shown.pop("Options")
        formatter.write("".join([*shown.values(), _section(MORE, named, formatter), options]))

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


def _section(heading: str, rows: Sequence[tuple[str, str]], formatter: click.HelpFormatter) -> str:
    """A section as ``formatter`` would write it; nothing if it has no rows."""
    if not rows:
        return ""
    apart = click.HelpFormatter(formatter.indent_increment, formatter.width)
    with apart.section(heading):
        apart.write_dl(rows)
    return f"\n{apart.getvalue()}"


def _unbroken(names: Sequence[str], width: int) -> str:
    """Names in lines that click leaves as they are: it would break them at hyphens."""
    lines = textwrap.wrap(", ".join(names), max(width - _NAMES_LEFT, 20), break_on_hyphens=False)
    return "\n".join(["\b", *lines])


def _words(option: str) -> set[str]:
    """The words of a long option; none of a short one."""
    return {word for word in option.removeprefix("--").split("-") if len(word) > 1}
