"""ABC, the logic optimiser that comes with Yosys."""

import functools
import re
import shlex
import shutil
from pathlib import Path

from wnn2hdl.errors import ToolError
from wnn2hdl.tools.runner import run
from wnn2hdl.tools.yosys import find_yosys

# ABC ends with status 0 after nearly every error (measured, yosys-abc of pyosys 0.70): an unknown command, a
# file it cannot open and a network that is empty are reported by these lines only.
_ERROR = re.compile(r"\*\* cmd error|Error\b|Cannot |.*\bfailed\b|Empty network|There is no current network")

# `print_stats` prints its colours into files too.
_COLOUR = re.compile(r"\x1b\[[0-9;]*m")


@functools.cache
def find_abc() -> Path:
    """The `yosys-abc` of the Yosys in use, else the one on the PATH.

    Raises:
        ToolError: there is none.
    """
    own = find_yosys().abc_path
    if own is not None:
        return own
    binary = shutil.which("yosys-abc")
    if binary is None:
        raise ToolError("no yosys-abc found", hint="pip install pyosys, or put yosys-abc on the PATH")
    return Path(binary)


@functools.cache
def abc_version() -> str:
    """What identifies this ABC: the Yosys that it came with, ``pyosys 0.70``, or when it was compiled.

    Every ABC of the last ten years calls itself 1.01.

    Raises:
        ToolError: there is no ABC.
    """
    yosys = find_yosys()
    if yosys.abc_path is not None:
        return f"{yosys.name} {yosys.version.partition(' ')[0]}"
    compiled = re.search(r"compiled [^)]+", run_abc("version", timeout=30))
    return compiled.group() if compiled else "unknown"


def run_abc(script: str, *, timeout: float, cwd: Path | None = None) -> str:
    """Run a script of ABC commands, one per line or separated by semicolons, in a new process.

    Args:
        script: the commands.
        timeout: seconds.
        cwd: the folder in which relative names in the script are looked up.

    Returns:
        What ABC printed, without colours.

    Raises:
        ToolError: there is no ABC, it crashed (it does on malformed truth tables), it printed an error, or it
            ran out of time.
    """
    # On standard input ABC behaves as in a terminal and continues after an error; a sourced file stops at it.
    command = [str(find_abc()), "-q", "source -s /dev/stdin"]
    output = _COLOUR.sub("", run(command, stdin=script, cwd=cwd, timeout=timeout).output)
    errors = [line for line in output.splitlines() if _ERROR.match(line)]
    if errors:
        # "aborting" only repeats that another line reports an error.
        raise ToolError(
            "yosys-abc failed",
            value=next((line for line in errors if "aborting" not in line), errors[0]),
            command=shlex.join(command),
            output=output,
        )
    return output
