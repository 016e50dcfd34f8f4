import io
import os
import pickle
import zipfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from wnn2hdl.importers.checkpoints import is_checkpoint, read_checkpoint
from wnn2hdl.importers.pickles import UnreadablePickleError

Save = Callable[..., Path]


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("kind", ["f4", "f8", "f2", "i4", "i8"])
def test_tensors_have_their_type_shape_and_order_of_bytes(
    save_checkpoint: Save, tmp_path: Path, kind: str, order: str
) -> None:
    array = np.arange(24).reshape(2, 3, 4).astype(kind)
    path = save_checkpoint(tmp_path / "a.pt", {"a": array, "none": array[:0]}, order=order)
    assert is_checkpoint(path.read_bytes())
    found = read_checkpoint(path.read_bytes())
    assert found["a"].dtype == np.dtype(order + kind)
    assert np.array_equal(found["a"], array)
    assert found["none"].shape == (0, 3, 4)


def test_the_strides_of_a_transposed_tensor_are_honoured(save_checkpoint: Save, tmp_path: Path) -> None:
    array = np.arange(6, dtype=np.float32).reshape(2, 3).T
    assert np.array_equal(read_checkpoint(save_checkpoint(tmp_path / "a.pt", array).read_bytes()), array)


def archive(content: bytes, **files: bytes) -> bytes:
    """A checkpoint of a pickle and other files."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as written:
        written.writestr("archive/data.pkl", content)
        for name, data in files.items():
            written.writestr(f"archive/{name.replace('_', '/')}", data)
    return stream.getvalue()


class Evil:
    def __reduce__(self) -> Any:
        return os.system, ("true",)


def test_a_malicious_checkpoint_is_refused() -> None:
    with pytest.raises(UnreadablePickleError, match=r"it asks for posix\.system, which no such model needs"):
        read_checkpoint(archive(pickle.dumps({"state_dict": Evil()}, 2)))


def tensor(offset: bytes, shape: bytes, strides: bytes, numbers: int = 4) -> bytes:
    """A pickle of a tensor of bytes, from the instructions for its offset, shape and strides."""
    storage = (
        b"(X\x07\x00\x00\x00storagectorch\nByteStorage\nX\x01\x00\x00\x000X\x03\x00\x00\x00cpuK"
        + bytes([numbers])
        + b"tQ"
    )
    return b"\x80\x02ctorch._utils\n_rebuild_tensor_v2\n(" + storage + offset + shape + strides + b"\x89}tR."


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (tensor(b"K\0", b"K\2\x85", b"K\4\x85"), "beyond its storage"),
        (tensor(b"K\4", b"K\1\x85", b"K\1\x85"), "beyond its storage"),
        (tensor(b"K\0", b"K\xff\x85", b"K\0\x85"), "repeats its storage"),
        (tensor(b"K\0", b"J\xff\xff\xff\xff\x85", b"K\1\x85"), "a tensor is damaged"),
        (tensor(b"K\0", b"K\2\x85", b")"), "not a view of a storage"),
        (tensor(b"K\0", b"K\4\x85", b"K\1\x85", numbers=5), "holds 4 numbers, not 5"),
    ],
)
def test_a_tensor_that_is_no_view_of_its_storage(content: bytes, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        read_checkpoint(archive(content, data_0=b"\1\2\3\4"))


def test_a_missing_storage() -> None:
    content = tensor(b"K\0", b"K\4\x85", b"K\1\x85")
    with pytest.raises(ValueError, match="holds no data/0"):
        read_checkpoint(archive(content))
    assert read_checkpoint(archive(content, data_0=b"\1\2\3\4")).tolist() == [1, 2, 3, 4]


def test_a_zip_bomb_is_refused_before_it_is_unpacked(save_checkpoint: Save, tmp_path: Path) -> None:
    path = save_checkpoint(tmp_path / "a.pt", np.zeros(1 << 20), compression=zipfile.ZIP_DEFLATED)
    assert path.stat().st_size < 1 << 16
    with pytest.raises(ValueError, match="is compressed, as no checkpoint is"):
        read_checkpoint(path.read_bytes())


@pytest.mark.parametrize("content", [b"", b"PK\3\4", b"PK\3\4" + bytes(100), b"\x80\x02}."])
def test_other_files_are_no_checkpoints(content: bytes) -> None:
    assert not is_checkpoint(content)
    with pytest.raises(ValueError, match="damaged"):
        read_checkpoint(content)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=200)
@given(st.data())
def test_any_changed_byte_gives_a_value_or_one_error(
    save_checkpoint: Save, tmp_path: Path, data: st.DataObject
) -> None:
    content = bytearray(save_checkpoint(tmp_path / "a.pt", {"a": np.arange(3.0)}).read_bytes())
    for _ in range(data.draw(st.integers(1, 3))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    cut = data.draw(st.none() | st.integers(0, len(content)))
    with suppress(ValueError):
        read_checkpoint(bytes(content[:cut]))
