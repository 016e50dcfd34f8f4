"""The benchmark judges on rows that were not trained on, and says what was lost."""

import sys
from pathlib import Path

import numpy as np
import pytest

from benchmarks import published


@pytest.fixture
def data(tmp_path: Path) -> Path:
    """A folder with an iris.csv: its three classes lie apart in one feature, and the other is the row."""
    rng = np.random.default_rng(0)
    owners = rng.integers(0, 3, 240)
    rows = [f"{owner + rng.random() / 2},{i},{'abc'[owner]}\n" for i, owner in enumerate(owners)]
    (tmp_path / "uci").mkdir()
    (tmp_path / "uci" / "iris.csv").write_text("x,row,label\n" + "".join(rows))
    return tmp_path


def test_test_rows_are_others_than_those_trained_on_and_scaled_alike(data: Path) -> None:
    case = published.load(data, "iris", seed=1)
    assert case.words == published.BYTE
    assert (case.features.min(), case.features.max()) == (0, 255)
    assert len(case.features) + len(case.test_features) == 240
    assert 75 <= len(case.test_features) <= 80
    rows = np.concatenate([case.features[:, 1], case.test_features[:, 1]])
    assert len(np.unique(rows.round(6))) == 240
    other = published.load(data, "iris", seed=2)
    assert not np.array_equal(other.test_features[:, 1], case.test_features[:, 1])


@pytest.mark.slow
def test_a_row_is_trained_counted_and_judged(
    data: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(published.ROWS, "iris", published.Row("iris", 90.0, 40, "nobody: 90.0", 3, 6))
    monkeypatch.setitem(published.ROWS, "wine", published.Row("iris", 90.0, 2, "nobody: 90.0", 3, 6))
    words = ["published.py", str(data), "--rows", "iris", "wine", "--seeds", "1"]
    monkeypatch.setattr(sys, "argv", words)
    published.main()
    fits, too_small = capsys.readouterr().out.splitlines()[-2:]
    cells = [cell.strip() for cell in fits.split("|")]
    assert (cells[1], cells[6], cells[7]) == ("iris", "won", "nobody: 90.0")
    assert 6 <= int(cells[4]) <= 40
    assert "no network of 3 classes fits: 2 LUTs" in too_small
    assert "| lost |" in too_small
