"""The errors a user can cause: each names the fault, the value at fault and the hint, on one line."""

from collections.abc import Iterator
from contextlib import contextmanager

_LONGEST_VALUE = 1000
"""Characters of a value at fault that are shown."""


class Wnn2hdlError(Exception):
    """The root of every error this project raises on purpose.

    Attributes:
        exit_status: what the command line returns: 2 for bad usage, bad input or a missing tool, 1 for a
            check or gate that failed.
    """

    exit_status = 2

    def __init__(self, fault: str, *, value: object = None, hint: str = "") -> None:
        self.fault = fault
        self.value = value
        self.hint = hint
        super().__init__(self.line())

    def line(self) -> str:
        """The one line a user sees: ``fault: value; hint``.

        What comes from a file may be of any length, and hold what a terminal takes for a command.
        """
        text = self.fault if self.value is None else f"{self.fault}: {_shortened(str(self.value))}"
        text = f"{text}; {self.hint}" if self.hint else text
        return printable(_shortened(" ".join(text.split()), 2 * _LONGEST_VALUE))


def printable(text: str) -> str:
    """A text whose control characters, and marks that turn the direction of text, are escaped."""
    return "".join(sign if sign.isprintable() else ascii(sign)[1:-1] for sign in text)


def _shortened(text: str, longest: int = _LONGEST_VALUE) -> str:
    return text if len(text) <= longest else f"{text[: longest - 100]} … {text[-97:]}"


class InputError(Wnn2hdlError):
    """A file, folder or option given by the user cannot be used."""


class ModelFileError(InputError):
    """A model file, or another saved value, is damaged, truncated, too new or something else."""


class ExtraMissingError(Wnn2hdlError):
    """An optional package is needed; the hint names the extra to install."""


@contextmanager
def extra_needed(extra: str, need: str) -> Iterator[None]:
    """Around the imports of an optional extra's packages.

    Args:
        extra: the extra that brings them, as in ``pip install 'wnn2hdl[geo]'``.
        need: what needs which package, for the user: ``"polygons need shapely"``.

    Raises:
        ExtraMissingError: one of them cannot be imported.
    """
    try:
        yield
    except ImportError as error:
        raise ExtraMissingError(need, hint=f"install it with: pip install 'wnn2hdl[{extra}]'") from error


class ToolError(Wnn2hdlError):
    """An outside program cannot be found, failed, or ran out of time.

    Attributes:
        command: the command as it was started.
        output: what it printed, standard output and standard error together.
    """

    def __init__(
        self, fault: str, *, value: object = None, hint: str = "", command: str = "", output: str = ""
    ) -> None:
        super().__init__(fault, value=value, hint=hint)
        self.command = command
        self.output = output


class ToolStoppedError(ToolError):
    """An outside program ran out of time, or was killed from outside; its input may be right all the same."""


class CheckError(Wnn2hdlError):
    """A check or a gate failed: the circuit differs from the model, or costs more than allowed."""

    exit_status = 1
