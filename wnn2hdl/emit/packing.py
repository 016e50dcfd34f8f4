"""Two look-up tables in one cell: pairs that read few signals become one LUT6_2."""

from dataclasses import replace

from wnn2hdl.emit.netlist import FLIP_FLOP, MEMORY_READ, Cell, Module
from wnn2hdl.ir.packing import SHARED_INPUTS, Gate, pairs

_LUTS = {f"LUT{inputs}": inputs for inputs in range(1, 7)}
_MUXES = ("MUXF7", "MUXF8")


def packed(module: Module) -> Module:
    """The module with pairs of LUT cells in LUT6_2 cells; see `wnn2hdl.ir.packing.pairs`.

    A LUT in front of a MUXF7 stays alone: the multiplexer is wired to its output O6.
    """
    joined = {
        bit
        for cell in module.cells
        if cell.kind in _MUXES
        for pin in ("I0", "I1")
        for bit in cell.inputs[pin]
    }
    gates = []
    for cell in module.cells:
        drives = tuple(bit for bits in cell.outputs.values() for bit in bits)
        reads = frozenset(bit for bits in cell.inputs.values() for bit in bits if isinstance(bit, int))
        is_register = cell.kind in (FLIP_FLOP, MEMORY_READ)
        is_lut = cell.kind in _LUTS and joined.isdisjoint(drives)
        gates.append(Gate(frozenset() if is_register else reads, () if is_register else drives, is_lut))
    first = dict(pairs(gates))
    second = set(first.values())
    cells = [
        _joined(cell, module.cells[first[position]]) if position in first else cell
        for position, cell in enumerate(module.cells)
        if position not in second
    ]
    return replace(module, cells=tuple(cells))


def _joined(one: Cell, other: Cell) -> Cell:
    """One cell with ``one`` on O6 and ``other`` on O5."""
    pins = list(
        dict.fromkeys(
            bits for cell in (one, other) for bits in cell.inputs.values() if bits[0] not in ("0", "1")
        )
    )
    upper, lower = (_contents(cell, pins) for cell in (one, other))
    size = 1 << SHARED_INPUTS
    inputs = {f"I{i}": pins[i] if i < len(pins) else ("0",) for i in range(SHARED_INPUTS)}
    # With I5 at 1, O6 is the upper half of the contents and O5 the lower one (UG953).
    return Cell(
        f"{one.name}_pair",
        "LUT6_2",
        {"INIT": f"{upper << size | lower:0{2 * size}b}"},
        one.attributes,
        {**inputs, f"I{SHARED_INPUTS}": ("1",)},
        {"O5": other.outputs["O"], "O6": one.outputs["O"]},
    )


def _contents(cell: Cell, pins: list[tuple[int | str, ...]]) -> int:
    """The contents of a cell as a table of five inputs that are connected to ``pins``."""
    init = cell.number("INIT")
    places = [
        (i, pins.index(bits) if bits in pins else None, bits[0])
        for i, bits in enumerate(cell.inputs[f"I{i}"] for i in range(_LUTS[cell.kind]))
    ]
    result = 0
    for address in range(1 << SHARED_INPUTS):
        own = sum(
            (int(constant) if place is None else address >> place & 1) << i for i, place, constant in places
        )
        result |= (init >> own & 1) << address
    return result
