"""What is stored comes back, or nothing does."""

import hashlib
import json
import os
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from wnn2hdl.errors import InputError
from wnn2hdl.synth import cache

KEY = {"verilog": "a digest", "top": "gate"}


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(cache.FOLDER, str(tmp_path / "cache"))
    return tmp_path / "cache"


def forge(path: Path, text: str) -> None:
    """Write a file with a checksum that is right for its content, whatever that is."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"{hashlib.sha256(text.encode()).hexdigest()}\n{text}")


def test_what_is_stored_comes_back(folder: Path) -> None:
    assert cache.load("kind", KEY) is None
    cache.store("kind", KEY, {"x": [1, None, "ü"]})
    assert cache.load("kind", KEY) == {"x": [1, None, "ü"]}
    path = cache.location("kind", KEY)
    assert path.parent == folder / "kind"
    assert [file.name for file in path.parent.iterdir()] == [path.name]


def test_an_entry_says_what_it_was_made_from() -> None:
    cache.store("kind", KEY, {"luts": 12})
    _, text = cache.location("kind", KEY).read_text().split("\n")
    assert json.loads(text)["key"] == KEY


def test_every_part_of_the_key_counts_and_so_do_their_borders() -> None:
    keys: list[Mapping[str, str]] = [
        {"a": "1", "b": "2"},
        {"a": "2", "b": "1"},
        {"a": "12", "b": ""},
        {"a": "1"},
        {"a": "1", "b": "2", "c": ""},
    ]
    assert len({cache.location("kind", key) for key in keys}) == len(keys)
    assert cache.location("kind", {"b": "2", "a": "1"}) == cache.location("kind", keys[0])


def test_without_the_variable_it_lies_where_the_system_keeps_caches(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.delenv(cache.FOLDER)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert "wnn2hdl" in cache.location("kind", KEY).parts


def test_a_flipped_bit_anywhere_makes_it_nothing() -> None:
    cache.store("kind", KEY, {"luts": 12})
    path = cache.location("kind", KEY)
    whole = path.read_bytes()
    for position in range(len(whole)):
        damaged = bytearray(whole)
        damaged[position] ^= 1
        path.write_bytes(damaged)
        assert cache.load("kind", KEY) is None, position


def test_an_entry_cut_short_anywhere_is_nothing() -> None:
    cache.store("kind", KEY, {"luts": 12})
    path = cache.location("kind", KEY)
    whole = path.read_bytes()
    for length in range(len(whole)):
        path.write_bytes(whole[:length])
        assert cache.load("kind", KEY) is None, length


def test_an_entry_of_another_design_in_its_place_is_nothing() -> None:
    other = {**KEY, "top": "another"}
    cache.store("kind", other, {"luts": 12})
    cache.location("kind", other).rename(cache.location("kind", KEY))
    assert cache.load("kind", KEY) is None


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "[" * 100_000,
        "[]",
        "{}",
        '{"key": 1, "result": {}}',
        json.dumps({"key": KEY}),
        json.dumps({"key": KEY, "result": [12]}),
        json.dumps({"key": {**KEY, "more": "x"}, "result": {}}),
    ],
    ids=lambda text: text[:30] or "empty",
)
def test_a_forged_checksum_alone_opens_nothing(text: str) -> None:
    forge(cache.location("kind", KEY), text)
    assert cache.load("kind", KEY) is None


@pytest.mark.parametrize("content", [b"", b"\xff\xfe", b"{}", b"{}\n{}"])
def test_something_else_in_its_place_is_nothing_and_is_replaced(content: bytes) -> None:
    path = cache.location("kind", KEY)
    path.parent.mkdir(parents=True)
    path.write_bytes(content)
    assert cache.load("kind", KEY) is None
    cache.store("kind", KEY, {"luts": 12})
    assert cache.load("kind", KEY) == {"luts": 12}


def test_a_folder_or_a_pipe_in_its_place_is_nothing() -> None:
    path = cache.location("kind", KEY)
    path.mkdir(parents=True)
    assert cache.load("kind", KEY) is None
    cache.store("kind", KEY, {"luts": 12})
    path.rmdir()
    os.mkfifo(path)
    assert cache.load("kind", KEY) is None


def test_a_folder_that_cannot_be_written_keeps_nothing(folder: Path) -> None:
    folder.write_text("a file where the folder should be")
    cache.store("kind", KEY, {"luts": 12})
    assert cache.load("kind", KEY) is None


def test_a_full_disk_keeps_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    def full(path: Path, text: str) -> None:
        raise InputError("cannot write", value=f"{path} (No space left on device)")

    monkeypatch.setattr(cache, "write_text", full)
    cache.store("kind", KEY, {"luts": 12})
    assert cache.load("kind", KEY) is None


def test_many_writers_at_once_never_show_half_an_entry() -> None:
    result = {"netlist": "wire w;\n" * 20_000}
    cache.store("kind", KEY, result)

    def both(_: int) -> bool:
        cache.store("kind", KEY, result)
        return cache.load("kind", KEY) == result

    with ThreadPoolExecutor(4) as pool:
        assert all(pool.map(both, range(40)))
    assert len(list(cache.location("kind", KEY).parent.iterdir())) == 1
