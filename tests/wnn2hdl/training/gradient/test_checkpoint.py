"""A state on disk: whole, of the same training, or not there."""

from pathlib import Path

import numpy as np

from wnn2hdl.training.gradient.checkpoint import Checkpoint


def test_a_state_comes_back_to_the_same_training_alone(tmp_path: Path) -> None:
    path = tmp_path / "state"
    checkpoint = Checkpoint(path, {"seed": 0})
    assert checkpoint.read() is None
    checkpoint.write({"a": np.arange(3), "b": np.array(0.5)})
    checkpoint.write({"a": np.arange(4), "b": np.array(0.25)})
    found = Checkpoint(path, {"seed": 0}).read()
    assert found is not None
    assert (found["a"].tolist(), float(found["b"]), sorted(found)) == ([0, 1, 2, 3], 0.25, ["a", "b"])
    assert Checkpoint(path, {"seed": 1}).read() is None
    checkpoint.remove()
    checkpoint.remove()
    assert not path.exists()


def test_a_damaged_state_is_none(tmp_path: Path) -> None:
    path = tmp_path / "state"
    checkpoint = Checkpoint(path, {})
    checkpoint.write({"a": np.arange(300)})
    whole = path.read_bytes()
    for damaged in (b"", b"not an archive", whole[:-40], whole[: len(whole) // 2]):
        path.write_bytes(damaged)
        assert checkpoint.read() is None
    changed = bytearray(whole)
    changed[len(whole) // 2] ^= 0xFF
    path.write_bytes(bytes(changed))
    assert checkpoint.read() is None
