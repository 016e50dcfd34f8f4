import os
import resource
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from wnn2hdl import files
from wnn2hdl.errors import InputError, ModelFileError


def test_the_same_data_give_the_same_bytes(tmp_path: Path) -> None:
    path = tmp_path / "x.json"
    files.write_json(path, {"b": 1, "a": ["é"]})
    assert path.read_bytes() == '{\n "b": 1,\n "a": [\n  "é"\n ]\n}\n'.encode()
    assert files.read_json(path, "a thing") == {"b": 1, "a": ["é"]}


def test_writing_over_a_file_leaves_nothing_else_behind(tmp_path: Path) -> None:
    path = tmp_path / "x.txt"
    files.write_text(path, "old")
    files.write_text(path, "new")
    assert path.read_text() == "new"
    assert list(tmp_path.iterdir()) == [path]


def test_a_new_file_has_the_permissions_that_the_umask_leaves(tmp_path: Path) -> None:
    before = os.umask(0o027)
    try:
        files.write_text(tmp_path / "x.txt", "")
        assert (tmp_path / "x.txt").stat().st_mode & 0o777 == 0o640
    finally:
        assert os.umask(before) == 0o027


def test_a_failed_write_keeps_the_old_file_and_no_scraps(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "x.txt"
    files.write_text(path, "old")

    def interrupt(*args: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, "replace", interrupt)
    with pytest.raises(KeyboardInterrupt):
        files.write_text(path, "new")
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"cannot write: .*No such file.*; choose a folder"):
        files.write_text(tmp_path / "no" / "x.txt", "")


def test_a_file_where_a_folder_is_gets_one_line(tmp_path: Path) -> None:
    (tmp_path / "x.txt").mkdir()
    with pytest.raises(InputError, match=r"cannot write: .*x\.txt \(Is a directory\); choose"):
        files.write_text(tmp_path / "x.txt", "")
    assert [path.name for path in tmp_path.iterdir()] == ["x.txt"]


def test_a_disk_without_room_gets_one_line_and_keeps_the_old_file(tmp_path: Path) -> None:
    path = tmp_path / "x.txt"
    files.write_text(path, "old")
    limit = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, limit[1]))
    try:
        with pytest.raises(InputError, match=r"cannot write: .*x\.txt \(File too large\)"):
            files.write_bytes(path, bytes(2000))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limit)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_text_that_is_no_unicode_gets_one_line(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"cannot write this as UTF-8: '\\udcff' in .*x\.json; rename"):
        files.write_json(tmp_path / "x.json", {"name": "a\udcff"})
    assert list(tmp_path.iterdir()) == []


def test_numbers_that_json_does_not_know_are_not_written(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="not JSON compliant"):
        files.write_json(tmp_path / "x.json", {"a": float("nan")})


def test_make_folder_makes_parents_and_minds_files(tmp_path: Path) -> None:
    files.make_folder(tmp_path / "a" / "b")
    files.make_folder(tmp_path / "a" / "b")
    assert (tmp_path / "a" / "b").is_dir()
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match="cannot make the folder"):
        files.make_folder(tmp_path / "file")


@pytest.mark.parametrize(
    ("content", "line"),
    [
        (None, "cannot read a model"),
        (b"", "not a model, or a damaged one"),
        (b'{"format":', "not a model, or a damaged one"),
        (b"\xff\xfe\x00", "not a model, or a damaged one"),
        (b"[" * 100_000, "not a model, or a damaged one"),
        (b"[1, 2]", r"not a model: .* \(holds a JSON list\)"),
        (b'{"a": NaN}', r"a damaged one: .* \(NaN is not a finite number\)"),
        (b'{"a": [-Infinity]}', r"a damaged one: .* \(-Infinity is not a finite number\)"),
        (b'{"a": 1e999}', r"a damaged one: .* \(1e999 is not a finite number\)"),
        (b'{"a": "\\ud800"}', r"a damaged one: .*surrogates not allowed"),
    ],
)
def test_what_is_no_json_object_gets_one_line(tmp_path: Path, content: bytes | None, line: str) -> None:
    path = tmp_path / "x.json"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(ModelFileError, match=line) as caught:
        files.read_json(path, "a model")
    assert "\n" not in str(caught.value)
    assert str(path) in str(caught.value)


def test_a_whole_surrogate_pair_is_a_letter(tmp_path: Path) -> None:
    path = tmp_path / "x.json"
    path.write_text('{"a": "\\ud83c\\udf33", "b": -1.5e3}')
    assert files.read_json(path, "a model") == {"a": "\U0001f333", "b": -1500.0}


