"""Writers of other tools' files: what `torch.save` does, without PyTorch."""

import io
import pickle
import sys
import zipfile
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

Classes = Callable[..., dict[str, type]]
Save = Callable[..., Path]


@pytest.fixture
def named_classes(monkeypatch: pytest.MonkeyPatch) -> Classes:
    """``named_classes("a.b.C", …)`` makes empty classes that are pickled by these names."""

    def make(*names: str) -> dict[str, type]:
        made = {}
        for name in names:
            module, _, own = name.rpartition(".")
            made[name] = type(own, (), {"__module__": module})
            for end in [index for index, letter in enumerate(f"{module}.") if letter == "."]:
                if module[:end] not in sys.modules:
                    monkeypatch.setitem(sys.modules, module[:end], ModuleType(module[:end]))
            monkeypatch.setattr(sys.modules[module], own, made[name], raising=False)
        return made

    return make


@dataclass
class Storage:
    """The numbers of a tensor, one after another."""

    content: NDArray[Any]


@pytest.fixture
def save_checkpoint(named_classes: Classes, monkeypatch: pytest.MonkeyPatch) -> Save:
    """``save_checkpoint(path, value, …)`` writes what ``torch.save`` would, with arrays as tensors."""
    storages = {
        "f": "FloatStorage",
        "d": "DoubleStorage",
        "i": "IntStorage",
        "l": "LongStorage",
        "e": "HalfStorage",
    }
    kinds = named_classes(*(f"torch.{name}" for name in storages.values()))
    utils = ModuleType("torch._utils")
    monkeypatch.setitem(sys.modules, "torch._utils", utils)

    def _rebuild_tensor_v2(*_: Any) -> None:
        raise AssertionError("nothing in a checkpoint may be called")

    _rebuild_tensor_v2.__module__ = "torch._utils"
    monkeypatch.setattr(utils, "_rebuild_tensor_v2", _rebuild_tensor_v2, raising=False)
    _rebuild_tensor_v2.__qualname__ = "_rebuild_tensor_v2"

    def save(path: Path, value: Any, *, order: str = "<", compression: int = zipfile.ZIP_STORED) -> Path:
        written: list[NDArray[Any]] = []

        class Pickler(pickle.Pickler):
            def persistent_id(self, thing: Any) -> Any:
                if not isinstance(thing, Storage):
                    return None
                written.append(thing.content)
                kind = kinds[f"torch.{storages[thing.content.dtype.char]}"]
                return ("storage", kind, str(len(written) - 1), "cpu", thing.content.size)

            def reducer_override(self, thing: Any) -> Any:
                if not isinstance(thing, np.ndarray):
                    return NotImplemented
                compact = np.array(thing, order="K")
                strides = tuple(stride // thing.itemsize for stride in compact.strides)
                storage = Storage(np.ravel(compact, order="K"))
                return _rebuild_tensor_v2, (storage, 0, thing.shape, strides, False, OrderedDict())

        content = io.BytesIO()
        Pickler(content, protocol=2).dump(value)
        with zipfile.ZipFile(path, "w", compression) as archive:
            archive.writestr("archive/data.pkl", content.getvalue())
            archive.writestr("archive/byteorder", "little" if order == "<" else "big")
            for key, storage in enumerate(written):
                big = storage.astype(storage.dtype.newbyteorder(">"))
                archive.writestr(f"archive/data/{key}", (storage if order == "<" else big).tobytes())
        return path

    return save
