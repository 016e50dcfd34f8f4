"""What is installed here of all that wnn2hdl can use, and how to get the rest."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, metadata, requires, version
from shutil import which

from packaging.requirements import Requirement

from wnn2hdl.errors import ToolError, Wnn2hdlError
from wnn2hdl.tools.abc import find_abc
from wnn2hdl.tools.simulators import find_icarus, find_verilator
from wnn2hdl.tools.yosys import find_yosys

PACKAGE = "wnn2hdl"

PURPOSES = {
    "cluster": "sweeps and scans on a Dask cluster",
    "geo": "scan and locate: GeoTIFFs, polygons, areas, the track filter",
    "place": "place and route, bitstreams for ECP5, iCE40 and Gowin",
    "search": "sweeps beyond the grid",
    "sim": "simulation in Verilator, the cocotb benches",
}
"""What each extra of the package is for."""


@dataclass(frozen=True)
class Part:
    """A program or an extra.

    Attributes:
        name: ``Yosys``, or ``extra geo``.
        purpose: what wnn2hdl does with it.
        found: its name and version, or those of its packages; None where it is missing or does not work.
        fault: why not; None where it was found.
        hint: how to install it; None where it was found.
        needed: whether `compile` and `verify` cannot do without.
    """

    name: str
    purpose: str
    found: str | None
    fault: str | None
    hint: str | None
    needed: bool


def inventory() -> Iterator[Part]:
    """Look for each part in turn; each program is started once."""
    for name, purpose, find, needed in _PROGRAMS:
        try:
            yield Part(name, purpose, find(), None, None, needed)
        except Wnn2hdlError as error:
            yield Part(name, purpose, None, error.fault, error.hint, needed)
    yield from map(_extra, sorted(metadata(PACKAGE).get_all("Provides-Extra") or ()))


def _yosys() -> str:
    yosys = find_yosys()
    return f"{yosys.name} {yosys.version.partition(' ')[0]}"


def _abc() -> str:
    return str(find_abc())


def _icarus() -> str:
    return f"Icarus Verilog {find_icarus().version}"


def _verilator() -> str:
    found = find_verilator()
    # The package's own program sets up what its Verilator needs.
    command = "verilator" if which("verilator") else "verilator-cli"
    return f"Verilator {found.version}, as {command}"


def _compiler() -> str:
    for name in ("g++", "clang++"):
        found = which(name)
        if found:
            return found
    raise ToolError("no C++ compiler on the PATH", hint="apt-get install g++ make")


_PROGRAMS: tuple[tuple[str, str, Callable[[], str], bool], ...] = (
    ("Yosys", "proof and LUT counts", _yosys, True),
    ("ABC", "LUT mapping", _abc, True),
    ("Icarus", "simulation of emitted Verilog", _icarus, False),
    ("Verilator", "fast simulation and lint of emitted Verilog", _verilator, False),
    ("C++ compiler", "what Verilator's simulations are built with", _compiler, False),
)


def _extra(extra: str) -> Part:
    """Whether every package of an extra is here in a version that suffices."""
    found, faults = [], []
    for requirement in map(Requirement, requires(PACKAGE) or ()):
        if requirement.marker is None or not requirement.marker.evaluate({"extra": extra}):
            continue
        try:
            installed = version(requirement.name)
        except PackageNotFoundError:
            faults.append(f"{requirement.name} is missing")
            continue
        found.append(f"{requirement.name} {installed}")
        if not requirement.specifier.contains(installed, prereleases=True):
            faults.append(f"{requirement.name} {installed} is not {requirement.specifier}")
    return Part(
        name=f"extra {extra}",
        purpose=PURPOSES[extra],
        found=None if faults else ", ".join(found),
        fault=", ".join(faults) or None,
        hint=f"pip install '{PACKAGE}[{extra}]'" if faults else None,
        needed=False,
    )
