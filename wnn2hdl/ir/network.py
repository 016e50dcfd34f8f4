"""Networks of look-up tables and dedicated multiplexers: what a table becomes once it is mapped to cells."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.errors import ModelFileError
from wnn2hdl.ir.tables import unpack_contents
from wnn2hdl.ir.verilog_text import check_identifier

LUT_INPUTS = 6
"""Inputs of the 7-series LUT (Xilinx UG474)."""

Style = Literal["cells", "equations"]
"""How a LUT network is written: as vendor cells, which a synthesiser keeps, or as equations, which it may
restructure. Amaranth's simulator has no vendor cells; there a LUT is one look-up, whatever the style."""

CONSTANTS = ("0", "1")
"""Signal names that stand for constants; an output may be tied to one."""

Column = NDArray[np.uint8]
"""The values 0 and 1 of one signal, one for each sample; or the contents of a LUT."""

MUX_CONTENTS: Column = np.array([0, 1, 0, 1, 0, 0, 1, 1], dtype=np.uint8)
"""A two-to-one multiplexer as a LUT that reads (low, high, select)."""


@dataclass(frozen=True)
class Lut:
    """One look-up table.

    Attributes:
        name: the signal it drives, unique in its network.
        inputs: names of one to six signals; the first is the least significant address bit (I0).
        init: contents; bit ``a`` is the output at address ``a``. Below ``2**(2**len(inputs))``.
    """

    name: str
    inputs: tuple[str, ...]
    init: int

    @property
    def reads(self) -> tuple[str, ...]:
        """The signals on its pins, the least significant address bit first."""
        return self.inputs


@dataclass(frozen=True)
class Mux:
    """One dedicated multiplexer behind the LUTs: a MUXF7 joins two LUTs, a MUXF8 two MUXF7 (Xilinx UG474).

    It costs no LUT, but its data pins are wired to fixed neighbours inside the slice: the data are therefore
    two different cells of the level below, and each of them is the datum of this multiplexer only.

    Attributes:
        name: the signal it drives, unique in its network.
        low: the cell that drives the output while `select` is 0 (pin I0).
        high: the cell that drives the output while `select` is 1 (pin I1).
        select: any signal of the network (pin S).
    """

    name: str
    low: str
    high: str
    select: str

    @property
    def reads(self) -> tuple[str, ...]:
        """The signals on its pins: low, high, select, as `MUX_CONTENTS` is addressed."""
        return self.low, self.high, self.select


