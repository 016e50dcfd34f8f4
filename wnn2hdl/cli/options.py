"""Options that several commands share."""

import re
import shlex
from collections.abc import Callable, Container, Iterable
from pathlib import Path
from typing import Any, TypeVar

import click
from click.core import ParameterSource

from wnn2hdl.cli.finite import FiniteRange
from wnn2hdl.dataset import (
    SAMPLE_IMAGES,
    SAMPLE_SIDE,
    Dataset,
    from_masks,
    from_regions,
    from_samples,
)
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.squares import MAX_SIDE
from wnn2hdl.images import MaskFormat
from wnn2hdl.ir.engine import Shape
from wnn2hdl.raster import Reading

Decorated = TypeVar("Decorated", bound=Callable[..., Any])

folder = click.Path(file_okay=False, path_type=Path)
file = click.Path(dir_okay=False, path_type=Path)

images_option = click.option("--images", type=folder, help="Read pictures from this folder (needs --masks).")
masks_option = click.option("--masks", type=folder, help="Read masks: 0 is forest, another value deforested.")
bits_option = click.option(
    "--bits",
    metavar="R7,R6,...",
    help="Read these bits.  [default: the 4 high bits each]",
)
allow_unproved_option = click.option(
    "--allow-unproved",
    multiple=True,
    metavar="PART",
    help="Accept that a limit leaves this part unproved.",
)
share_option = click.option(
    "--share",
    type=FiniteRange(0, 1, min_open=True),
    metavar="SHARE",
    default=0.5,
    show_default=True,
    help="Let this share of a square's pixels vote.",
)
seed_option = click.option(
    "--seed",
    type=click.IntRange(min=0),
    metavar="N",
    default=0,
    show_default=True,
    help="Set the random seed.",
)
scheduler_option = click.option(
    "--scheduler", metavar="ADDRESS", help="Run on this Dask scheduler, as in tcp://host:8786."
)


def jobs_option(what: str) -> Callable[[Decorated], Decorated]:
    """The option that says how much is done at a time; ``what``, in the plural, is worked on."""
    return click.option(
        "--jobs",
        type=click.IntRange(min=1),
        metavar="N",
        help=f"Work on N {what} at a time.  [default: one per core]",
    )


def square_option(text: str) -> Callable[[Decorated], Decorated]:
    """The option that gives the side of the squares in which pixels vote, with its help."""
    return click.option("--square", type=click.IntRange(1, MAX_SIDE), metavar="SIDE", help=text)


def output_option(text: str, *, is_file: bool = False, **settings: Any) -> Callable[[Decorated], Decorated]:
    """The option that says where results go: a folder, or a file; with its help and click's settings."""
    return click.option("-o", "--output", "output", type=file if is_file else folder, help=text, **settings)


class SizeType(click.ParamType[Shape]):
    """Rows and columns of a picture."""

    name = "ROWSxCOLUMNS"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Shape:
        """The two numbers."""
        if isinstance(value, tuple):
            return value
        found = re.fullmatch(r"(\d{1,9})x(\d{1,9})", str(value))
        if found is None:
            self.fail(f"{value!r} is not a size such as 220x220", param, ctx)
        return int(found[1]), int(found[2])


class BleachingType(click.ParamType[int | str]):
    """``auto`` or a threshold of at least 1."""

    name = "auto|INT"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> int | str:
        """The threshold, or ``auto``."""
        if value == "auto":
            return "auto"
        if not str(value).isdecimal() or int(value) < 1:
            self.fail(f"{value!r} is neither 'auto' nor a whole number of at least 1", param, ctx)
        return int(value)


def spoken_command(leave_out: Container[str]) -> str:
    """The running command as the user gave it, for a shell in any folder: paths are absolute.

    Args:
        leave_out: names of parameters, such as those of the output.
    """
    context = click.get_current_context()
    words = ["wnn2hdl", str(context.info_name)]
    for parameter in context.command.params:
        name = str(parameter.name)
        said = context.get_parameter_source(name) is ParameterSource.COMMANDLINE
        if name in leave_out or not said:
            continue
        value = context.params[name]
        words.append(parameter.opts[0])
        if value is not True:
            spoken = getattr(parameter.type, "spoken", str)
            words.append(str(value.resolve()) if isinstance(value, Path) else spoken(value))
    return shlex.join(words)


def refuse(options: Iterable[str], fault: str) -> None:
    """Raise InputError, with this fault, if the user gave one of these options.

    Args:
        options: by their long names, as in ``--seed``.
        fault: why they cannot be used.
    """
    context = click.get_current_context()
    given = [
        name
        for parameter in context.command.params
        for name in set(parameter.opts) & set(options)
        if context.get_parameter_source(str(parameter.name)) is ParameterSource.COMMANDLINE
    ]
    if given:
        raise InputError(fault, value=" ".join(given), hint="leave these options out")


def labelled(
    images: Path | None,
    masks: Path | None,
    *,
    regions: Path | None = None,
    chips: Path | None = None,
    mask_format: MaskFormat | None = None,
    reading: Reading = Reading(),  # noqa: B008  # frozen
    seed: int,
) -> Dataset:
    """The labelled images that the options name; the embedded landscapes if they name none.

    Raises:
        InputError: half of a pair of options is given, or both pairs, or options that say how to read
            pictures or masks that are not given.
    """
    pairs = {"--images and --masks": (images, masks), "--regions and --chips": (regions, chips)}
    given = [name for name, pair in pairs.items() if any(pair)]
    for name in given:
        if not all(pairs[name]):
            raise InputError("these options go together", value=name, hint="give both")
    if len(given) == 2:
        raise InputError(
            "there are two sources of labelled pixels", value=" / ".join(given), hint="give one of them"
        )
    if images and masks:
        return from_masks(images, masks, mask_format or MaskFormat(), reading)
    if mask_format is not None:
        raise InputError("--palette and --ignore are for masks", hint="give --images and --masks too")
    if regions and chips:
        return from_regions(regions, chips, seed=seed, reading=reading)
    if reading != Reading():
        raise InputError(
            "--bands, --scale and --alpha are for pictures from files", hint="give --images and --masks too"
        )
    return from_samples(SAMPLE_IMAGES, SAMPLE_SIDE, seed=seed)
