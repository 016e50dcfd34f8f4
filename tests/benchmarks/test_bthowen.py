"""The benchmark of BTHOWeN's models tests on rows that it keeps from training."""

from pathlib import Path

import numpy as np
import pytest

from benchmarks import bthowen


@pytest.fixture
def data(tmp_path: Path) -> Path:
    """A folder with an iris.csv of 90 rows, numbered in their one feature."""
    (tmp_path / "uci").mkdir()
    rows = "".join(f"{number},{'abc'[number % 3]}\n" for number in range(90))
    (tmp_path / "uci" / "iris.csv").write_text("x,label\n" + rows)
    return tmp_path


def test_a_third_of_the_rows_is_tested_on_as_bthowen_draws_it(data: Path) -> None:
    training, test = bthowen.rows_of(data, "iris")
    assert len(training.labels) == 90
    assert test.features[:, 0].tolist() == np.random.RandomState(123).permutation(90)[:30].tolist()
    assert test.labels == tuple("abc"[int(number) % 3] for number in test.features[:, 0])


@pytest.mark.realdata
def test_a_model_that_is_too_large_is_said_to_be(realdata: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _, test = bthowen.rows_of(realdata, "mnist_medium")
    monkeypatch.setattr(bthowen, "rows_of", lambda *_: (test, test))
    found = bthowen.measure(realdata, "mnist_medium", 0)
    assert found["reads"] == "bits"
    assert "about 61,555 of the 53,200" in found["refused"]
