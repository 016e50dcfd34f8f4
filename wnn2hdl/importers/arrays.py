"""NumPy arrays and numbers inside pickles."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.importers.pickles import Saved, StandIn, UnreadablePickleError


@dataclass(eq=False)
class PickledType(Saved):
    """A NumPy type: kind and size such as ``i8``, and ``<`` or ``>`` for the order of bytes."""

    code: str
    order: str = "<"

    def set_state(self, state: object) -> None:
        """Take the order of bytes."""
        if not isinstance(state, tuple) or len(state) < 2 or state[1] not in ("<", ">", "|", "="):
            raise UnreadablePickleError("a NumPy type is damaged")
        self.order = state[1]

    @property
    def dtype(self) -> np.dtype[Any]:
        """The type, a number or truth value of a fixed size."""
        if self.code not in {
            "b1",
            *(f"{kind}{size}" for kind in "iu" for size in (1, 2, 4, 8)),
            "f2",
            "f4",
            "f8",
        }:
            raise UnreadablePickleError(f"a NumPy type {self.code[:20]!r} is not a number")
        return np.dtype(self.order + self.code)


@dataclass(eq=False)
class PickledArray(Saved):
    """A NumPy array, whose contents come after it."""

    array: NDArray[Any] | None = None

    def set_state(self, state: object) -> None:
        """Take version, shape, type, whether columns come first, and bytes."""
        match state:
            case (_, tuple() as shape, PickledType() as kind, columns_first, bytes() as content):
                flat = np.frombuffer(content, dtype=kind.dtype)
                self.array = flat.reshape(shape, order="F" if columns_first else "C")
            case _:
                raise UnreadablePickleError("a NumPy array is damaged")


def _scalar(kind: Any, content: bytes) -> NDArray[Any]:
    if not isinstance(kind, PickledType):
        raise UnreadablePickleError("a NumPy number is damaged")
    return np.frombuffer(content, dtype=kind.dtype).reshape(())


def _encoded(text: str, encoding: str) -> bytes:
    if encoding != "latin1":
        raise UnreadablePickleError(f"bytes are written as {encoding[:20]!r}")
    return text.encode("latin-1")


NUMPY: dict[str, StandIn] = {
    stand_in.name: stand_in
    for stand_in in (
        StandIn("numpy.ndarray", lambda *_: None),
        StandIn("numpy.dtype", lambda code, *_: PickledType(code)),
        *(
            StandIn(f"numpy.{core}.multiarray.{name}", make)
            for core in ("core", "_core")
            for name, make in (("_reconstruct", lambda *_: PickledArray()), ("scalar", _scalar))
        ),
        StandIn("_codecs.encode", _encoded),
        StandIn("__builtin__.bytes", lambda: b""),
    )
}
"""What a pickle needs to hold NumPy arrays."""


def array_of(value: object, what: str) -> NDArray[Any]:
    """The array that a pickled value is; raises UnreadablePickleError if it is something else."""
    found = value.array if isinstance(value, PickledArray) else value
    if not isinstance(found, np.ndarray):
        raise UnreadablePickleError(f"{what} is not an array")
    return found
