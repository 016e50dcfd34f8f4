"""Networks of look-up tables: what a table becomes once it is mapped to an FPGA's cells."""

from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.errors import ModelFileError

LUT_INPUTS = 6
"""Inputs of the 7-series LUT (Xilinx UG474)."""

CONSTANTS = ("0", "1")
"""Signal names that stand for constants; an output may be tied to one."""


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


@dataclass(frozen=True)
class LutNetwork:
    """A combinational network of LUTs, in topological order.

    Attributes:
        inputs: names of the network's inputs; input ``i`` is bit ``i`` of the code.
        luts: each reads inputs of the network and LUTs before it.
        outputs: pairs (output name, signal); the signal is an input, a LUT or one of `CONSTANTS`.
    """

    inputs: tuple[str, ...]
    luts: tuple[Lut, ...]
    outputs: tuple[tuple[str, str], ...]

    def __post_init__(self) -> None:
        known = set(self.inputs)
        for lut in self.luts:
            if not 1 <= len(lut.inputs) <= LUT_INPUTS:
                raise ValueError(f"{lut.name} has {len(lut.inputs)} inputs; a LUT has 1 to {LUT_INPUTS}")
            if not 0 <= lut.init < 1 << (1 << len(lut.inputs)):
                raise ValueError(f"{lut.name} has contents {lut.init:#x}, too wide for its inputs")
            if lut.name in known or lut.name in CONSTANTS:
                raise ValueError(f"{lut.name} is driven twice")
            if missing := set(lut.inputs) - known:
                raise ValueError(f"{lut.name} reads {sorted(missing)} before it is driven")
            known.add(lut.name)
        for name, signal in self.outputs:
            if signal not in known and signal not in CONSTANTS:
                raise ValueError(f"output {name} reads {signal}, which nothing drives")

    @property
    def depth(self) -> int:
        """LUTs on the longest path from an input to an output."""
        level = dict.fromkeys((*self.inputs, *CONSTANTS), 0)
        for lut in self.luts:
            level[lut.name] = 1 + max(level[name] for name in lut.inputs)
        return max((level[signal] for _, signal in self.outputs), default=0)

    def evaluate(self, codes: ArrayLike) -> NDArray[np.bool_]:
        """Outputs for codes of shape ``S``: bool ``S + (len(outputs),)``."""
        values = np.asarray(codes, dtype=np.int64)
        signals: dict[str, NDArray[np.bool_]] = {
            "0": np.zeros(values.shape, dtype=np.bool_),
            "1": np.ones(values.shape, dtype=np.bool_),
        }
        for position, name in enumerate(self.inputs):
            signals[name] = (values >> position & 1).astype(np.bool_)
        for lut in self.luts:
            contents = np.array([lut.init >> a & 1 for a in range(1 << len(lut.inputs))], dtype=np.bool_)
            address = np.zeros(values.shape, dtype=np.int64)
            for position, name in enumerate(lut.inputs):
                address |= signals[name].astype(np.int64) << position
            signals[lut.name] = contents[address]
        columns = [signals[signal] for _, signal in self.outputs]
        return np.stack(columns, axis=-1) if columns else np.zeros((*values.shape, 0), dtype=np.bool_)

    def to_json(self) -> dict[str, Any]:
        """A JSON object; LUT contents are hexadecimal."""
        return {
            "inputs": list(self.inputs),
            "luts": [{"name": x.name, "inputs": list(x.inputs), "init": f"{x.init:x}"} for x in self.luts],
            "outputs": [list(pair) for pair in self.outputs],
        }

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Self:
        """The inverse of `to_json`; raises `ModelFileError` on anything else."""
        try:
            luts = tuple(Lut(x["name"], tuple(x["inputs"]), int(x["init"], 16)) for x in data["luts"])
            outputs = tuple((name, signal) for name, signal in data["outputs"])
            return cls(tuple(data["inputs"]), luts, outputs)
        except (KeyError, TypeError, ValueError) as error:
            raise ModelFileError("not a LUT network", value=error, mend="compile the model again") from error
