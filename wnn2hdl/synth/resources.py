"""The counting rule: cells of a mapped 7-series netlist to resources."""

from collections.abc import Mapping
from dataclasses import dataclass

from wnn2hdl.errors import CheckError

# What each cell is counted as, and how much of it. UG953 lists the cells of the family.
_COUNTED_AS: dict[str, tuple[str, float]] = {
    **{f"LUT{inputs}": ("luts", 1) for inputs in range(1, 7)},
    "LUT6_2": ("luts", 1),
    # Memories in LUTs take as many of them (UG474).
    "RAM32X1D": ("luts", 2),
    "RAM64X1D": ("luts", 2),
    "RAM128X1D": ("luts", 4),
    "RAM32M": ("luts", 4),
    "RAM64M": ("luts", 4),
    "INV": ("inv", 1),
    "MUXF7": ("muxf7", 1),
    "MUXF8": ("muxf8", 1),
    "CARRY4": ("carry4", 1),
    **dict.fromkeys(("SRL16", "SRL16E", "SRLC16", "SRLC16E", "SRLC32E"), ("srl", 1)),
    **{f"{cell}{edge}": ("ffs", 1) for cell in ("FDRE", "FDSE", "FDCE", "FDPE") for edge in ("", "_1")},
    **dict.fromkeys(("LDCE", "LDPE"), ("ffs", 1)),
    "RAMB36E1": ("bram36", 1),
    "RAMB18E1": ("bram36", 0.5),
    "DSP48E1": ("dsp", 1),
}

# $scopeinfo remembers the names of flattened modules; BUFG is a global clock buffer beside the fabric.
_FREE = frozenset({"$scopeinfo", "BUFG"})


@dataclass(frozen=True)
class Resources:
    """What a circuit costs on a 7-series device, without packing two small LUTs into one.

    Attributes:
        luts: LUT1 to LUT6 cells, LUT6_2 counting one, LUTs that serve as memories, and leftover INV cells,
            except for a baseline.
        inv: leftover inverters.
        muxf7: 2:1 multiplexers between two LUTs of a slice.
        muxf8: 2:1 multiplexers between two MUXF7.
        carry4: carry chains of four bits.
        srl: shift registers in LUTs; not among `luts`.
        ffs: flip-flops and latches.
        bram36: block RAMs of 36 Kb; one of 18 Kb is half of one.
        dsp: DSP48E1 slices.
        delay_ps: logic delay of the longest path in picoseconds, without routing; None when it is not known.
    """

    luts: int
    inv: int
    muxf7: int
    muxf8: int
    carry4: int
    srl: int
    ffs: int
    bram36: float
    dsp: int
    delay_ps: int | None


def count_cells(cells: Mapping[str, int], *, delay_ps: int | None, baseline: bool = False) -> Resources:
    """Count the cells of a mapped netlist.

    Args:
        cells: how many there are of each type.
        delay_ps: logic delay in picoseconds, passed on.
        baseline: leave the INV cells out of `luts`, in favour of what we compare ourselves with.

    Raises:
        CheckError: a cell has no place in the count, so the count would be too low.
    """
    sums: dict[str, float] = dict.fromkeys((kind for kind, _ in _COUNTED_AS.values()), 0.0)
    uncounted: dict[str, int] = {}
    for cell, number in cells.items():
        if cell in _COUNTED_AS:
            kind, weight = _COUNTED_AS[cell]
            sums[kind] += weight * number
        elif cell not in _FREE:
            uncounted[cell] = number
    if uncounted:
        raise CheckError(
            "the mapped netlist has cells that the count does not know",
            value=", ".join(f"{number} {cell}" for cell, number in sorted(uncounted.items())),
            hint="write the design without them",
        )
    whole = {kind: int(number) for kind, number in sums.items() if kind not in ("luts", "bram36")}
    luts = int(sums["luts"]) + (0 if baseline else whole["inv"])
    return Resources(luts=luts, bram36=sums["bram36"], delay_ps=delay_ps, **whole)
