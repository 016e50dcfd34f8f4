"""The fuzzer tells files that are refused from those that a reader stumbles over."""

import json
import random
import subprocess
import sys
import warnings
from pathlib import Path

import pytest

from benchmarks.damage import damaged
from benchmarks.fuzz import Reader, ending, fuzz
from wnn2hdl.errors import InputError


def test_the_same_seed_damages_alike() -> None:
    content = json.dumps({"a": [1, 2, {"b": "c"}], "d": None}).encode()
    first, second = ([damaged(content, random.Random(seed)) for seed in range(200)] for _ in range(2))
    assert first == second
    assert len({*first}) > 100


def test_endings_are_told_apart() -> None:
    def refuse() -> None:
        raise InputError("wrong")

    assert ending(list)[0] == "read"
    assert ending(refuse) == ("refused", "wrong")
    assert ending(lambda: 1 // 0)[0].startswith("ZeroDivisionError in test_fuzz.py")
    assert ending(lambda: warnings.warn("careless", stacklevel=1))[0].startswith("UserWarning in")


def test_a_careless_reader_is_found_and_the_file_put_back(tmp_path: Path) -> None:
    file = tmp_path / "file.json"
    file.write_text('{"rams": 4}')
    tally = fuzz(Reader("careless", file, lambda: json.loads(file.read_bytes())["rams"] + 1, ()), 200, 0)
    assert {end.split()[0] for end in tally.faults} >= {"JSONDecodeError", "KeyError", "TypeError"}
    assert sum(tally.ends.values()) == 200
    assert file.read_text() == '{"rams": 4}'


@pytest.mark.slow
def test_every_reader_refuses_what_it_does_not_read() -> None:
    words = [sys.executable, "-m", "benchmarks.fuzz", "--cases", "40", "--seed", "2"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.slow
def test_a_short_soak_finds_nothing() -> None:
    words = [sys.executable, "-m", "benchmarks.soak", "--minutes", "0.5"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "0 faults" in done.stdout
