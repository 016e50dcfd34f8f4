"""The working form of a LUT network while it is searched: cells by number, changed in place.

Signals ``0 .. width-1`` are the inputs, `ZERO` and `ONE` the constants, larger numbers are cells. A
multiplexer is an ordinary three-input cell here; `Draft.network` turns those that fit behind two LUTs into
MUXF7 and MUXF8.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import (
    CONSTANTS,
    LUT_INPUTS,
    MUX_CONTENTS,
    Column,
    Lut,
    LutNetwork,
    Mux,
    look_up,
    pack_contents,
)

ZERO = -2
ONE = -1

Bits = NDArray[np.uint8]
"""Columns of several signals, uint8 ``[signals, samples]``."""


@dataclass(frozen=True)
class Cell:
    """A LUT: the signals it reads, least significant first, and its contents, uint8 ``[2**len(fanins)]``."""

    fanins: tuple[int, ...]
    contents: Column


@dataclass
class Draft:
    """A network of LUTs of at most ``lut_inputs`` inputs over ``width`` inputs; ``outputs`` are signals."""

    width: int
    cells: dict[int, Cell] = field(default_factory=dict)
    outputs: list[int] = field(default_factory=list)
    lut_inputs: int = LUT_INPUTS

    def __post_init__(self) -> None:
        self._next = 1 + max(self.cells, default=self.width - 1)

    def copy(self) -> "Draft":
        """An independent copy; cells are immutable and shared."""
        return replace(self, cells=dict(self.cells), outputs=list(self.outputs))

    def adopt(self, other: "Draft") -> None:
        """Take over the cells of a copy that has grown; the outputs stay."""
        self.cells = dict(other.cells)
        self._next = other._next

    def add(self, fanins: tuple[int, ...], contents: Column) -> int:
        """A new cell's signal, or an older signal that is equal by construction."""
        cell = simplified(Cell(fanins, contents))
        if not cell.fanins:
            return ONE if cell.contents[0] else ZERO
        if len(cell.fanins) == 1 and cell.contents[1]:
            return cell.fanins[0]
        name, self._next = self._next, self._next + 1
        self.cells[name] = cell
        return name

    def add_mux(self, low: int, high: int, select: int) -> int:
        """The signal ``high if select else low``."""
        return self.add((low, high, select), MUX_CONTENTS)

    def order(self) -> list[int]:
        """The cells that the outputs need, each after those it reads."""
        done: set[int] = set()
        order: list[int] = []
        stack = list(reversed(self.outputs))
        while stack:
            signal = stack.pop()
            if signal in done or signal not in self.cells:
                continue
            missing = [x for x in self.cells[signal].fanins if x in self.cells and x not in done]
            if missing:
                stack.append(signal)
                stack.extend(missing)
            else:
                done.add(signal)
                order.append(signal)
        return order

    def readers(self) -> dict[int, list[int]]:
        """For each signal that is read, the cells that read it."""
        result: dict[int, list[int]] = {}
        for name, cell in self.cells.items():
            for signal in cell.fanins:
                result.setdefault(signal, []).append(name)
        return result

    def evaluate(self, bits: Bits) -> dict[int, Column]:
        """All signals for ``m`` codes, given as bits uint8 ``[width, m]``; each uint8 ``[m]``."""
        values: dict[int, Column] = dict(enumerate(bits))
        values[ZERO] = np.zeros(bits.shape[1], dtype=np.uint8)
        values[ONE] = np.ones(bits.shape[1], dtype=np.uint8)
        for name in self.order():
            values[name] = evaluate_cell(self.cells[name], values)
        return values

    def sweep(self) -> None:
        """Fold constants and wires, merge equal cells, absorb LUTs into their only reader."""
        changed = True
        while changed:
            self._fold()
            changed = self._absorb()

    def _fold(self) -> None:
        alias: dict[int, int] = {}
        seen: dict[tuple[tuple[int, ...], bytes], int] = {}
        cells: dict[int, Cell] = {}
        for name in self.order():
            old = self.cells[name]
            cell = simplified(Cell(tuple(alias.get(x, x) for x in old.fanins), old.contents))
            if not cell.fanins:
                alias[name] = ONE if cell.contents[0] else ZERO
            elif len(cell.fanins) == 1 and cell.contents[1]:
                alias[name] = cell.fanins[0]
            elif (key := (cell.fanins, cell.contents.tobytes())) in seen:
                alias[name] = seen[key]
            else:
                seen[key] = name
                cells[name] = cell
        self.cells = cells
        self.outputs = [alias.get(x, x) for x in self.outputs]

    def _absorb(self) -> bool:
        readers, muxes = self.readers(), self.muxes()
        changed = False
        for name in self.order():
            cell = self.cells[name]
            own = [x for x in cell.fanins if x in self.cells and x not in muxes and x not in self.outputs]
            own = [x for x in own if readers[x] == [name]]
            if name in muxes:
                # A dedicated multiplexer is free: a LUT replaces it only together with both LUTs it joins.
                own = [x for x in own if x in muxes[name][:2]]
                groups = [own] if len(own) == 2 else []
            else:
                groups = [[x] for x in own]
            for group in groups:
                merged: Cell | None = self.cells[name]
                for inner in group:
                    if merged is not None:
                        merged = composed(merged, inner, self.cells[inner], self.lut_inputs)
                if merged is None or any(inner not in self.cells[name].fanins for inner in group):
                    continue
                self.cells[name] = merged
                for inner in group:
                    for signal in self.cells.pop(inner).fanins:
                        readers[signal] = [x for x in readers[signal] if x not in (inner, name)] + [name]
                changed = True
        return changed

    def muxes(self) -> dict[int, tuple[int, int, int]]:
        """The cells that can be dedicated multiplexers, with (low, high, select); lower levels first.

        Only LUTs of six inputs have them behind.
        """
        if self.lut_inputs != LUT_INPUTS:
            return {}
        height = dict.fromkeys(self.cells, 0)
        joined: set[int] = set()
        chosen: dict[int, tuple[int, int, int]] = {}
        for name in self.order():
            pins = mux_pins(self.cells[name])
            if pins is None or joined & set(pins[:2]):
                continue
            below = height.get(pins[0], -1)
            if below in (0, 1) and below == height.get(pins[1], -1):
                chosen[name] = pins
                joined |= set(pins[:2])
                height[name] = below + 1
        return chosen

    def cost(self) -> tuple[int, int, int]:
        """(LUTs, LUT levels, dedicated multiplexers) of the cells that the outputs need; less is better."""
        order, muxes = self.order(), self.muxes()
        level: dict[int, int] = {}
        for name in order:
            level[name] = (name not in muxes) + max(level.get(x, 0) for x in self.cells[name].fanins)
        depth = max((level.get(x, 0) for x in self.outputs), default=0)
        return len(order) - len(muxes), depth, len(muxes)

    def network(self, inputs: tuple[str, ...], outputs: tuple[str, ...]) -> LutNetwork:
        """The finished network with these names of inputs and outputs."""
        names = dict(enumerate(inputs))
        names[ZERO], names[ONE] = CONSTANTS
        fresh = _fresh_names({*inputs, *outputs})
        muxes = self.muxes()
        cells: list[Lut | Mux] = []
        for number in self.order():
            cell, names[number] = self.cells[number], next(fresh)
            if number in muxes:
                low, high, select = (names[x] for x in muxes[number])
                cells.append(Mux(names[number], low, high, select))
            else:
                fanins = tuple(names[x] for x in cell.fanins)
                cells.append(Lut(names[number], fanins, pack_contents(cell.contents)))
        driven = tuple(zip(outputs, (names[x] for x in self.outputs), strict=True))
        return LutNetwork(inputs, tuple(cells), driven)


