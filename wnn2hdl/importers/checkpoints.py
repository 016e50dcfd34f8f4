"""PyTorch checkpoints read without PyTorch: the archive's own tensors, and values made of them."""

import io
import zipfile
import zlib
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.importers.arrays import NUMPY
from wnn2hdl.importers.pickles import StandIn, UnreadablePickleError, read_pickle, record

STORAGES = {
    "DoubleStorage": "f8",
    "FloatStorage": "f4",
    "HalfStorage": "f2",
    "BFloat16Storage": "bf16",
    "LongStorage": "i8",
    "IntStorage": "i4",
    "ShortStorage": "i2",
    "CharStorage": "i1",
    "ByteStorage": "u1",
    "BoolStorage": "b1",
}
"""NumPy's name for what each kind of storage holds."""

MODULES = ("torch.nn.", "torch_dwn.")
"""Packages of whose classes objects are read, as a `Record` of their attributes."""

SCALERS = ("sklearn.preprocessing._data.StandardScaler", "sklearn.preprocessing.data.StandardScaler")


def is_checkpoint(content: bytes) -> bool:
    """Whether a file is a checkpoint of PyTorch 1.6 or later."""
    if not content.startswith(b"PK\x03\x04"):
        return False
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            return _pickle_name(archive) is not None
    except (zipfile.BadZipFile, ValueError, NotImplementedError, OSError):
        return False


def read_checkpoint(content: bytes) -> Any:
    """The value that ``torch.save`` wrote: tensors are NumPy arrays, modules and other objects `Record`.

    Raises:
        ValueError: it is damaged, or asks for what no such checkpoint needs.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            name = _pickle_name(archive)
            if name is None:
                raise ValueError("the archive holds no data.pkl")
            reader = _Archive(archive, name.removesuffix("data.pkl"))
            return read_pickle(reader.read("data.pkl"), reader.lookup, reader.storage)
    except (zipfile.BadZipFile, NotImplementedError, EOFError, OSError, RuntimeError, zlib.error) as error:
        raise ValueError(f"the archive is damaged: {error}") from error


def _pickle_name(archive: zipfile.ZipFile) -> str | None:
    names = [name for name in archive.namelist() if name.endswith("/data.pkl") and name.count("/") == 1]
    return names[0] if len(names) == 1 else None


@dataclass(frozen=True, eq=False)
class _Storage:
    """Numbers of one kind, one after another: what a tensor is a view of."""

    content: NDArray[Any]


@dataclass(frozen=True)
class _Archive:
    """The archive, the folder in it that holds everything, and storages that were read already."""

    archive: zipfile.ZipFile
    folder: str
    storages: dict[tuple[str, str], _Storage] = field(default_factory=dict)

    def read(self, name: str) -> bytes:
        """A file of the archive.

        Raises:
            ValueError: it is missing, or compressed: PyTorch compresses none, and a small one could fill the
                memory.
        """
        try:
            entry = self.archive.getinfo(self.folder + name)
        except KeyError as error:
            raise ValueError(f"the archive holds no {name}") from error
        if entry.compress_type != zipfile.ZIP_STORED:
            raise ValueError(f"{name} is compressed, as no checkpoint is")
        return self.archive.read(entry)

    def lookup(self, name: str) -> StandIn | None:
        """What stands for the classes and functions that checkpoints name."""
        if name in _TENSORS:
            return _TENSORS[name]
        if name.startswith(MODULES) or name in SCALERS or name.endswith("Thermometer"):
            return record(name)
        return NUMPY.get(name)

    def storage(self, identifier: Any) -> _Storage:
        """The storage that a pickle refers to by ``("storage", kind, key, device, numbers)``."""
        if not isinstance(identifier, tuple) or len(identifier) != 5 or identifier[0] != "storage":
            raise UnreadablePickleError("it refers to something that is not a storage")
        _, kind, key, _, numbers = identifier
        if not isinstance(kind, StandIn) or not isinstance(key, str) or not isinstance(numbers, int):
            raise UnreadablePickleError("it refers to a damaged storage")
        name = STORAGES.get(kind.name.removeprefix("torch."))
        if name is None:
            raise UnreadablePickleError(f"it holds numbers of a kind that is not known, {kind.name[:40]}")
        if (name, key) not in self.storages:
            self.storages[name, key] = self._read_storage(name, key)
        found = self.storages[name, key]
        if len(found.content) != numbers:
            raise UnreadablePickleError(
                f"storage {key[:20]} holds {len(found.content)} numbers, not {numbers}"
            )
        return found

    def _read_storage(self, name: str, key: str) -> _Storage:
        dtype = np.dtype(self._order() + ("u2" if name == "bf16" else name))
        content = np.frombuffer(self.read(f"data/{key}"), dtype=dtype)
        if name == "bf16":
            content = (content.astype(np.uint32) << 16).view(np.float32)
        return _Storage(content)

    def _order(self) -> str:
        if self.folder + "byteorder" not in self.archive.namelist():
            return "<"  # written before PyTorch 2.1, always little
        order = self.read("byteorder")
        if order not in (b"little", b"big"):
            raise UnreadablePickleError("the order of its bytes is not known")
        return "<" if order == b"little" else ">"


def _tensor(storage: Any, offset: Any, shape: Any, strides: Any, *_: Any) -> NDArray[Any]:
    """The view of a storage that a tensor is; a copy of each could fill the memory."""
    whole = isinstance(shape, tuple) and isinstance(strides, tuple)
    if not whole or not all(type(n) is int and n >= 0 for n in (offset, *shape, *strides)):
        raise UnreadablePickleError("a tensor is damaged")
    if not isinstance(storage, _Storage) or len(shape) != len(strides):
        raise UnreadablePickleError("a tensor is not a view of a storage")
    content = storage.content
    size = int(np.prod(shape, dtype=object))
    last = offset + sum((n - 1) * stride for n, stride in zip(shape, strides, strict=True))
    if size and last >= len(content):
        raise UnreadablePickleError("a tensor goes beyond its storage")
    if size > len(content):
        raise UnreadablePickleError("a tensor repeats its storage")
    if not size:
        return np.empty(shape, dtype=content.dtype)
    step = content.dtype.itemsize
    return np.lib.stride_tricks.as_strided(content[offset:], shape, [step * stride for stride in strides])


def _parameter(data: Any, *_: Any) -> Any:
    return data


_TENSORS: dict[str, StandIn] = {
    stand_in.name: stand_in
    for stand_in in (
        StandIn("collections.OrderedDict", lambda *_: {}),
        StandIn("torch._utils._rebuild_tensor_v2", _tensor),
        StandIn("torch._utils._rebuild_parameter", _parameter),
        StandIn("torch.torch_version.TorchVersion", lambda text: str(text)),
        StandIn("torch.Size", lambda sizes: tuple(sizes)),
        StandIn("torch.device", lambda *_: None),
        StandIn("__builtin__.set", lambda *_: None),  # names of buffers that are not saved
        *(StandIn(f"torch.{name}", lambda *_: None) for name in STORAGES),
    )
}
"""What a checkpoint needs to hold tensors."""
