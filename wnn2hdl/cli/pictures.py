"""Options that say how pictures and masks are read, where their files do not; the same in every command."""

from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Any, get_args

import click

from wnn2hdl.cli.finite import SpanType
from wnn2hdl.images import MaskFormat, Palette, parse_code, spoken_codes
from wnn2hdl.raster import AlphaMeaning, Reading

Command = Callable[..., None]

READING = ("--bands", "--scale", "--alpha")
"""How pictures are read, for the sections of a command's help."""

MASKS = ("--palette", "--ignore")
"""How masks are read, for the same."""

SCALE_EXAMPLE = "0..3000"


class BandsType(click.ParamType[tuple[int, ...]]):
    """``3,2,1`` or ``1``: band numbers from 1."""

    name = "R,G,B"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[int, ...]:
        """The numbers."""
        if isinstance(value, tuple):
            return value
        numbers = str(value).split(",")
        if len(numbers) not in (1, 3) or not all(x.strip().isdecimal() and int(x) > 0 for x in numbers):
            self.fail(f"{value!r} is neither three band numbers, as in 3,2,1, nor one", param, ctx)
        return tuple(map(int, numbers))

    def spoken(self, value: tuple[int, ...]) -> str:
        """The value as users write it."""
        return ",".join(map(str, value))


class CodesType(click.ParamType[tuple[int, ...]]):
    """``255`` or ``0,#ff00ff``: what stands for something in masks."""

    name = "VALUE,..."

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[int, ...]:
        """The codes, see `wnn2hdl.images.codes`."""
        if isinstance(value, tuple):
            return value
        try:
            return tuple(map(parse_code, str(value).split(",")))
        except ValueError:
            self.fail(
                f"{value!r} is not a list of whole numbers or colours, as in 255 or #ff00ff", param, ctx
            )

    def spoken(self, value: tuple[int, ...]) -> str:
        """The value as users write it."""
        return spoken_codes(value)


bands_option = click.option("--bands", type=BandsType(), help="Choose the bands of red, green and blue.")
scale_option = click.option(
    "--scale",
    type=SpanType(SCALE_EXAMPLE),
    help="Map these values to 0 and 255, beyond 8 bits.",
)
alpha_option = click.option(
    "--alpha",
    type=click.Choice(get_args(AlphaMeaning)),
    help="Exclude pixels by alpha, or take it for data.",
)
palette_option = click.option(
    "--palette",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Read the masks' classes from this JSON file.",
)
ignore_option = click.option(
    "--ignore", type=CodesType(), help="Leave out pixels that have these mask values."
)


def reading_options(command: Command) -> Command:
    """Give a command the options of a `Reading`, which it gets as ``reading``."""

    @wraps(command)
    def reads(*, bands: Any, scale: Any, alpha: Any, **rest: Any) -> None:
        command(reading=Reading(bands, scale, alpha), **rest)

    return bands_option(scale_option(alpha_option(reads)))


def mask_options(command: Command) -> Command:
    """Give a command the options of a `MaskFormat`, which it gets as ``mask_format``, None without them."""

    @wraps(command)
    def reads(*, palette: Path | None, ignore: tuple[int, ...] | None, **rest: Any) -> None:
        command(mask_format=mask_format(palette, ignore), **rest)

    return palette_option(ignore_option(reads))


def mask_format(palette: Path | None, ignore: tuple[int, ...] | None) -> MaskFormat | None:
    """How masks are read, None if no option says it; raises InputError as `Palette.read`."""
    if palette is None and ignore is None:
        return None
    return MaskFormat(Palette.read(palette) if palette else None, frozenset(ignore or ()))
