"""Build folders appear whole or not at all."""

import os
from pathlib import Path

import pytest

from wnn2hdl.build.folder import failure, staged
from wnn2hdl.emit import MANIFEST_NAME
from wnn2hdl.errors import InputError


def test_the_folder_appears_when_all_is_written(tmp_path: Path) -> None:
    with staged(tmp_path / "new" / "build") as staging:
        (staging / MANIFEST_NAME).write_text("{}")
        assert not (tmp_path / "new" / "build").exists()
    assert [path.name for path in (tmp_path / "new").iterdir()] == ["build"]


@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt])
def test_nothing_is_left_of_what_failed_and_the_earlier_build_stays(
    tmp_path: Path, error: type[BaseException]
) -> None:
    with staged(tmp_path / "build") as staging:
        (staging / MANIFEST_NAME).write_text("first")

    def fail() -> None:
        with staged(tmp_path / "build") as staging:
            (staging / MANIFEST_NAME).write_text("second")
            raise error

    with pytest.raises(error):
        fail()
    assert [path.name for path in tmp_path.iterdir()] == ["build"]
    assert (tmp_path / "build" / MANIFEST_NAME).read_text() == "first"


def test_an_earlier_build_is_replaced_whole(tmp_path: Path) -> None:
    for name in ("old", "new"):
        with staged(tmp_path / "build") as staging:
            (staging / MANIFEST_NAME).write_text(name)
            (staging / name).touch()
    assert {path.name for path in (tmp_path / "build").iterdir()} == {MANIFEST_NAME, "new"}


def test_what_is_no_build_is_not_touched(tmp_path: Path) -> None:
    (tmp_path / "photos").mkdir()
    (tmp_path / "photos" / "cat.png").touch()
    for target in (tmp_path / "photos", tmp_path / "photos" / "cat.png"):
        with pytest.raises(InputError, match="not an earlier build"), staged(target):
            pass
    assert (tmp_path / "photos" / "cat.png").exists()


def test_a_place_that_cannot_be_written_gets_one_line() -> None:
    with pytest.raises(InputError, match="cannot"), staged(Path("/proc/build")):
        pass


def test_the_reason_of_a_failure_is_one_line(tmp_path: Path) -> None:
    assert failure(tmp_path) is None
    (tmp_path / "FAILED").write_bytes(b"the pixel differs\nfor \xff\n")
    assert failure(tmp_path) == "the pixel differs for \N{REPLACEMENT CHARACTER}"
    (tmp_path / "FAILED").write_text("\n")
    assert failure(tmp_path) == "FAILED gives no reason"
    (tmp_path / "FAILED").unlink()
    (tmp_path / "FAILED").mkdir()
    assert failure(tmp_path) == "FAILED cannot be read (Is a directory)"


def test_a_folder_has_the_mode_that_the_user_asks_for(tmp_path: Path) -> None:
    before = os.umask(0o027)
    try:
        with staged(tmp_path / "build"):
            pass
    finally:
        os.umask(before)
    assert (tmp_path / "build").stat().st_mode & 0o777 == 0o750


def test_one_process_makes_a_build(tmp_path: Path) -> None:
    with staged(tmp_path / "build"):
        second = staged(tmp_path / "build")
        with pytest.raises(InputError, match="another process is writing this build"):
            second.__enter__()
        with staged(tmp_path / "build.2"):
            pass
    assert sorted(path.name for path in tmp_path.iterdir()) == ["build", "build.2"]


@pytest.mark.parametrize("moment", ["new", "earlier"])
def test_the_next_build_tidies_up_behind_a_killed_one(tmp_path: Path, moment: str) -> None:
    with staged(tmp_path / "build") as staging:
        (staging / MANIFEST_NAME).write_text("first")
    # Killed while it was writing, or between the two renames at the end.
    (tmp_path / ".build.new").mkdir()
    (tmp_path / ".build.new" / "half").touch()
    if moment == "earlier":
        (tmp_path / "build").rename(tmp_path / ".build.earlier")

    def fail() -> None:
        with staged(tmp_path / "build"):
            raise KeyError

    with pytest.raises(KeyError):
        fail()
    assert [path.name for path in tmp_path.iterdir()] == ["build"]
    assert (tmp_path / "build" / MANIFEST_NAME).read_text() == "first"


def test_what_someone_puts_there_meanwhile_stays(tmp_path: Path) -> None:
    def make() -> None:
        with staged(tmp_path / "build"):
            (tmp_path / "build").mkdir()
            (tmp_path / "build" / "photo.png").touch()

    with pytest.raises(InputError, match="not an earlier build"):
        make()
    assert (tmp_path / "build" / "photo.png").exists()


def test_links_are_followed_and_those_that_lead_nowhere_refused(tmp_path: Path) -> None:
    (tmp_path / "disk").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "disk" / "build")
    with staged(tmp_path / "link") as staging:
        (staging / MANIFEST_NAME).touch()
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "disk" / "build" / MANIFEST_NAME).exists()
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    with pytest.raises(InputError, match="a link that leads nowhere"), staged(tmp_path / "loop"):
        pass
