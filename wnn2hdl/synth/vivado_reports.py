"""Reading Vivado's reports of utilisation and of timing (AMD UG906), of any version since 2014.

A table of utilisation got the column ``Prohibited`` in 2021; LUT counts that are estimates are marked with an
asterisk. Columns are therefore found by their heads, and rows by their names.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass

from wnn2hdl.errors import ToolError

_SITES = {
    "luts": ("Slice LUTs", "CLB LUTs"),
    "ffs": ("Slice Registers", "CLB Registers"),
    "bram36": ("Block RAM Tile",),
    "dsp": ("DSPs",),
}
_SLACK = re.compile(r"^\s*WNS\(ns\)[^\n]*\n[-\s]*\n\s*(\S+)", re.MULTILINE)
_CLOCK = re.compile(r"^\S+\s+\{[^}]*\}\s+([0-9.]+)\s+[0-9.]+\s*$", re.MULTILINE)
_TOOL = re.compile(r"^\|\s*Tool Version\s*:\s*Vivado v\.?\s*(\S+)", re.MULTILINE)
_DEVICE = re.compile(r"^\|\s*Device\s*:\s*(\S+)", re.MULTILINE)


@dataclass(frozen=True)
class VivadoFigures:
    """What Vivado found.

    Attributes:
        version: of Vivado, as ``2023.1``.
        device: as the report names it.
        luts: LUTs; pairs of small ones that Vivado combined count one.
        ffs: flip-flops and latches.
        bram36: block RAMs of 36 Kb; one of 18 Kb is half of one.
        dsp: DSP slices.
        period_ns: of the clock that was asked for.
        slack_ns: the worst slack of setup; negative where the clock is missed.
    """

    version: str
    device: str
    luts: int
    ffs: int
    bram36: float
    dsp: int
    period_ns: float
    slack_ns: float

    @property
    def fmax_mhz(self) -> float:
        """The fastest clock of this placement."""
        return 1000 / (self.period_ns - self.slack_ns)


def read_reports(utilisation: str, timing: str) -> VivadoFigures:
    """The figures of two reports of one design.

    Args:
        utilisation: text of `report_utilization`.
        timing: text of `report_timing_summary`.

    Raises:
        ToolError: a figure is not in its report, or no path was timed.
    """
    used = {name: _used(utilisation, sites) for name, sites in _SITES.items()}
    return VivadoFigures(
        version=_first(_TOOL, utilisation, "the version"),
        device=_first(_DEVICE, utilisation, "the device"),
        luts=int(used["luts"]),
        ffs=int(used["ffs"]),
        bram36=used["bram36"],
        dsp=int(used["dsp"]),
        period_ns=_number(_first(_CLOCK, timing, "a clock"), "the period"),
        slack_ns=_number(_first(_SLACK, timing, "the worst slack"), "the worst slack"),
    )


def _used(report: str, sites: tuple[str, ...]) -> float:
    """The figure under ``Used`` in the first row of one of these names."""
    for name, cells in _rows(report):
        if name in sites and "Used" in cells:
            return _number(cells["Used"], name)
    raise ToolError("Vivado's report of utilisation lacks a row", value=sites[0], output=report)


def _rows(report: str) -> Iterator[tuple[str, dict[str, str]]]:
    """The rows of all tables: the name, and the other cells by the heads of their columns."""
    heads: list[str] = []
    for line in report.splitlines():
        if not line.startswith("|"):
            heads = heads if line.startswith("+") else []
            continue
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if not heads:
            heads = cells
        elif len(cells) == len(heads):
            yield cells[0].rstrip("*").rstrip(), dict(zip(heads[1:], cells[1:], strict=True))


def _first(pattern: re.Pattern[str], report: str, what: str) -> str:
    found = pattern.search(report)
    if found is None:
        raise ToolError(f"Vivado's report does not have {what}", output=report)
    return found.group(1)


def _number(text: str, what: str) -> float:
    try:
        return float(text)
    except ValueError as error:
        raise ToolError(f"Vivado's report gives no number for {what}", value=text) from error
