"""Build folders appear whole or not at all."""

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
        with pytest.raises(InputError, match="no earlier build"), staged(target):
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
