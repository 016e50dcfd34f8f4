"""The `wnn2hdl` command: turns errors into one line and an exit status."""

import platform
import signal
import sys
from importlib.metadata import version

import click

import wnn2hdl
from wnn2hdl.errors import Wnn2hdlError

INTERRUPTED = 128 + signal.SIGINT

TOOLS = ("amaranth", "pyosys", "pyeda", "numpy")
"""Packages whose versions decide what is emitted and counted."""


def _versions() -> str:
    tools = ", ".join(f"{name} {version(name)}" for name in TOOLS)
    return f"{tools}, Python {platform.python_version()}"


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(wnn2hdl.__version__, message=f"wnn2hdl %(version)s\n{_versions()}")
def app() -> None:
    """Compile trained weightless neural networks to minimal, proved FPGA logic.

    \b
    Examples:
      wnn2hdl demo
      wnn2hdl train --images IMAGES --masks MASKS -o model.json
      wnn2hdl compile model.json -o build/mine

    `wnn2hdl doctor` tells which tools are here, `wnn2hdl COMMAND --help` what a command takes.

    \b
    For completion by the Tab key in bash (zsh and fish likewise), put into ~/.bashrc:
      eval "$(_WNN2HDL_COMPLETE=bash_source wnn2hdl)"
    """


def main() -> int:
    """Run the command line.

    Returns:
        0 done; 1 a check or gate failed; 2 bad usage, bad input or a missing tool; 130 interrupted.
    """
    try:
        status = app(standalone_mode=False)
    except Wnn2hdlError as error:
        return _complain(error.line(), error.exit_status)
    except click.ClickException as error:
        return _complain(error.format_message(), error.exit_code)
    except (KeyboardInterrupt, click.Abort):
        return _complain("interrupted; nothing half-written was left", INTERRUPTED)
    except BrokenPipeError:
        # The reader of our output went away, as `| head` does; closing stops Python's own complaint at exit.
        sys.stderr.close()
        return 0
    except OSError as error:
        place = "" if error.filename is None else f": {error.filename}"
        return _complain(f"the system refused: {error.strerror or error}{place}", 2)
    except UnicodeEncodeError as error:
        letter = ascii(error.object[error.start : error.end])
        return _complain(f"cannot print {letter} in {error.encoding}; set PYTHONIOENCODING=utf-8", 2)
    return status if isinstance(status, int) else 0


def _complain(line: str, status: int) -> int:
    click.echo(f"wnn2hdl: {' '.join(line.split())}", err=True)
    return status
