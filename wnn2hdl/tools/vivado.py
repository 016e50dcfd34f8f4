"""Vivado, where it is on the PATH."""

import re
import shutil
from pathlib import Path

from wnn2hdl.errors import ToolError
from wnn2hdl.tools.runner import run

_ERROR = re.compile(r"ERROR: \[")
_TIMEOUT = 6 * 3600.0


def find_vivado() -> Path:
    """The program; raises ToolError if it is not on the PATH."""
    binary = shutil.which("vivado")
    if binary is None:
        raise ToolError(
            "vivado is not on the PATH", hint="source its settings64.sh, or write what it runs with --scripts"
        )
    return Path(binary)


def run_vivado(script: Path) -> str:
    """Run a Tcl script in batch mode, in its folder.

    Returns:
        What it printed.

    Raises:
        ToolError: Vivado is missing or failed; its first line with ``ERROR: [`` is the value.
    """
    options = ["-mode", "batch", "-nojournal", "-nolog", "-notrace", "-source", script.name]
    return run([find_vivado(), *options], cwd=script.parent, timeout=_TIMEOUT, error_line=_ERROR).output
