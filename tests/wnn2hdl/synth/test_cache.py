"""What is stored comes back, or nothing does."""

from pathlib import Path

import pytest

from wnn2hdl.synth import cache


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(cache.FOLDER, str(tmp_path / "cache"))
    return tmp_path / "cache"


def test_what_is_stored_comes_back(folder: Path) -> None:
    path = cache.entry("kind", ["a", "b"])
    assert cache.load(path) is None
    cache.store(path, {"x": [1, None, "ü"]})
    assert cache.load(path) == {"x": [1, None, "ü"]}
    assert path.parent == folder / "kind"
    assert [file.name for file in path.parent.iterdir()] == [path.name]


def test_every_ingredient_counts_and_so_do_their_borders() -> None:
    makings = [["a", "b"], ["b", "a"], ["ab"], ["a", "b", ""], ["", "a", "b"]]
    assert len({cache.entry("kind", making) for making in makings}) == len(makings)


def test_without_the_variable_it_lies_where_the_system_keeps_caches(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.delenv(cache.FOLDER)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert "wnn2hdl" in cache.entry("kind", ["a"]).parts


@pytest.mark.parametrize("position", [0, 40, 64, 70, -1])
def test_a_flipped_bit_anywhere_makes_it_nothing(position: int) -> None:
    path = cache.entry("kind", ["a"])
    cache.store(path, {"luts": 12})
    damaged = bytearray(path.read_bytes())
    damaged[position] ^= 1
    path.write_bytes(damaged)
    assert cache.load(path) is None


@pytest.mark.parametrize("content", [b"", b"\xff\xfe", b"{}", b"{}\n{}"])
def test_something_else_in_its_place_is_nothing(content: bytes) -> None:
    path = cache.entry("kind", ["a"])
    cache.store(path, {})
    path.write_bytes(content)
    assert cache.load(path) is None


def test_a_folder_that_cannot_be_written_keeps_nothing(folder: Path) -> None:
    folder.write_text("a file where the folder should be")
    path = cache.entry("kind", ["a"])
    cache.store(path, {"luts": 12})
    assert cache.load(path) is None
