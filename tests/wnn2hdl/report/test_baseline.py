"""Builds are recorded in a file that a person can read the changes of."""

import copy
import json
from pathlib import Path
from typing import Any

import pytest

from wnn2hdl.errors import CheckError, ModelFileError
from wnn2hdl.report.baseline import Recorded, read_baseline, recorded, write_baseline


def test_what_is_recorded(report: dict[str, Any]) -> None:
    luts = {"block": 19, "edge": 1, "match": 10, "pixel": 2}
    assert recorded(report) == Recorded(0.9165, luts, "domain", "block")
    report["parts"]["match"]["luts"] = None
    assert set(recorded(report).luts) == {"block", "edge", "pixel"}


def test_it_survives_its_file(report: dict[str, Any], tmp_path: Path) -> None:
    write_baseline(tmp_path / "b.json", {"x": report}, {"x": ()})
    assert read_baseline(tmp_path / "b.json") == {"x": recorded(report)}


def test_a_change_of_a_figure_is_a_change_of_a_line(report: dict[str, Any], tmp_path: Path) -> None:
    changed = copy.deepcopy(report)
    changed["parts"]["block"]["luts"] = 20
    write_baseline(tmp_path / "a.json", {"x": report, "a": report}, {"x": (), "a": ()})
    write_baseline(tmp_path / "b.json", {"a": changed, "x": report}, {"x": (), "a": ()})
    lines = [(tmp_path / name).read_text().splitlines() for name in ("a.json", "b.json")]
    assert [pair for pair in zip(*lines, strict=True) if pair[0] != pair[1]] == [
        ('    "block": 19,', '    "block": 20,')
    ]


def test_a_build_that_is_not_proved_makes_none(report: dict[str, Any], tmp_path: Path) -> None:
    report["proof"]["status"] = "failed"
    with pytest.raises(CheckError, match="not proved cannot be a baseline: x"):
        write_baseline(tmp_path / "b.json", {"x": report}, {"x": ()})
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "damage",
    [
        lambda data: data | {"version": 2},
        lambda data: data | {"format": "wnn2hdl-manifest"},
        lambda data: data | {"builds": []},
        lambda data: data | {"extra": 1},
        lambda data: data | {"builds": {"x": data["builds"]["x"] | {"luts": {"block": -1}}}},
        lambda data: data | {"builds": {"x": data["builds"]["x"] | {"luts": {"block": "19"}}}},
        lambda data: data | {"builds": {"x": data["builds"]["x"] | {"accuracy": 91.65}}},
        lambda data: {},
    ],
)
def test_a_damaged_one_is_refused_in_one_line(report: dict[str, Any], tmp_path: Path, damage: Any) -> None:
    path = tmp_path / "b.json"
    write_baseline(path, {"x": report}, {"x": ()})
    path.write_text(json.dumps(damage(json.loads(path.read_text()))))
    with pytest.raises(ModelFileError, match="not a baseline, or one of another version") as caught:
        read_baseline(path)
    assert "\n" not in caught.value.line()
    assert "write it again with --write-baseline" in caught.value.line()
