"""Truth-table lookup: as a sum of products, or as a network of LUTs."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from amaranth.hdl import Cat, Const, Instance, Module, Mux, Signal, Value
from numpy.typing import ArrayLike, NDArray

from hdl_templates.boolean import Term, any_of, equation, sum_of_products
from hdl_templates.hierarchy import Emission
from hdl_templates.ports import named

Style = Literal["equations", "cells"]
"""How a LUT network is written: as equations that a synthesiser may restructure, or as vendor cells it keeps.

Amaranth's simulator knows no vendor cells; there both are equations."""

STYLES: tuple[Style, ...] = ("equations", "cells")

KEEP = {"a_DONT_TOUCH": "yes"}
"""Attribute that keeps Vivado from merging or restructuring a cell (Xilinx UG901)."""

CONSTANTS = {"0": 0, "1": 1}


@dataclass(frozen=True)
class SumOfProducts:
    """Truth-table lookup as a sum of products; purely combinational, latency 0 cycles.

    Attributes:
        inputs: name of each input; input ``i`` is bit ``i`` of the code.
        outputs: name of each output.
        terms: for each output its product terms ``(mask, value)``; the output is 1 where one of them has
            ``code & mask == value``.
    """

    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    terms: tuple[tuple[Term, ...], ...]

    def __post_init__(self) -> None:
        _check_names((*self.inputs, *self.outputs))
        if len(self.terms) != len(self.outputs):
            raise ValueError(
                f"{len(self.outputs)} outputs need as many lists of terms, not {len(self.terms)}"
            )
        for mask, value in (term for terms in self.terms for term in terms):
            if value & ~mask or mask >> len(self.inputs):
                raise ValueError(f"term ({mask:#x}, {value:#x}) does not fit {len(self.inputs)} inputs")

    def compute(self, codes: ArrayLike) -> NDArray[np.bool_]:
        """Golden model: outputs for codes of shape ``S``, bool ``S + (len(outputs),)``."""
        flat = np.asarray(codes, dtype=np.int64)
        result = np.zeros((*flat.shape, len(self.outputs)), dtype=np.bool_)
        for position, terms in enumerate(self.terms):
            for mask, value in terms:
                result[..., position] |= (flat & mask) == value
        return result

    @property
    def used(self) -> int:
        """Mask of the inputs that are read."""
        mask = 0
        for literals, _ in (term for terms in self.terms for term in terms):
            mask |= literals
        return mask

    def draw(self, m: Module, bits: Sequence[Value], platform: object) -> list[Value]:
        """The outputs over ``bits``, one value of one bit for each input.

        In Amaranth's simulator, where comparing a code takes as long as reading one literal, a term is one
        comparison.
        """
        if not isinstance(platform, Emission):
            code = Signal(len(self.inputs))
            m.d.comb += code.eq(Cat(*bits))
            return [any_of([(code & mask) == value for mask, value in terms]) for terms in self.terms]
        values = [sum_of_products(terms, bits) for terms in self.terms]
        if len(values) == 1:
            return values
        return [named(m, name, value, platform) for name, value in zip(self.outputs, values, strict=True)]


@dataclass(frozen=True)
class LutCell:
    """A LUT of one to six inputs, the first being address bit 0; bit ``a`` of ``init`` is output there."""

    name: str
    inputs: tuple[str, ...]
    init: int

    @property
    def reads(self) -> tuple[str, ...]:
        """The signals the cell reads."""
        return self.inputs


@dataclass(frozen=True)
class MuxCell:
    """A dedicated multiplexer behind two LUTs (MUXF7) or two of its like (MUXF8)."""

    name: str
    low: str
    high: str
    select: str

    @property
    def reads(self) -> tuple[str, ...]:
        """The signals the cell reads."""
        return self.low, self.high, self.select


