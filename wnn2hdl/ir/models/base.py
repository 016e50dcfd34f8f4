"""What all models of the family share: bits in, answers out, a digest, a file."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, ClassVar, Literal, Self, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.files import write_json
from wnn2hdl.ir.encoder import Encoder
from wnn2hdl.ir.modelfile import answers_digest

FirstOrLast = Literal["first", "last"]
"""Which of several equal classes wins: the one with the lowest index, or the one with the highest."""

CHUNK_BYTES = 1 << 26
"""About how much memory an evaluation takes at a time, beside its input and its result."""

ZERO = -1
"""In a mapping, an input that is the constant 0."""

Number = TypeVar("Number", bound=np.generic)


class Model(ABC):
    """A trained network: a function of input bits.

    Attributes:
        kind: its name in the model file.
        origin: where the model comes from, any JSON object; it decides no answer.
    """

    kind: ClassVar[str]
    origin: Mapping[str, Any]

    @property
    @abstractmethod
    def width(self) -> int:
        """Input bits."""

    @abstractmethod
    def to_json(self) -> dict[str, Any]:
        """The model file's object."""

    @classmethod
    @abstractmethod
    def from_json(cls, data: dict[str, Any]) -> Self:
        """The model of an object that fits the schema; raises ValueError if it contradicts itself."""

    def digest(self) -> str:
        """SHA-256 of all that decides the model's answers (not of `origin`), hexadecimal."""
        return answers_digest(self.to_json())

    def save(self, path: Path) -> None:
        """Write the model file."""
        write_json(path, self.to_json())


class ClassifierModel(Model):
    """A model whose classes each give a whole number, of which the highest wins.

    Attributes:
        encoder: what turns features into the ``encoder.width`` input bits.
        classes: class names, at least two.
        ties: which of several highest classes wins.
    """

    encoder: Encoder
    classes: tuple[str, ...]

    @property
    @abstractmethod
    def ties(self) -> FirstOrLast:
        """Which of several highest classes wins."""

    @property
    def width(self) -> int:
        """Input bits."""
        return self.encoder.width

    @abstractmethod
    def responses(self, bits: ArrayLike) -> NDArray[np.int64]:
        """What each class gives.

        Args:
            bits: bool ``[samples, width]``.

        Returns:
            int64 ``[samples, classes]``.
        """

    def evaluate(self, bits: ArrayLike) -> NDArray[np.int64]:
        """Index of the winning class for bits ``[samples, width]``: int64 ``[samples]``."""
        return winner(self.responses(bits), self.ties)


def winner(responses: NDArray[np.int64], ties: FirstOrLast) -> NDArray[np.int64]:
    """Index of the highest of each row: ``[samples, classes]`` gives int64 ``[samples]``."""
    if ties == "first":
        return np.asarray(responses.argmax(axis=1))
    return np.asarray(responses.shape[1] - 1 - responses[:, ::-1].argmax(axis=1))


def in_chunks(
    bits: ArrayLike, width: int, bytes_each: int, step: Callable[[NDArray[np.bool_]], NDArray[Number]]
) -> NDArray[Number]:
    """The answers of ``step`` for all samples, which it is given some at a time.

    Args:
        bits: bool ``[samples, width]``.
        width: input bits of the model.
        bytes_each: memory that ``step`` needs for each sample.
        step: of bits ``[width, some samples]``, each input a contiguous row; answers
            ``[some samples, …]``.

    Raises:
        ValueError: bits of another width.
    """
    flags = np.asarray(bits, dtype=np.bool_)
    if flags.ndim != 2 or flags.shape[1] != width:
        raise ValueError(f"the model reads bits [samples, {width}], not of shape {list(flags.shape)}")
    count = max(64, CHUNK_BYTES // max(1, bytes_each))
    starts = range(0, max(1, len(flags)), count)
    return np.concatenate([step(np.ascontiguousarray(flags[at : at + count].T)) for at in starts])


def addresses(rows: NDArray[np.bool_], mapping: NDArray[np.int32], dtype: type[Number]) -> NDArray[Number]:
    """The address at each node: slot 0 of the mapping is its least significant bit.

    Args:
        rows: bool ``[width, samples]``.
        mapping: int32 ``[nodes, n]``, indices of rows or `ZERO`.
        dtype: an unsigned integer of at least ``n`` bits.

    Returns:
        of ``dtype``, ``[nodes, samples]``.
    """
    inputs = with_zero(rows)
    result = np.zeros((len(mapping), rows.shape[1]), dtype=dtype)
    for slot in range(mapping.shape[1]):
        result |= inputs[mapping[:, slot]].astype(dtype) << dtype(slot)
    return result


def with_zero(rows: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Rows ``[width, samples]`` and one more of zeros, which an index of `ZERO` takes."""
    return np.concatenate([rows, np.zeros((1, rows.shape[1]), dtype=np.bool_)])


def check_classes(classes: tuple[str, ...]) -> None:
    """Raise ValueError unless there are at least two classes of different names."""
    if len(classes) < 2 or len(set(classes)) != len(classes):
        raise ValueError(f"a model needs at least two different classes, not {list(classes)[:10]}")


def check_mapping(mapping: NDArray[np.int32], width: int) -> None:
    """Raise ValueError unless every index is one of ``width`` inputs or `ZERO`."""
    if mapping.size and not ZERO <= mapping.min() <= mapping.max() < width:
        raise ValueError(f"the mapping reads inputs {mapping.min()} to {mapping.max()}; there are {width}")
