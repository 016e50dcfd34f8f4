"""And-inverter graphs in files of the binary AIGER format, and their unrolling over clock cycles."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Self

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import ToolError


@dataclass(frozen=True)
class Aiger:
    """A graph over literals: ``2 * v`` is variable ``v``, ``2 * v + 1`` its inverse; variable 0 is false.

    Attributes:
        inputs: how many inputs there are: variables 1, 2 and so on.
        latches: what each latch stores next; their variables follow those of the inputs.
        outputs: the outputs.
        ands: the two literals of each gate; their variables follow those of the latches.
    """

    inputs: int
    latches: tuple[int, ...]
    outputs: tuple[int, ...]
    ands: tuple[tuple[int, int], ...]

    @classmethod
    def read(cls, path: Path) -> Self:
        """Read a file; initial values of latches are left out. Raises ToolError on another format."""
        content = path.read_bytes()
        header, _, rest = content.partition(b"\n")
        fields = header.split()
        if len(fields) != 6 or fields[0] != b"aig":
            raise ToolError("not a graph in the binary AIGER format", value=header[:80])
        _, inputs, latches, outputs, gates = map(int, fields[1:])
        lines = rest.split(b"\n", latches + outputs)
        found = [int(line.split()[0]) for line in lines[:-1]]
        numbers = _numbers(lines[-1])
        ands = []
        for gate in range(inputs + latches + 1, inputs + latches + 1 + gates):
            high = 2 * gate - next(numbers)
            ands.append((high, high - next(numbers)))
        return cls(inputs, tuple(found[:latches]), tuple(found[latches:]), tuple(ands))

    def write(self, path: Path) -> None:
        """Write a file of a graph without latches."""
        path.write_bytes(binary_aiger(self.inputs, self.outputs, np.array(self.ands)))

    def unrolled(self, cycles: int, first: tuple[int, ...]) -> "Aiger":
        """The outputs ``cycles`` clock edges later, as a graph without latches.

        Args:
            cycles: how many.
            first: places of inputs; in this order their values before the first edge are the first inputs.

        Returns:
            A graph whose other inputs are all that may not matter: the latches before the first edge, the
            inputs at all later times, and at the first those that ``first`` leaves out.
        """
        fresh = iter(range(2 * (len(first) + 1), 2 * (self.inputs * (cycles + 1) + len(self.latches) + 1), 2))
        start = {place: 2 * (position + 1) for position, place in enumerate(first)}
        values = [start[place] if place in start else next(fresh) for place in range(self.inputs)]
        state = [next(fresh) for _ in self.latches]
        total = self.inputs * (cycles + 1) + len(self.latches)
        ands: list[tuple[int, int]] = []
        literals: list[int] = []
        for cycle in range(cycles + 1):
            if cycle:
                state = [literals[latch >> 1] ^ latch & 1 for latch in self.latches]
                values = [next(fresh) for _ in range(self.inputs)]
            literals = [0, *values, *state]
            for left, right in self.ands:
                ands.append((literals[left >> 1] ^ left & 1, literals[right >> 1] ^ right & 1))
                literals.append(2 * (total + len(ands)))
        outputs = tuple(literals[output >> 1] ^ output & 1 for output in self.outputs)
        return Aiger(total, (), outputs, tuple(ands))

    def widened(self, first: int, before: int, after: int) -> "Aiger":
        """The graph with more inputs, which nothing reads.

        Args:
            first: how many inputs stay where they are.
            before: how many new ones follow these.
            after: how many follow the last.
        """

        def moved(literal: int) -> int:
            variable = literal >> 1
            by = 0 if variable <= first else before if variable <= self.inputs else before + after
            return literal + 2 * by

        return Aiger(
            self.inputs + before + after,
            (),
            tuple(map(moved, self.outputs)),
            tuple((moved(left), moved(right)) for left, right in self.ands),
        )


def binary_aiger(inputs: int, outputs: Iterable[int], ands: NDArray[np.integer]) -> bytes:
    """The content of a file: each gate is two differences of literals, the larger literal first.

    Args:
        inputs: as of `Aiger`.
        outputs: as of `Aiger`.
        ands: ``[gates, 2]``, the two literals of each gate, which are below its own; any shape for no gate.
    """
    pairs = np.sort(ands.astype(np.int64).reshape(-1, 2), axis=1)
    literals = list(outputs)
    header = f"aig {inputs + len(pairs)} {inputs} 0 {len(literals)} {len(pairs)}\n"
    own = 2 * (1 + inputs + np.arange(len(pairs), dtype=np.int64))
    differences = np.stack([own - pairs[:, 1], pairs[:, 1] - pairs[:, 0]], axis=1)
    lines = "".join(f"{literal}\n" for literal in literals)
    return (header + lines).encode("ascii") + b"".join(map(_bytes, differences.reshape(-1).tolist()))


def _numbers(content: bytes) -> Iterator[int]:
    """Numbers in bytes of seven bits, the least significant first; the high bit says that more follow."""
    value = shift = 0
    for byte in content:
        value |= (byte & 127) << shift
        shift += 7
        if byte < 128:
            yield value
            value = shift = 0


def _bytes(number: int) -> bytes:
    """A number as `_numbers` reads it."""
    found = bytearray()
    while number > 127:
        found.append(number & 127 | 128)
        number >>= 7
    return bytes([*found, number])
