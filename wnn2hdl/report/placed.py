"""What a report says of a build that was placed and routed: in Vivado, or on other FPGAs."""

from collections.abc import Mapping
from typing import Any

from wnn2hdl.markdown import MISSING

HARNESSES = {
    "registers": "a register at every port of the circuit",
    "shift registers": "too few pins: inputs are shifted in, answers out, to measure the circuit",
    "none": "the ports of the circuit are pins",
}
"""What stands between circuit and pins, in words."""

NOTE = (
    "These FPGAs are other architectures: their LUTs have four inputs, and no figure here compares with one "
    "of the xc7z020. LUTs, flip-flops and block RAMs are the circuit's alone, by Yosys; the clock is what "
    "nextpnr reports between registers after routing, those at the ports among them."
)

PLACED_HEADS = ("device", "LUT4", "flip-flops", "block RAMs", "clock", "from pins", "to pins", "proof")


def placed_rows(report: Mapping[str, Any]) -> list[tuple[str, ...]]:
    """A row of figures for each device, in the order of `PLACED_HEADS`."""
    return [
        (
            device,
            *(f"{figures['cells'][kind]:,}" for kind in ("luts", "ffs", "rams")),
            _form(figures["fmax_mhz"], ".1f", "MHz"),
            _form(figures["from_pins_ns"], ".2f", "ns"),
            _form(figures["to_pins_ns"], ".2f", "ns"),
            f"{figures['proof']}: {', '.join(figures['proved'])}",
        )
        for device, figures in report.get("placed", {}).items()
    ]


def placed_notes(report: Mapping[str, Any]) -> list[str]:
    """A line for each device: part, harness, pins, seed, use of the device, and tools."""
    return [
        f"{device} is {figures['part']}, {figures['circuit']} placed; {HARNESSES[figures['harness']]}; pins "
        f"{figures['pins']}; seed {figures['seed']}; in use "
        + ", ".join(
            f"{use['used']:,} of {use['available']:,} {kind}" for kind, use in figures["utilisation"].items()
        )
        + f"; {figures['logic']} after {figures['count']}, by "
        + ", ".join(f"{tool} {version}" for tool, version in figures["tools"].items())
        + "."
        for device, figures in report.get("placed", {}).items()
    ]


def vivado_rows(report: Mapping[str, Any]) -> list[tuple[str, str]]:
    """What Vivado found, by name; nothing if it was not run."""
    figures = report.get("vivado")
    if not figures:
        return []
    return [
        ("tool", f"Vivado {figures['version']}, for {figures['part']}"),
        ("LUTs, combined pairs counting one", f"{figures['luts']:,}"),
        ("flip-flops, with those at the ports of a circuit without streams", f"{figures['ffs']:,}"),
        ("block RAMs of 36 Kb", f"{figures['bram36']:g}"),
        ("DSP slices", f"{figures['dsp']:,}"),
        ("clock asked for", f"{1000 / figures['period_ns']:.1f} MHz"),
        ("worst slack", f"{figures['slack_ns']:.3f} ns"),
        ("fastest clock of this placement", f"{figures['fmax_mhz']:.1f} MHz"),
    ]


def _form(value: float | None, form: str, unit: str) -> str:
    return MISSING if value is None else f"{value:{form}} {unit}"
