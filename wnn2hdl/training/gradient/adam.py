"""Adam, in place and on float32."""

from collections.abc import Mapping
from typing import Self

import numpy as np
from numpy.typing import NDArray

_DECAY = 0.9
_SQUARE_DECAY = 0.999
_LEAST = 1e-12


class Adam:
    """The state of one array that is optimised (Kingma and Ba, 2015).

    Args:
        shape: of the array.
        by_row: keep one mean of squares for each row instead of one for each number: half the memory and
            time.

    Attributes:
        mean: running mean of the gradients, of the array's shape.
        square: running mean of their squares, of the array's shape or ``[rows, 1]``.
        steps: how many were made.
    """

    def __init__(self, shape: tuple[int, int], *, by_row: bool = False) -> None:
        self.mean = np.zeros(shape, dtype=np.float32)
        self.square = np.zeros((shape[0], 1) if by_row else shape, dtype=np.float32)
        self.steps = 0

    def step(self, array: NDArray[np.float32], gradient: NDArray[np.float32], rate: float) -> None:
        """Move an array against a gradient of its shape; the gradient's scale does not matter."""
        self.steps += 1
        self.mean *= _DECAY
        self.mean += np.float32(1 - _DECAY) * gradient
        self.square *= _SQUARE_DECAY
        if self.square.shape == gradient.shape:
            self.square += np.float32(1 - _SQUARE_DECAY) * gradient**2
        else:
            self.square += np.float32(1 - _SQUARE_DECAY) * mean_squares(gradient)
        unbiased = np.sqrt(self.square / (1 - _SQUARE_DECAY**self.steps)) + np.float32(_LEAST)
        array -= np.float32(rate / (1 - _DECAY**self.steps)) / unbiased * self.mean

    def arrays(self) -> dict[str, NDArray[np.generic]]:
        """The state, by name."""
        return {"mean": self.mean, "square": self.square, "steps": np.asarray(self.steps)}

    @classmethod
    def of(cls, arrays: Mapping[str, NDArray[np.generic]]) -> Self:
        """The inverse of `arrays`."""
        adam = cls((1, 1))
        adam.mean, adam.square = arrays["mean"].astype(np.float32), arrays["square"].astype(np.float32)
        adam.steps = int(arrays["steps"].item())
        return adam


def mean_squares(gradient: NDArray[np.float32]) -> NDArray[np.float32]:
    """Mean of the squares of each row: float32 ``[rows, 1]``."""
    return np.asarray(np.einsum("ij,ij->i", gradient, gradient) / np.float32(gradient.shape[1]))[
        :, np.newaxis
    ]
