"""Truth tables with don't-cares, and their columns as integers."""

from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.errors import ModelFileError
from wnn2hdl.ir.codes import MAX_TABLE_INPUTS


@dataclass(frozen=True, eq=False)
class TruthTable:
    """A Boolean function of several outputs, given on its care set and free elsewhere.

    Attributes:
        inputs: name of each input; input ``i`` is bit ``i`` of the code.
        outputs: name of each output.
        values: bool ``[2**len(inputs), len(outputs)]``, indexed by code; meaningless where `care` is false.
        care: bool ``[2**len(inputs)]``; false marks a don't-care code.
    """

    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    values: NDArray[np.bool_]
    care: NDArray[np.bool_]

    def __post_init__(self) -> None:
        size = 1 << len(self.inputs)
        if len(self.inputs) > MAX_TABLE_INPUTS:
            raise ValueError(f"a table has at most {MAX_TABLE_INPUTS} inputs, not {len(self.inputs)}")
        if self.values.shape != (size, len(self.outputs)) or self.care.shape != (size,):
            raise ValueError(
                f"a table of {len(self.inputs)} inputs and {len(self.outputs)} outputs cannot have values "
                f"{self.values.shape} and care {self.care.shape}"
            )
        if self.values.dtype != np.bool_ or self.care.dtype != np.bool_:
            raise ValueError(f"values and care must be bool, not {self.values.dtype} and {self.care.dtype}")

    @classmethod
    def exact(cls, inputs: tuple[str, ...], outputs: tuple[str, ...], values: NDArray[np.bool_]) -> Self:
        """A table without don't-cares."""
        return cls(inputs, outputs, values, np.ones(len(values), dtype=np.bool_))

    def with_care(self, care: NDArray[np.bool_]) -> "TruthTable":
        """The same function, free outside ``care``."""
        return TruthTable(self.inputs, self.outputs, self.values, care)

    def evaluate(self, codes: ArrayLike) -> NDArray[np.bool_]:
        """Outputs for codes of shape ``S``: bool ``S + (len(outputs),)``."""
        return self.values[np.asarray(codes, dtype=np.int64)]

    def mismatches(self, other: NDArray[np.bool_]) -> NDArray[np.int64]:
        """Cared-for codes on which ``other`` (bool, shaped as `values`) differs, ascending."""
        differs = (self.values != other).any(axis=1) & self.care
        return np.flatnonzero(differs)

    def to_json(self) -> dict[str, Any]:
        """A JSON object; columns are hexadecimal numbers whose bit ``c`` belongs to code ``c``."""
        return {
            "inputs": list(self.inputs),
            "outputs": list(self.outputs),
            "values": [_to_hex(column) for column in self.values.T],
            "care": _to_hex(self.care),
        }

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Self:
        """The inverse of `to_json`; raises `ModelFileError` on anything else."""
        try:
            size = 1 << min(len(data["inputs"]), MAX_TABLE_INPUTS + 1)
            columns = [_from_hex(column, size) for column in data["values"]]
            values = np.stack(columns, axis=1) if columns else np.zeros((size, 0), dtype=np.bool_)
            care = _from_hex(data["care"], size)
            return cls(tuple(data["inputs"]), tuple(data["outputs"]), values, care)
        except (KeyError, TypeError, ValueError) as error:
            raise ModelFileError("not a truth table", value=error, hint="compile the model again") from error


def pack_contents(flags: NDArray[np.bool_] | NDArray[np.uint8]) -> int:
    """A column of a table as an integer.

    Args:
        flags: bool or uint8 of 0 and 1, ``[2**width]``, indexed by code.

    Returns:
        The integer whose bit ``c`` is the value at code ``c``, as the contents of a LUT are written.
    """
    return int.from_bytes(np.packbits(flags, bitorder="little").tobytes(), "little")


def unpack_contents(contents: int, width: int) -> NDArray[np.bool_]:
    """The inverse of `pack_contents`: bool ``[2**width]``."""
    size = 1 << width
    packed = np.frombuffer(contents.to_bytes(-(-size // 8), "little"), dtype=np.uint8)
    return np.unpackbits(packed, count=size, bitorder="little").astype(np.bool_)


def _to_hex(flags: NDArray[np.bool_]) -> str:
    return np.packbits(flags, bitorder="little")[::-1].tobytes().hex()


def _from_hex(text: str, size: int) -> NDArray[np.bool_]:
    packed = np.frombuffer(bytes.fromhex(text), dtype=np.uint8)[::-1]
    flags = np.unpackbits(packed, bitorder="little")
    if len(flags) != max(size, 8) or flags[size:].any():
        raise ValueError(f"{len(flags)} bits where {size} belong")
    return flags[:size].astype(np.bool_)