def evaluate_cell(cell: Cell, values: dict[int, Column]) -> Column:
    """The cell's output, uint8 ``[m]``, from its fanins' values."""
    return look_up(cell.contents, [values[x] for x in cell.fanins])


def simplified(cell: Cell) -> Cell:
    """The same function without constant, repeated and unread fanins."""
    fanins, cube = list(cell.fanins), cell.contents.reshape((2,) * len(cell.fanins))
    for position in reversed(range(len(fanins))):
        axis = len(fanins) - 1 - position
        signal = fanins[position]
        low, high = np.moveaxis(cube, axis, 0)
        if signal in (ZERO, ONE):
            cube = high if signal == ONE else low
        elif signal in fanins[:position]:
            other = len(fanins) - 2 - fanins.index(signal)
            cube = np.concatenate([low.take([0], other), high.take([1], other)], other)
        elif np.array_equal(low, high):
            cube = low
        else:
            continue
        del fanins[position]
    ranked = sorted(range(len(fanins)), key=lambda position: fanins[position])
    last = len(fanins) - 1
    cube = cube.transpose([last - position for position in reversed(ranked)])
    return Cell(tuple(fanins[position] for position in ranked), np.ascontiguousarray(cube).reshape(-1))


def composed(reader: Cell, name: int, inner: Cell, lut_inputs: int) -> Cell | None:
    """The reader with a fanin replaced by that fanin's own cell; None if it needs more inputs."""
    others = [x for x in reader.fanins if x != name]
    fanins = tuple(dict.fromkeys((*others, *inner.fanins)))
    if len(fanins) > lut_inputs:
        return None
    codes = np.arange(1 << len(fanins))
    values = {x: (codes >> position & 1).astype(np.uint8) for position, x in enumerate(fanins)}
    values[name] = evaluate_cell(inner, values)
    return simplified(Cell(fanins, evaluate_cell(reader, values)))


def mux_pins(cell: Cell) -> tuple[int, int, int] | None:
    """(low, high, select) if the cell is a two-to-one multiplexer."""
    if len(cell.fanins) != 3:
        return None
    cube = cell.contents.reshape(2, 2, 2)  # axes: fanins 2, 1, 0
    for select in range(3):
        low, high = cube.take(0, 2 - select), cube.take(1, 2 - select)
        first, second = (x for x in range(3) if x != select)
        axes = {first: np.array([[0, 1], [0, 1]]), second: np.array([[0, 0], [1, 1]])}
        for datum0, datum1 in ((first, second), (second, first)):
            if np.array_equal(low, axes[datum0]) and np.array_equal(high, axes[datum1]):
                return cell.fanins[datum0], cell.fanins[datum1], cell.fanins[select]
    return None


def _fresh_names(taken: set[str]) -> Iterator[str]:
    number = 0
    while True:
        if (name := f"t{number}") not in taken:
            yield name
        number += 1
