"""Finished windows survive whatever happens to the process."""

import re
from pathlib import Path

import pytest

from wnn2hdl.apps.deforestation.classify import WindowResult
from wnn2hdl.apps.deforestation.journal import Journal
from wnn2hdl.errors import InputError

RESULTS = [
    WindowResult(index, bytes([index]) * (10 + index), valid=100 + index, covered=50 + index)
    for index in range(5)
]
IDENTITY = {"picture": "a.tif", "size": 7}


@pytest.fixture
def path(tmp_path: Path) -> Path:
    with Journal(tmp_path / "windows", IDENTITY) as journal:
        for result in RESULTS[::-1]:
            journal.append(result)
    return tmp_path / "windows"


def test_windows_are_there_when_it_is_opened_again(path: Path) -> None:
    with Journal(path, IDENTITY) as journal:
        assert len(journal) == 5
        assert [journal.packed(index) for index in range(5)] == [x.packed for x in RESULTS]
        assert (journal.valid, journal.covered) == (510, 260)
        assert 5 not in journal


def test_what_was_cut_off_anywhere_is_missing_again(path: Path) -> None:
    content = path.read_bytes()
    start = content.index(b"\n") + 1
    for end in range(start, len(content)):
        path.write_bytes(content[:end])
        with Journal(path, IDENTITY) as journal:
            kept = len(journal)
            assert kept < 5
            assert all(journal.packed(4 - x) == RESULTS[4 - x].packed for x in range(kept))
            for result in RESULTS:
                if result.index not in journal:
                    journal.append(result)
        with Journal(path, IDENTITY) as journal:
            assert len(journal) == 5


def test_a_damaged_window_and_what_follows_is_missing(path: Path) -> None:
    content = bytearray(path.read_bytes())
    content[-1] ^= 1
    path.write_bytes(content)
    with Journal(path, IDENTITY) as journal:
        assert len(journal) == 4
        assert 0 not in journal


def test_windows_of_another_scan_are_dropped(path: Path) -> None:
    with Journal(path, IDENTITY | {"size": 8}) as journal:
        assert len(journal) == 0
    with Journal(path, IDENTITY) as journal:
        assert len(journal) == 0


def test_two_scans_into_one_folder_are_refused(path: Path) -> None:
    with Journal(path, IDENTITY), pytest.raises(InputError, match="another scan is writing"):
        Journal(path, IDENTITY)


def test_a_folder_that_is_not_there_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=re.escape("No such file")):
        Journal(tmp_path / "none" / "windows", IDENTITY)
