"""Pattern sets by rule and from files."""

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import linprog

from wnn2hdl.edges import boundary, from_file, half_plane
from wnn2hdl.errors import InputError
from wnn2hdl.ir import EdgeFilter, window_codes

GRID = np.array([(x, y, 1) for y in (-1, 0, 1) for x in (-1, 0, 1)], dtype=np.float64)


def is_cut_by_a_line(code: int) -> bool:
    """Whether some line has exactly the set pixels on one side, by linear programming."""
    signs = np.array([1 if code >> bit & 1 else -1 for bit in range(9)])
    result = linprog(
        np.zeros(3), A_ub=-signs[:, np.newaxis] * GRID, b_ub=-np.ones(9), bounds=[(None, None)] * 3
    )
    return bool(result.status == 0)


def test_boundary_is_a_set_centre_with_a_clear_4_neighbour() -> None:
    patterns = boundary().patterns
    for code in range(512):
        clear = any(not code >> bit & 1 for bit in (1, 3, 5, 7))
        assert patterns[code] == (bool(code >> 4 & 1) and clear)
    assert boundary().size == 240


def test_boundary_outlines_a_square() -> None:
    picture = np.zeros((8, 8), dtype=np.bool_)
    picture[2:6, 2:6] = True
    outline = picture.copy()
    outline[3:5, 3:5] = False
    assert np.array_equal(boundary().evaluate(window_codes(picture)), outline[1:-1, 1:-1])


def test_half_planes_are_the_boundary_patterns_that_a_line_cuts_out() -> None:
    expected = [code for code in range(512) if boundary().patterns[code] and is_cut_by_a_line(code)]
    assert np.flatnonzero(half_plane().patterns).tolist() == expected
    assert half_plane().size == 24


def test_a_file_may_hold_codes_strings_and_rows(tmp_path: Path) -> None:
    path = tmp_path / "mine.json"
    path.write_text(json.dumps([56, "100000000", ["000", "000", "001"]]))
    read = from_file(path)
    assert read.name == "mine"
    assert np.flatnonzero(read.patterns).tolist() == [1, 56, 256]


def test_a_saved_filter_can_be_read(tmp_path: Path) -> None:
    saved = EdgeFilter("mine", boundary().patterns)
    path = tmp_path / "mine.json"
    path.write_text(json.dumps(saved.to_json()))
    assert np.array_equal(from_file(path).patterns, saved.patterns)


@pytest.mark.parametrize(
    ("entry", "shown"),
    [
        (512, "512"),
        (-1, "-1"),
        (True, "true"),
        (1.5, "1.5"),
        ("0101", '"0101"'),
        ("01010101x", '"01010101x"'),
        (["000", "00", "0000"], "000"),
        ([111, "000", "000"], "111"),
        (None, "null"),
    ],
)
def test_a_wrong_pattern_is_counted_and_shown(tmp_path: Path, entry: object, shown: str) -> None:
    path = tmp_path / "mine.json"
    path.write_text(json.dumps([56, entry]))
    with pytest.raises(InputError, match=r"pattern 2 of .*mine\.json is not a 3x3 pattern") as caught:
        from_file(path)
    assert shown in str(caught.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[1, 2", "not a file of edge patterns, or a damaged one"),
        ("[]", "does not hold a list of edge patterns"),
        ("7", "does not hold a list of edge patterns"),
        ('{"codes": [1]}', "does not hold a list of edge patterns"),
    ],
)
def test_a_file_that_is_no_list_is_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "mine.json"
    path.write_text(text)
    with pytest.raises(InputError, match=message):
        from_file(path)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"cannot read a file of edge patterns: .*gone\.json \(No such file"):
        from_file(tmp_path / "gone.json")
