"""Care sets: which values of a word can matter, and which are don't-cares.

There are four kinds. `Everything` leaves no don't-care. `Codes` lists the allowed values of a word of few
bits. `Patterns` lists the values that were seen on a word of any width. `Implied` states what cannot occur on
any input, so that its don't-cares are free even where a circuit has to equal its model on every input.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir.codes import MAX_TABLE_INPUTS, all_codes, codes_to_bits
from wnn2hdl.ir.wires import Bits


@dataclass(frozen=True)
class Everything:
    """Every value of a word of ``width`` bits matters."""

    kind: ClassVar[str] = "everything"
    width: int

    def allows(self, bits: Bits) -> NDArray[np.bool_]:
        """Which samples of the word, bool ``[samples, width]``, are in the set: bool ``[samples]``."""
        return np.ones(len(bits), dtype=np.bool_)

    def project(self, positions: tuple[int, ...]) -> NDArray[np.bool_]:
        """Which codes of a few of the word's bits occur in the set: bool ``[2**len(positions)]``.

        Args:
            positions: the bits, at most `MAX_TABLE_INPUTS`; the first is the least significant of the code.
        """
        return np.ones(len(all_codes(len(positions))), dtype=np.bool_)

    def to_json(self) -> dict[str, Any]:
        """A JSON object, read back by `care_from_json`."""
        return {"kind": self.kind, "width": self.width}


@dataclass(frozen=True, eq=False)
class Codes:
    """The allowed values of a word of at most `MAX_TABLE_INPUTS` bits.

    Attributes:
        flags: bool ``[2**width]``, indexed by code.
    """

    kind: ClassVar[str] = "codes"
    flags: NDArray[np.bool_]

    def __post_init__(self) -> None:
        if self.flags.dtype != np.bool_ or len(self.flags) != 1 << self.width or self.flags.ndim != 1:
            raise ValueError(f"a care set of codes needs 2**width bools, not {self.flags.shape}")
        if self.width > MAX_TABLE_INPUTS:
            raise ValueError(f"a care set of codes has at most {MAX_TABLE_INPUTS} bits, not {self.width}")

    @property
    def width(self) -> int:
        """Bits of the word."""
        return len(self.flags).bit_length() - 1

    def allows(self, bits: Bits) -> NDArray[np.bool_]:
        """See `Everything.allows`."""
        weights = 1 << np.arange(self.width, dtype=np.int64)
        return self.flags[bits @ weights]

    def project(self, positions: tuple[int, ...]) -> NDArray[np.bool_]:
        """See `Everything.project`."""
        return _occurring(codes_to_bits(np.flatnonzero(self.flags), self.width), positions)

    def to_json(self) -> dict[str, Any]:
        """See `Everything.to_json`."""
        return {"kind": self.kind, "width": self.width, "codes": np.flatnonzero(self.flags).tolist()}


@dataclass(frozen=True, eq=False)
class Patterns:
    """The values that were seen on a word of any width.

    Attributes:
        rows: bool ``[patterns, width]``, no row twice.
    """

    kind: ClassVar[str] = "patterns"
    rows: Bits

    def __post_init__(self) -> None:
        if self.rows.ndim != 2 or self.rows.dtype != np.bool_:
            raise ValueError(f"patterns are bools [patterns, width], not {self.rows.dtype} {self.rows.shape}")

    @property
    def width(self) -> int:
        """Bits of the word."""
        return int(self.rows.shape[1])

    @cached_property
    def _packed(self) -> frozenset[bytes]:
        return frozenset(row.tobytes() for row in np.packbits(self.rows, axis=1))

    def allows(self, bits: Bits) -> NDArray[np.bool_]:
        """See `Everything.allows`."""
        packed = np.packbits(bits, axis=1)
        return np.fromiter((row.tobytes() in self._packed for row in packed), np.bool_, len(packed))

    def project(self, positions: tuple[int, ...]) -> NDArray[np.bool_]:
        """See `Everything.project`."""
        return _occurring(self.rows, positions)

    def to_json(self) -> dict[str, Any]:
        """See `Everything.to_json`; each pattern is a hexadecimal number whose bit ``i`` is bit ``i``."""
        packed = np.packbits(self.rows, axis=1, bitorder="little")[:, ::-1]
        return {"kind": self.kind, "width": self.width, "patterns": [row.tobytes().hex() for row in packed]}


@dataclass(frozen=True)
class Implied:
    """What can occur on any input at all: the bits of each thermometer fall from the first to the last.

    Attributes:
        width: bits of the word.
        falling: groups of bit positions; in each group a set bit is preceded by set bits only, as where bit
            ``t`` of a thermometer is ``x >= threshold[t]`` and the thresholds rise.
    """

    kind: ClassVar[str] = "implied"
    width: int
    falling: tuple[tuple[int, ...], ...]

    def __post_init__(self) -> None:
        used = [position for group in self.falling for position in group]
        if len(set(used)) != len(used) or not all(0 <= position < self.width for position in used):
            raise ValueError(f"the groups of a word of {self.width} bits name a bit twice or one beyond it")

    def allows(self, bits: Bits) -> NDArray[np.bool_]:
        """See `Everything.allows`."""
        allowed = np.ones(len(bits), dtype=np.bool_)
        for group in self.falling:
            for above, below in pairwise(group):
                allowed &= bits[:, above] | ~bits[:, below]
        return allowed

    def project(self, positions: tuple[int, ...]) -> NDArray[np.bool_]:
        """See `Everything.project`."""
        flags = codes_to_bits(all_codes(len(positions)), len(positions))
        place = {position: i for i, position in enumerate(positions)}
        allowed = np.ones(len(flags), dtype=np.bool_)
        for group in self.falling:
            read = [place[position] for position in group if position in place]
            for above, below in pairwise(read):
                allowed &= flags[:, above] | ~flags[:, below]
        return allowed

    def to_json(self) -> dict[str, Any]:
        """See `Everything.to_json`."""
        return {"kind": self.kind, "width": self.width, "falling": [list(group) for group in self.falling]}


CareSet = Everything | Codes | Patterns | Implied


def care_from_json(data: dict[str, Any]) -> CareSet:
    """The care set that wrote ``data``.

    Raises:
        KeyError, TypeError, ValueError: there is no such care set.
    """
    width = int(data["width"])
    match data["kind"]:
        case Everything.kind:
            return Everything(width)
        case Codes.kind:
            if not 0 <= width <= MAX_TABLE_INPUTS:
                raise ValueError(f"a care set of codes has at most {MAX_TABLE_INPUTS} bits, not {width}")
            flags = np.zeros(1 << width, dtype=np.bool_)
            codes = np.asarray(data["codes"], dtype=np.int64)
            if codes.size and not 0 <= codes.min() <= codes.max() < len(flags):
                raise ValueError(f"a code does not fit {width} bits")
            flags[codes] = True
            return Codes(flags)
        case Patterns.kind:
            size = -(-width // 8)
            patterns = [bytes.fromhex(text) for text in data["patterns"]]
            if any(len(pattern) != size for pattern in patterns):
                raise ValueError(f"a pattern does not have {width} bits")
            packed = np.frombuffer(b"".join(patterns), dtype=np.uint8)
            rows = np.unpackbits(packed.reshape(-1, size)[:, ::-1], axis=1, bitorder="little")
            return Patterns(rows[:, :width].astype(np.bool_))
        case Implied.kind:
            return Implied(width, tuple(tuple(map(int, group)) for group in data["falling"]))
    raise ValueError(f"{data['kind']!r} is not a kind of care set")


def _occurring(rows: Bits, positions: tuple[int, ...]) -> NDArray[np.bool_]:
    flags = np.zeros(len(all_codes(len(positions))), dtype=np.bool_)
    flags[rows[:, list(positions)] @ (1 << np.arange(len(positions), dtype=np.int64))] = True
    return flags