@dataclass(frozen=True)
class LutNetwork:
    """A combinational network of LUTs and dedicated multiplexers, in topological order.

    Attributes:
        inputs: names of the network's inputs; input ``i`` is bit ``i`` of the code.
        cells: each reads inputs of the network and cells before it.
        outputs: pairs (output name, signal); the signal is an input, a cell or one of `CONSTANTS`.
    """

    inputs: tuple[str, ...]
    cells: tuple[Lut | Mux, ...]
    outputs: tuple[tuple[str, str], ...]

    def __post_init__(self) -> None:
        known = set(self.inputs)
        for cell in self.cells:
            if isinstance(cell, Lut):
                _check_contents(cell)
            if cell.name in known or cell.name in CONSTANTS:
                raise ValueError(f"{cell.name} is driven twice")
            if missing := set(cell.reads) - known:
                raise ValueError(f"{cell.name} reads {sorted(missing)} before it is driven")
            known.add(cell.name)
        self._check_muxes()
        for name, signal in self.outputs:
            if signal not in known and signal not in CONSTANTS:
                raise ValueError(f"output {name} reads {signal}, which nothing drives")
        for name in (*self.inputs, *(cell.name for cell in self.cells), *(name for name, _ in self.outputs)):
            check_identifier(name)

    def _check_muxes(self) -> None:
        height = {lut.name: 0 for lut in self.luts}
        joined: set[str] = set()
        for mux in self.muxes:
            below = height.get(mux.low)
            if mux.low == mux.high or below is None or below != height.get(mux.high) or below > 1:
                raise ValueError(f"{mux.name} must join two LUTs, or two MUXF7, not {mux.low} and {mux.high}")
            if shared := joined & {mux.low, mux.high}:
                raise ValueError(f"{mux.name} joins {sorted(shared)}, as another multiplexer does")
            joined |= {mux.low, mux.high}
            height[mux.name] = below + 1

    @property
    def luts(self) -> tuple[Lut, ...]:
        """The LUTs alone."""
        return tuple(cell for cell in self.cells if isinstance(cell, Lut))

    @property
    def muxes(self) -> tuple[Mux, ...]:
        """The dedicated multiplexers alone; one whose data are LUTs is a MUXF7, the others are MUXF8."""
        return tuple(cell for cell in self.cells if isinstance(cell, Mux))

    @property
    def depth(self) -> int:
        """LUTs on the longest path from an input to an output; a multiplexer adds none."""
        level = dict.fromkeys((*self.inputs, *CONSTANTS), 0)
        for cell in self.cells:
            level[cell.name] = isinstance(cell, Lut) + max(level[name] for name in cell.reads)
        return max((level[signal] for _, signal in self.outputs), default=0)

    def evaluate(self, codes: ArrayLike) -> NDArray[np.bool_]:
        """Outputs for codes of shape ``S``: bool ``S + (len(outputs),)``; for at most 63 inputs."""
        values = np.asarray(codes, dtype=np.int64)
        columns = [(values.reshape(-1) >> i & 1).astype(np.uint8) for i in range(len(self.inputs))]
        return self._outputs(columns, values.size).reshape((*values.shape, len(self.outputs)))

    def evaluate_bits(self, bits: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Outputs for any number of inputs.

        Args:
            bits: bool ``[samples, len(inputs)]``, input ``i`` in column ``i``.

        Returns:
            bool ``[samples, len(outputs)]``.
        """
        columns = np.ascontiguousarray(bits.T).view(np.uint8)
        return self._outputs(list(columns), len(bits))

    def _outputs(self, columns: Sequence[Column], samples: int) -> NDArray[np.bool_]:
        signals = dict(zip(self.inputs, columns, strict=True))
        signals |= {name: np.full(samples, value, dtype=np.uint8) for value, name in enumerate(CONSTANTS)}
        for cell in self.cells:
            if isinstance(cell, Lut):
                contents = unpack_contents(cell.init, len(cell.inputs)).view(np.uint8)
            else:
                contents = MUX_CONTENTS
            signals[cell.name] = look_up(contents, [signals[name] for name in cell.reads])
        result = np.empty((samples, len(self.outputs)), dtype=np.bool_)
        for position, (_, signal) in enumerate(self.outputs):
            result[:, position] = signals[signal]
        return result

    def to_json(self) -> dict[str, Any]:
        """A JSON object; LUT contents are hexadecimal."""
        return {
            "inputs": list(self.inputs),
            "cells": [_cell_to_json(cell) for cell in self.cells],
            "outputs": [list(pair) for pair in self.outputs],
        }

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Self:
        """The inverse of `to_json`; raises `ModelFileError` on anything else."""
        try:
            cells = tuple(_cell_from_json(x) for x in data["cells"])
            outputs = tuple((name, signal) for name, signal in data["outputs"])
            return cls(tuple(data["inputs"]), cells, outputs)
        except (KeyError, TypeError, ValueError) as error:
            raise ModelFileError("not a LUT network", value=error, hint="compile the model again") from error


def look_up(contents: Column, pins: Sequence[Column]) -> Column:
    """What a LUT answers.

    Args:
        contents: uint8 ``[2**len(pins)]`` of 0 and 1.
        pins: one to eight columns of 0 and 1, uint8 ``[samples]``; the first is the least significant address
            bit.

    Returns:
        uint8 ``[samples]``.
    """
    address = pins[-1].copy()
    for pin in pins[-2::-1]:
        address <<= 1
        address |= pin
    return contents[address]


def _check_contents(lut: Lut) -> None:
    if not 1 <= len(lut.inputs) <= LUT_INPUTS:
        raise ValueError(f"{lut.name} has {len(lut.inputs)} inputs; a LUT has 1 to {LUT_INPUTS}")
    if not 0 <= lut.init < 1 << (1 << len(lut.inputs)):
        raise ValueError(f"{lut.name} has contents {lut.init:#x}, too wide for its inputs")


def _cell_to_json(cell: Lut | Mux) -> dict[str, Any]:
    if isinstance(cell, Lut):
        return {"name": cell.name, "inputs": list(cell.inputs), "init": f"{cell.init:x}"}
    return {"name": cell.name, "low": cell.low, "high": cell.high, "select": cell.select}


def _cell_from_json(data: dict[str, Any]) -> Lut | Mux:
    if "select" in data:
        return Mux(data["name"], data["low"], data["high"], data["select"])
    return Lut(data["name"], tuple(data["inputs"]), int(data["init"], 16))
