"""Building and-inverter graphs: gates made one by one, and put into an order."""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

TRUE = 1
"""The literal of the constant 1; that of the constant 0 is 0."""


class GateBuilder:
    """Gates made one after another, with the literals of `wnn2hdl.ir.models.LogicModel`.

    Attributes:
        gates: the two literals that each gate reads, in order.
    """

    def __init__(self, inputs: int) -> None:
        self.gates: list[tuple[int, int]] = []
        self._next = 2 * (1 + inputs)
        self._known: dict[tuple[int, int], int] = {}

    def both(self, left: int, right: int) -> int:
        """The literal that is set if both are: a new gate only where none is like it."""
        low, high = min(left, right), max(left, right)
        if low == 0 or low ^ 1 == high:
            return 0
        if low in (TRUE, high):
            return high
        found = self._known.get((low, high))
        if found is None:
            found = self._next
            self._next += 2
            self._known[low, high] = found
            self.gates.append((low, high))
        return found

    def every(self, literals: Iterable[int]) -> int:
        """The literal that is set if all are, as a balanced tree."""
        level = list(literals)
        while len(level) > 1:
            odd = level[len(level) & ~1 :]
            level = [self.both(a, b) for a, b in zip(level[0::2], level[1::2], strict=False)] + odd
        return level[0] if level else TRUE

    def any(self, literals: Iterable[int]) -> int:
        """The literal that is set if one of them is."""
        return self.every(literal ^ 1 for literal in literals) ^ 1

    def array(self) -> NDArray[np.uint32]:
        """The gates: uint32 ``[gates, 2]``."""
        return np.array(self.gates, dtype=np.uint32).reshape(-1, 2)


def in_order(reads: Sequence[Sequence[int]]) -> list[int]:
    """An order of nodes in which each comes after all that it reads.

    Args:
        reads: indices of the nodes that each node reads.

    Raises:
        ValueError: nodes read one another in a circle.
    """
    done, entered = bytearray(len(reads)), bytearray(len(reads))
    order: list[int] = []
    for root in range(len(reads)):
        stack = [root]
        while stack:
            node = stack[-1]
            waiting = [] if done[node] else [other for other in reads[node] if not done[other]]
            if waiting and entered[node]:
                raise ValueError("gates read one another in a circle")
            if waiting:
                entered[node] = 1
                stack.extend(waiting)
                continue
            stack.pop()
            if not done[node]:
                done[node] = 1
                order.append(node)
    return order
