"""Placing and routing a mapped design with nextpnr: how fast it is, what it takes, and a bitstream."""

import json
import re
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from wnn2hdl.errors import InputError, ToolError
from wnn2hdl.synth.fabrics import Fabric
from wnn2hdl.synth.harness import Harnessed
from wnn2hdl.synth.mapping import Mapped
from wnn2hdl.tools import find_yosys

SEED = 1
"""What nextpnr's random numbers begin with: the same design is placed the same way again."""

_TIMEOUT = 1800.0

# The harness is synthesised around an empty place for the circuit, whose netlist comes in as it was proved.
_SCRIPT = """\
read_verilog harness.v
read_verilog -lib netlist.v
{synthesis} -top {top}
read_verilog -overwrite netlist.v
hierarchy -top {top}
flatten -noscopeinfo
opt_clean -purge
write_json design.json
"""

# What nextpnr says of a design that is too large; each of its architectures has words of its own.
_TOO_LARGE = re.compile(
    r"no (more )?bels remaining|unable to find (a )?(legal )?placement|utili[sz]ation limit|"
    r"unable to place cell|failed to (find|place)",
    re.IGNORECASE,
)


@dataclass(frozen=True)
class Placed:
    """A placed and routed design.

    Attributes:
        fmax_mhz: the fastest clock between its registers, in MHz; None where no path joins two.
        from_pins_ns: the longest path from a pin to a register, in ns; None where there is none.
        to_pins_ns: the longest path from a register to a pin, in ns.
        utilisation: for each kind of place on the FPGA how many are used and available; those in use alone.
        constraints: text of the constraints that were written for it; None where nextpnr assigned the pins.
        bitstream: what configures the FPGA.
        timing: nextpnr's report, as JSON text.
        log: what nextpnr printed.
        tools: versions by name.
    """

    fmax_mhz: float | None
    from_pins_ns: float | None
    to_pins_ns: float | None
    utilisation: Mapping[str, tuple[int, int]]
    constraints: str | None
    bitstream: bytes
    timing: str
    log: str
    tools: Mapping[str, str]


def require_place(fabric: Fabric, mapped: Mapped) -> None:
    """Raise InputError if a mapped design needs more than the FPGA has."""
    cells = mapped.cells
    for what, used, available in (
        ("LUTs", cells.luts, fabric.luts),
        ("flip-flops", cells.ffs, fabric.ffs),
        ("block RAMs", cells.rams, fabric.rams),
    ):
        if used > available:
            raise InputError(
                f"the design is too large for {fabric.name}",
                value=f"{used:,} {what} of {available:,}",
                hint="choose a larger --device or compile a smaller model",
            )


def place_and_route(
    fabric: Fabric, mapped: Mapped, harnessed: Harnessed, name: str, pins: str | None
) -> Placed:
    """Place and route a circuit in its harness.

    Args:
        fabric: the FPGA.
        mapped: the circuit in its cells.
        harnessed: the harness.
        name: of the harness's module.
        pins: text of a file of constraints; None leaves the pins to nextpnr, or takes those of the fabric.

    Raises:
        InputError: the design does not fit, or nextpnr does not take the constraints.
        ToolError: a program is missing or failed.
    """
    require_place(fabric, mapped)
    family, placer = fabric.family, fabric.family.placer
    tools = {program.name: program.version() for program in (placer.nextpnr, placer.packer)}
    constraints = None
    if pins is None and fabric.plain_pins:
        constraints = "".join(
            f'IO_LOC "{bit}" {pin};\n' for bit, pin in zip(harnessed.pins, fabric.plain_pins, strict=False)
        )
    with tempfile.TemporaryDirectory(prefix="wnn2hdl-place-") as place:
        folder = Path(place)
        (folder / "harness.v").write_text(harnessed.verilog, encoding="utf-8")
        (folder / "netlist.v").write_text(mapped.netlist, encoding="utf-8")
        script = _SCRIPT.format(synthesis=family.with_pads, top=name)
        find_yosys().run(script, cwd=folder, timeout=_TIMEOUT)
        text = pins if pins is not None else constraints
        if text is not None:
            (folder / "pins").write_text(text, encoding="utf-8")
        chosen = family.unconstrained if text is None else family.constrained
        arguments = [*fabric.options, "--json", "design.json", "--report", "timing.json"]
        arguments += [word.format("pins") for word in chosen]
        arguments += ["--seed", str(SEED), "--timing-allow-fail", family.routed, "routed"]
        try:
            log = placer.nextpnr.run(arguments, cwd=folder)
        except ToolError as error:
            raise _explained(error, fabric, constrained=pins is not None) from error
        packed = [word.format(routed="routed", bitstream="bitstream") for word in family.packed]
        placer.packer.run(packed, cwd=folder)
        timing = (folder / "timing.json").read_text(encoding="utf-8")
        bitstream = (folder / "bitstream").read_bytes()
    fmax, paths, utilisation = _figures(timing, log)
    return Placed(
        fmax, paths.get("in"), paths.get("out"), utilisation, constraints, bitstream, timing, log, tools
    )


def _explained(error: ToolError, fabric: Fabric, *, constrained: bool) -> Exception:
    """A failure of nextpnr as the user's, if it is."""
    if not str(error.value).startswith("ERROR: "):
        return error
    said = str(error.value).removeprefix("ERROR: ")
    if _TOO_LARGE.search(said):
        return InputError(
            f"the design is too large for {fabric.name}", value=said, hint="choose a larger --device"
        )
    if constrained:
        return InputError("nextpnr does not take the pins", value=said, hint="correct the file of --pins")
    return error


def _figures(timing: str, log: str) -> tuple[float | None, dict[str, float], dict[str, tuple[int, int]]]:
    """The fastest clock in MHz, the longest paths from and to pins in ns, and the utilisation."""
    try:
        report: dict[str, Any] = json.loads(timing)
        clocks = [float(clock["achieved"]) for clock in report["fmax"].values()]
        paths: dict[str, float] = {}
        for path in report["critical_paths"]:
            ends = [end == "<async>" for end in (path["from"], path["to"])]
            if ends[0] != ends[1]:
                way = "in" if ends[0] else "out"
                length = sum(float(step["delay"]) for step in path["path"])
                paths[way] = max(paths.get(way, 0.0), length)
        used = {
            kind: (int(count["used"]), int(count["available"]))
            for kind, count in report["utilization"].items()
            if count["used"]
        }
    except (ValueError, LookupError, TypeError, AttributeError) as error:
        raise ToolError("nextpnr wrote no report that can be read", value=error, output=log) from error
    return min(clocks, default=None), paths, used
