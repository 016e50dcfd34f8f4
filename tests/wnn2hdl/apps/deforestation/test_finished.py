"""Finished windows survive whatever happens to the process."""

from pathlib import Path

from wnn2hdl.apps.deforestation.classify import WindowResult
from wnn2hdl.apps.deforestation.finished import FinishedWindows

RESULTS = [
    WindowResult(index, bytes([index]) * (10 + index), valid=100 + index, covered=50 + index)
    for index in range(5)
]
IDENTITY = {"picture": "a.tif", "size": 7}


def test_windows_are_there_when_they_are_opened_again(tmp_path: Path) -> None:
    for results in (RESULTS[:1:-1], RESULTS[:2]):
        with FinishedWindows(tmp_path / "windows", IDENTITY) as kept:
            for result in results:
                assert result.index not in kept
                kept.append(result)
                assert kept.packed(result.index) == result.packed
    with FinishedWindows(tmp_path / "windows", IDENTITY) as kept:
        assert len(kept) == 5
        assert [kept.packed(index) for index in range(5)] == [x.packed for x in RESULTS]
        assert (kept.valid, kept.covered) == (510, 260)
        assert 5 not in kept


def test_windows_of_another_scan_are_none(tmp_path: Path) -> None:
    with FinishedWindows(tmp_path / "windows", IDENTITY) as kept:
        kept.append(RESULTS[0])
    with FinishedWindows(tmp_path / "windows", IDENTITY | {"size": 8}) as kept:
        assert len(kept) == 0
        assert (kept.valid, kept.covered) == (0, 0)
