"""Finished work survives whatever happens to the process."""

import re
import resource
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.errors import InputError
from wnn2hdl.journal import Journal

IDENTITY = {"picture": "a\n.tif", "size": 7}
CONTENTS = [b"", b"\n", b"00000000 5\nabcde\n", bytes(range(256)), b"last"]


def contents(path: Path, identity: dict[str, object] = IDENTITY) -> list[bytes]:
    with Journal(path, identity) as journal:
        return [content for _, content in journal]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    with Journal(tmp_path / "journal", IDENTITY) as journal:
        for content in CONTENTS:
            journal.append(content)
    return tmp_path / "journal"


def test_records_are_there_when_it_is_opened_again(path: Path) -> None:
    with Journal(path, IDENTITY) as journal:
        assert [journal.read(place) for place, _ in journal] == CONTENTS
        place = journal.append(b"more")
        assert journal.read(place) == b"more"
    assert contents(path) == [*CONTENTS, b"more"]


def test_what_was_cut_off_anywhere_is_missing_and_is_written_again(path: Path) -> None:
    whole = path.read_bytes()
    for end in range(len(whole)):
        path.write_bytes(whole[:end])
        with Journal(path, IDENTITY) as journal:
            kept = [content for _, content in journal]
            assert kept == CONTENTS[: len(kept)]
            assert len(kept) < len(CONTENTS)
            assert path.read_bytes() == whole[:end], "reading changes nothing"
            for content in CONTENTS[len(kept) :]:
                journal.append(content)
        assert path.read_bytes() == whole


def test_no_flipped_bit_is_taken_for_a_record(path: Path) -> None:
    whole = path.read_bytes()
    for place in range(len(whole)):
        damaged = bytearray(whole)
        damaged[place] ^= 4
        path.write_bytes(damaged)
        kept = contents(path)
        assert kept == CONTENTS[: len(kept)]
        assert len(kept) < len(CONTENTS)


def test_records_of_another_identity_are_none(path: Path) -> None:
    other = IDENTITY | {"size": 8}
    assert contents(path, other) == []
    assert contents(path) == CONTENTS, "reading changes nothing"
    with Journal(path, other) as journal:
        journal.append(b"x")
    assert contents(path) == []
    assert contents(path, other) == [b"x"]


def test_nothing_appended_makes_no_file(tmp_path: Path) -> None:
    assert contents(tmp_path / "none") == []
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_is_one_line_and_keeps_what_is_there(path: Path) -> None:
    limit = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (path.stat().st_size + 10, limit[1]))
    try:
        with Journal(path, IDENTITY) as journal, pytest.raises(InputError, match=r"File too large.*kept"):
            journal.append(bytes(100))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limit)
    assert contents(path) == CONTENTS


def test_a_folder_that_is_not_there_is_one_line(tmp_path: Path) -> None:
    journal = Journal(tmp_path / "none" / "journal", IDENTITY)
    with pytest.raises(InputError, match=re.escape("No such file")):
        journal.append(b"")


@given(st.lists(st.binary(max_size=60)))
def test_any_contents_come_back(tmp_path_factory: pytest.TempPathFactory, some: list[bytes]) -> None:
    path = tmp_path_factory.mktemp("any") / "journal"
    with Journal(path, IDENTITY) as journal:
        places = [journal.append(content) for content in some]
        assert [journal.read(place) for place in places] == some
    assert contents(path) == some
