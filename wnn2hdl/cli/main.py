"""The `wnn2hdl` command: turns errors into one line and an exit status."""

import os
import platform
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress

import click

import wnn2hdl
from wnn2hdl.cli.commands import LazyGroup
from wnn2hdl.cli.terminal import accept_any_text, say
from wnn2hdl.errors import Wnn2hdlError, printable

INTERRUPTED = 128 + signal.SIGINT

TOOLS = ("amaranth", "pyosys", "pyeda", "numpy")
"""Packages whose versions decide what is emitted and counted."""


def _print_version(context: click.Context, _: click.Parameter, asked: bool) -> None:
    if not asked or context.resilient_parsing:
        return
    from importlib.metadata import version  # takes as long as all the rest of this module

    tools = ", ".join(f"{name} {version(name)}" for name in TOOLS)
    say(f"wnn2hdl {wnn2hdl.__version__}\n{tools}, Python {platform.python_version()}")
    context.exit()


@click.group(
    cls=LazyGroup, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100}
)
@click.option(
    "--version",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_print_version,
    help="Show the version and exit.",
)
def app() -> None:
    """Compile trained weightless neural networks to minimal, proved FPGA logic.

    \b
    Examples:
      wnn2hdl demo
      wnn2hdl train --images IMAGES --masks MASKS -o model.json
      wnn2hdl compile model.json -o build/mine

    `wnn2hdl doctor` shows which tools are installed, `wnn2hdl COMMAND --help` what a command takes.

    \b
    To complete commands with the Tab key in bash (or zsh, or fish), add this line to ~/.bashrc:
      eval "$(_WNN2HDL_COMPLETE=bash_source wnn2hdl)"
    """


def main() -> int:
    """Run the command line.

    Returns:
        0 done; 1 a check or gate failed; 2 bad usage, bad input or a missing tool; 130 interrupted, 143
        terminated.
    """
    accept_any_text()
    if platform.system() == "Windows":
        return _complain("Windows is not supported; run wnn2hdl on Linux or macOS, or in WSL", 2)
    try:
        with _stopped_by(signal.SIGTERM, signal.SIGHUP):
            status = app(standalone_mode=False)
    except Wnn2hdlError as error:
        return _complain(error.line(), error.exit_status)
    except click.ClickException as error:
        return _complain(error.format_message(), error.exit_code)
    except (KeyboardInterrupt, click.Abort):
        return _complain("interrupted; no half-written file is left", INTERRUPTED)
    except _Stopped as stopped:
        return _complain(f"stopped by {stopped.signal.name}; no half-written file is left", stopped.status)
    except BrokenPipeError:
        # The reader of our output went away, as `| head` does; closing stops Python's own complaint at exit.
        sys.stderr.close()
        return 0
    except OSError as error:
        place = "" if error.filename is None else f": {error.filename}"
        return _complain(f"the system refused: {error.strerror or error}{place}", 2)
    return status if isinstance(status, int) else 0


class _Stopped(BaseException):
    """Someone asked the process to end."""

    def __init__(self, number: int) -> None:
        super().__init__()
        self.signal = signal.Signals(number)
        self.status = 128 + number


@contextmanager
def _stopped_by(*signals: signal.Signals) -> Iterator[None]:
    """Let the first of these signals end the block by an exception, so that it clears up."""

    def stop(number: int, _: object) -> None:
        for each in signals:
            signal.signal(each, signal.SIG_IGN)
        raise _Stopped(number)

    before = {each: signal.signal(each, stop) for each in signals}
    try:
        yield
    finally:
        for each, handler in before.items():
            signal.signal(each, handler)


def _complain(line: str, status: int) -> int:
    # A full disk may be why there is something to complain of, and hold what was printed so far.
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except OSError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
    with suppress(OSError):
        say(f"wnn2hdl: {printable(' '.join(line.split()))}", error=True)
    return status