def test_a_number_too_long_for_python_gets_one_line(tmp_path: Path) -> None:
    path = tmp_path / "x.json"
    path.write_text('{"a": ' + "9" * 5000 + "}")
    with pytest.raises(ModelFileError, match="not a model, or a damaged one"):
        files.read_json(path, "a model")


def test_a_folder_is_written_into_by_one_process_at_a_time(tmp_path: Path) -> None:
    with (
        files.output_folder(tmp_path / "out", "scan"),
        pytest.raises(
            InputError, match=r"another process is writing into the folder of this sweep: .*out; wait"
        ),
        files.output_folder(tmp_path / "out", "sweep"),
    ):
        raise AssertionError
    with files.output_folder(tmp_path / "out", "scan"):
        assert [path.name for path in (tmp_path / "out").iterdir()] == [files.LOCK_FILE]


def test_the_lock_of_a_killed_process_is_none_and_what_it_left_goes(tmp_path: Path) -> None:
    program = (
        "import os, signal, sys; from pathlib import Path; from wnn2hdl.files import output_folder\n"
        "with output_folder(Path(sys.argv[1]), 'scan'): os.kill(os.getpid(), signal.SIGKILL)"
    )
    killed = subprocess.run([sys.executable, "-c", program, tmp_path], check=False)
    assert killed.returncode == -signal.SIGKILL
    (tmp_path / ".summary.json.x1.part").touch()
    (tmp_path / "mine.part").touch()
    assert (tmp_path / files.LOCK_FILE).exists()
    with files.output_folder(tmp_path, "scan"):
        pass
    assert [path.name for path in tmp_path.iterdir()] == ["mine.part"]


def test_lines_are_written_all_or_not_at_all(tmp_path: Path) -> None:
    def cut_short() -> Iterator[str]:
        yield "a\n"
        raise KeyboardInterrupt

    files.write_lines(tmp_path / "x.txt", ["a\n", "é\n"])
    with pytest.raises(KeyboardInterrupt):
        files.write_lines(tmp_path / "x.txt", cut_short())
    assert (tmp_path / "x.txt").read_text(encoding="utf-8") == "a\né\n"
    assert [path.name for path in tmp_path.iterdir()] == ["x.txt"]
    with pytest.raises(InputError, match=r"cannot write: .*No such file"):
        files.write_lines(tmp_path / "none" / "x.txt", [])


def test_a_name_that_fits_the_file_system_can_be_written(tmp_path: Path) -> None:
    path = tmp_path / ("a" * 255)
    files.write_text(path, "x")
    assert path.read_text() == "x"


def test_a_new_folder_goes_again_if_nothing_came_of_it(tmp_path: Path) -> None:
    def fail(folder: Path, *names: str) -> None:
        with files.output_folder(folder, "scan"):
            for name in names:
                (folder / name).touch()
            raise InputError("bad input")

    (tmp_path / "old").mkdir()
    for folder in ("old", "new"):
        with pytest.raises(InputError, match="bad input"):
            fail(tmp_path / folder)
    assert [path.name for path in tmp_path.iterdir()] == ["old"]
    with pytest.raises(InputError, match="bad input"):
        fail(tmp_path / "new", "finished")
    assert (tmp_path / "new" / "finished").exists()


def test_a_key_that_stands_twice_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "model.json"
    path.write_text('{"a": {"rams": 1, "rams": 2}}')
    with pytest.raises(ModelFileError, match="the key 'rams' stands in one object twice"):
        files.read_json(path, "a model")


def test_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "model.json")
    with pytest.raises(ModelFileError, match=r"cannot read a model: .*it is a pipe"):
        files.read_json(tmp_path / "model.json", "a model")


def test_the_file_that_a_link_leads_to_is_replaced(tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "folder" / "file")
    files.write_text(tmp_path / "link", "text")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "folder" / "file").read_text() == "text"


def test_a_device_is_not_replaced(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for path in (Path("/dev/null"), tmp_path / "pipe"):
        with pytest.raises(InputError, match=r"cannot write: .* \(it is a device or a pipe\)"):
            files.write_text(path, "text")
    assert Path("/dev/null").is_char_device()
    assert (tmp_path / "pipe").is_fifo()


def test_what_is_made_has_one_maker(tmp_path: Path) -> None:
    place = tmp_path / "model.json"
    with files.held(place, "model"), files.held(tmp_path / "other.json", "model"):
        second = files.held(place, "model")
        with pytest.raises(InputError, match=r"another process is writing this model: .*model.json; wait"):
            second.__enter__()
    with files.held(place, "model"):
        pass
    assert not [*tmp_path.iterdir()]


def test_the_longest_names_are_held_too(tmp_path: Path) -> None:
    with files.held(tmp_path / ("x" * 255), "model"):
        pass
    with pytest.raises(InputError, match="cannot write"), files.held(tmp_path / "none" / "x", "model"):
        pass
