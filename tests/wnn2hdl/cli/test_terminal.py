"""Whatever the encoding, a text is printed, and the exit status is the one that was meant."""

import io
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.cli import main
from wnn2hdl.cli.commands import COMMANDS
from wnn2hdl.cli.terminal import accept_any_text, say

NARROW = ["ascii", "cp1252", "latin-1", "cp437"]


def printed(text: str, encoding: str) -> str:
    """What arrives on a terminal of an encoding."""
    stream = io.TextIOWrapper(io.BytesIO(), encoding=encoding)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "stdout", stream)
        accept_any_text()
        say(text)
    return stream.buffer.getvalue().decode(encoding)


@given(st.text(), st.sampled_from([*NARROW, "utf-8"]))
def test_every_text_can_be_printed(text: str, encoding: str) -> None:
    assert printed(text, encoding).endswith("\n")


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_where_all_can_be_printed_nothing_changes(encoding: str) -> None:
    assert printed("✓ 5 µs ± 3 é", encoding) == "✓ 5 µs ± 3 é\n"


@pytest.mark.parametrize(
    ("encoding", "shown"),
    [
        ("ascii", "[ok] 5 us +/- 3, \\xe9 \\u6f22"),
        ("latin-1", "[ok] 5 µs ± 3, é \\u6f22"),
        ("cp1252", "[ok] 5 µs ± 3, é \\u6f22"),
    ],
)
def test_signs_become_ascii_and_letters_their_escapes(encoding: str, shown: str) -> None:
    assert printed("✓ 5 µs ± 3, é 漢", encoding) == f"{shown}\n"


def test_half_a_character_of_a_file_s_name_is_no_obstacle() -> None:
    assert printed("a\udcff.png", "utf-8") == "a\\udcff.png\n"


@pytest.mark.parametrize("encoding", NARROW)
@pytest.mark.parametrize("form", ["html", "markdown", "json", "junit"])
def test_a_gate_says_no_in_every_encoding(
    form: str,
    encoding: str,
    write_build: Callable[..., Path],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    build = write_build(tmp_path / "é漢")
    stdout = io.TextIOWrapper(io.BytesIO(), encoding=encoding)
    monkeypatch.setattr(sys, "stdout", stdout)
    monkeypatch.setattr(sys, "argv", ["wnn2hdl", "report", str(build), "--max-luts", "1", "--format", form])
    assert main() == 1
    text = stdout.buffer.getvalue()
    if form == "junit":
        assert ET.fromstring(text).find("testsuite").attrib["name"] == "é漢"  # type: ignore[union-attr]
    else:
        assert b"\\u6f22" in text


def wnn2hdl(*words: object, encoding: str) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run(
        [sys.executable, "-m", "wnn2hdl", *map(str, words)],
        capture_output=True,
        timeout=60,
        check=False,
        env={"PYTHONIOENCODING": encoding, "PATH": "/usr/bin:/bin", "PYTHONPATH": ":".join(sys.path)},
    )


@pytest.mark.parametrize("encoding", ["ascii", "cp1252"])
def test_a_whole_process_says_no_in_a_narrow_encoding(
    encoding: str, write_build: Callable[..., Path], tmp_path: Path
) -> None:
    build = write_build(tmp_path / "a")
    done = wnn2hdl("report", build, "--max-luts", "1", encoding=encoding)
    assert done.returncode == 1, done.stderr
    assert b"[x] a, max-luts" in done.stdout


@pytest.mark.parametrize("name", COMMANDS)
def test_every_help_page_is_ascii(name: str, run: Callable[..., Any]) -> None:
    done = run(name, "--help")
    assert done.status == 0
    assert done.stdout.isascii()


def test_a_gate_says_no_to_a_reader_that_went_away(write_build: Callable[..., Path], tmp_path: Path) -> None:
    build = write_build(tmp_path / "a")
    gate = subprocess.Popen(
        [sys.executable, "-m", "wnn2hdl", "report", str(build), "--max-luts", "1"], stdout=subprocess.PIPE
    )
    assert gate.stdout is not None
    gate.stdout.close()
    assert gate.wait(60) == 1
