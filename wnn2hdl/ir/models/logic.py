"""Combinational networks of gates: an and-inverter graph with named inputs and outputs."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.ir.modelfile import header, pack, unpack
from wnn2hdl.ir.models.base import Model, in_chunks

WORD = 64
"""Samples that one word of an evaluation holds."""


@dataclass(frozen=True, eq=False)
class LogicModel(Model):
    """And gates with two inputs, each of which may be inverted.

    A *literal* is ``2 * variable + inverted``. Variable 0 is the constant 0, then come the inputs in order,
    then the gates in order; a gate reads only variables before its own.

    Attributes:
        inputs: names, in the order of the input bits.
        outputs: names, in the order of the answers.
        gates: uint32 ``[gates, 2]``, the two literals that each reads.
        literals: uint32 ``[outputs]``, the literal that each output is.
        origin: where the model comes from.
    """

    kind: ClassVar[str] = "logic"
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    gates: NDArray[np.uint32]
    literals: NDArray[np.uint32]
    origin: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for names in (self.inputs, self.outputs):
            if not names or len(set(names)) != len(names):
                raise ValueError("a network needs inputs and outputs, each with its own name")
        if self.gates.ndim != 2 or self.gates.shape[1] != 2:
            raise ValueError(f"the gates have shape {self.gates.shape}; it must be [gates, 2]")
        if self.literals.shape != (len(self.outputs),):
            raise ValueError(
                f"there are {self.literals.size} output literals for {len(self.outputs)} outputs"
            )
        own = np.arange(1 + self.width, 1 + self.width + len(self.gates))
        if (self.gates >> 1 >= own[:, np.newaxis]).any():
            raise ValueError("a gate reads itself or a gate after it")
        if (self.literals >> 1).max() > self.width + len(self.gates):
            raise ValueError(f"an output is variable {(self.literals >> 1).max()}, which does not exist")

    @property
    def width(self) -> int:
        """Input bits."""
        return len(self.inputs)

    @cached_property
    def levels(self) -> NDArray[np.int64]:
        """Gates on the longest way from an input to each variable: int64 ``[1 + inputs + gates]``."""
        found = [0] * (1 + self.width)
        for left, right in (self.gates >> 1).tolist():
            a, b = found[left], found[right]
            found.append((a if a > b else b) + 1)
        return np.array(found, dtype=np.int64)

    @cached_property
    def _schedule(self) -> list[NDArray[np.int64]]:
        """Gates of each level, lowest first; a level needs only those below it."""
        levels = self.levels[1 + self.width :]
        order = np.argsort(levels, kind="stable")
        return np.split(order, np.flatnonzero(np.diff(levels[order])) + 1) if len(order) else []

    def evaluate(self, bits: ArrayLike) -> NDArray[np.bool_]:
        """Answers of all outputs for bits ``[samples, width]``: bool ``[samples, outputs]``."""
        variables = 1 + self.width + len(self.gates)
        return in_chunks(
            bits, self.width, variables // 8 + 2 * self.width + len(self.outputs), self._evaluate
        )

    def _evaluate(self, rows: NDArray[np.bool_]) -> NDArray[np.bool_]:
        samples = rows.shape[1]
        words = -(-samples // WORD)
        state = np.zeros((1 + self.width + len(self.gates), words), dtype=np.uint64)
        packed = np.zeros((self.width, words * 8), dtype=np.uint8)
        packed[:, : -(-samples // 8)] = np.packbits(rows, axis=1, bitorder="little")
        state[1 : 1 + self.width] = packed.view(np.uint64)
        for gates in self._schedule:
            left, right = self.gates[gates].T
            state[1 + self.width + gates] = _read(state, left) & _read(state, right)
        answers = np.unpackbits(_read(state, self.literals).view(np.uint8), axis=1, bitorder="little")
        return answers[:, :samples].T.astype(np.bool_)

    def to_json(self) -> dict[str, Any]:
        """The model file's object."""
        return {
            **header(self.kind),
            "inputs": list(self.inputs),
            "outputs": list(self.outputs),
            "gates": pack(self.gates),
            "literals": pack(self.literals),
            "origin": dict(self.origin),
        }

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Self:
        """The model of an object that fits the schema; raises ValueError if it contradicts itself."""
        return cls(
            inputs=tuple(data["inputs"]),
            outputs=tuple(data["outputs"]),
            gates=unpack(data["gates"], np.uint32, 2),
            literals=unpack(data["literals"], np.uint32, 1),
            origin=data["origin"],
        )


def _read(state: NDArray[np.uint64], literals: NDArray[np.uint32]) -> NDArray[np.uint64]:
    """Words of literals: state ``[variables, words]`` gives ``[literals, words]``."""
    inverted = -(literals & 1).astype(np.int64)
    return np.asarray(state[literals >> 1] ^ inverted.astype(np.uint64)[:, np.newaxis])