@dataclass(frozen=True)
class LutNetwork:
    """Truth-table lookup as a network of LUTs and multiplexers; purely combinational, latency 0 cycles.

    Attributes:
        inputs: name of each input; input ``i`` is bit ``i`` of the code.
        cells: in topological order; each drives the signal of its name.
        outputs: pairs (name, signal); the signal is an input, a cell, ``0`` or ``1``.
        style: see `Style`.
    """

    inputs: tuple[str, ...]
    cells: tuple[LutCell | MuxCell, ...]
    outputs: tuple[tuple[str, str], ...]
    style: Style = "equations"

    def __post_init__(self) -> None:
        _check_names((*self.inputs, *(cell.name for cell in self.cells), *(name for name, _ in self.outputs)))
        if self.style not in STYLES:
            raise ValueError(f"{self.style!r} is no style; use one of {', '.join(STYLES)}")
        known = {*self.inputs, *CONSTANTS}
        for cell in self.cells:
            if missing := set(cell.reads) - known:
                raise ValueError(f"{cell.name} reads {sorted(missing)} before it is driven")
            if isinstance(cell, LutCell) and not (
                1 <= len(cell.inputs) <= 6 and 0 <= cell.init < 1 << (1 << len(cell.inputs))
            ):
                raise ValueError(f"{cell.name} is no LUT: {len(cell.inputs)} inputs, contents {cell.init:#x}")
            known.add(cell.name)
        for name, signal in self.outputs:
            if signal not in known:
                raise ValueError(f"output {name} reads {signal}, which nothing drives")

    @property
    def luts(self) -> int:
        """How many LUTs the network has."""
        return sum(isinstance(cell, LutCell) for cell in self.cells)

    def compute(self, codes: ArrayLike) -> NDArray[np.bool_]:
        """Golden model: outputs for codes of shape ``S``, bool ``S + (len(outputs),)``."""
        values = np.asarray(codes, dtype=np.int64)
        shape = values.shape
        signals = {name: np.full(shape, value, dtype=np.bool_) for name, value in CONSTANTS.items()}
        for i, name in enumerate(self.inputs):
            signals[name] = (values >> i & 1).astype(np.bool_)
        for cell in self.cells:
            if isinstance(cell, LutCell):
                address = np.zeros(shape, dtype=np.int64)
                for i, name in enumerate(cell.inputs):
                    address |= signals[name].astype(np.int64) << i
                contents = [cell.init >> a & 1 for a in range(1 << len(cell.inputs))]
                signals[cell.name] = np.array(contents, dtype=np.bool_)[address]
            else:
                signals[cell.name] = np.where(signals[cell.select], signals[cell.high], signals[cell.low])
        columns = [signals[signal] for _, signal in self.outputs]
        return np.stack(columns, axis=-1) if columns else np.zeros((*shape, 0), dtype=np.bool_)

    @property
    def used(self) -> int:
        """Mask of the inputs that are read."""
        read = {name for cell in self.cells for name in cell.reads} | {signal for _, signal in self.outputs}
        return sum(1 << i for i, name in enumerate(self.inputs) if name in read)

    def draw(self, m: Module, bits: Sequence[Value], platform: object) -> list[Value]:
        """The outputs over ``bits``, one bit for each input; the cells become signals of ``m``.

        In Amaranth's simulator a LUT is one look-up in its contents, whatever the style.
        """
        signals: dict[str, Value] = dict(zip(self.inputs, bits, strict=True))
        for cell in self.cells:
            pins = [signals[name] for name in cell.reads]
            if not isinstance(platform, Emission):
                signals[cell.name] = self._simulated(m, cell, pins)
                continue
            output = Signal(name=cell.name)
            if self.style == "cells":
                m.submodules[f"{cell.name}_cell"] = self._instance(cell, pins, output)
            elif isinstance(cell, LutCell):
                m.d.comb += output.eq(equation(cell.init, len(pins)).expression(pins))
            else:
                low, high, select = pins
                m.d.comb += output.eq(Mux(select, high, low))
            signals[cell.name] = output
        constants: dict[str, Value] = {name: Value.cast(value) for name, value in CONSTANTS.items()}
        return [(constants | signals)[signal] for _, signal in self.outputs]

    def _simulated(self, m: Module, cell: LutCell | MuxCell, pins: Sequence[Value]) -> Value:
        """A cell for Amaranth's simulator, for which a signal costs more than a look-up."""
        if isinstance(cell, LutCell):
            value: Value = Const(cell.init, 1 << len(pins)).bit_select(Cat(*pins), 1)
        else:
            low, high, select = pins
            value = Mux(select, high, low)
        read = [name for other in self.cells for name in other.reads] + [name for _, name in self.outputs]
        if read.count(cell.name) == 1:
            return value
        shared = Signal(name=cell.name)
        m.d.comb += shared.eq(value)
        return shared

    def _instance(self, cell: LutCell | MuxCell, pins: Sequence[Value], output: Signal) -> Instance:
        if isinstance(cell, LutCell):
            width = len(pins)
            inputs = {f"i_I{i}": pin for i, pin in enumerate(pins)}
            contents = Const(cell.init, 1 << width)
            return Instance(f"LUT{width}", p_INIT=contents, **inputs, o_O=output, **KEEP)
        muxes = {x.name for x in self.cells if isinstance(x, MuxCell)}
        low, high, select = pins
        kind = "MUXF8" if cell.low in muxes else "MUXF7"
        return Instance(kind, i_I0=low, i_I1=high, i_S=select, o_O=output, **KEEP)


Lookup = SumOfProducts | LutNetwork
"""What a component can draw its logic from; both have `compute`, `draw`, `inputs`, `outputs` and `used`."""


def _check_names(names: Sequence[str]) -> None:
    for name in names:
        if not re.fullmatch(r"[A-Za-z]\w*", name, re.ASCII):
            raise ValueError(f"{name!r} cannot name a signal; use letters, digits and _")
