"""Pose logs as spreadsheets and loggers write them: read as they are meant, or refused with the place."""

from pathlib import Path

import pytest

from wnn2hdl.apps.navigation.pose_table import COLUMNS, number, read_rows
from wnn2hdl.errors import InputError

HEAD = ",".join(COLUMNS)
LINE = "DJI_0001.jpg,24.26,120.72,119.7,152.1,3.1,-3.9"


def rows(folder: Path, content: str | bytes) -> list[tuple[str, dict[str, str]]]:
    path = folder / "poses.csv"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return list(read_rows(path))


@pytest.mark.parametrize(
    "content",
    [
        f"{HEAD}\n{LINE}\n",
        f"\ufeff{HEAD}\r\n{LINE}\r\n",
        f"{HEAD}\r{LINE}\r",
        f"{HEAD}\n\n{LINE}\n\n,,,,,,\n",
        f"{HEAD.replace(',', ', ')}\n{LINE.replace(',', ', ')}",
    ],
)
def test_what_is_clear_is_read(tmp_path: Path, content: str) -> None:
    ((where, row),) = rows(tmp_path, content)
    assert list(row.values()) == LINE.split(",")
    assert str(tmp_path / "poses.csv") in where


@pytest.mark.parametrize(
    ("head", "line", "fault"),
    [
        (HEAD, LINE + ",999", "more cells than columns are named, the first too many: '999', cell 8"),
        (HEAD, "a.jpg,24,2621,120,72,119,7,152,1", "write decimals with a point"),
        (HEAD, "a.jpg,24.26,120.72,119.7,152.1", "line 2 of"),
        (HEAD, "a.jpg,24.26,120.72,119.7,152.1", "ends before the column pitch_deg: 5 cells, not 7"),
        (f"{HEAD},yaw_deg", f"{LINE},-30", "name a column twice: yaw_deg"),
        (HEAD.replace(",", ";"), LINE.replace(",", ";"), "semicolons between their cells"),
        (HEAD.replace(",", "\t"), LINE.replace(",", "\t"), "tabs between their cells"),
        (HEAD.replace(",yaw_deg", ""), LINE, "lack a column: yaw_deg"),
        ("", "", "lack a column"),
        ("# log", f"{HEAD}\n{LINE}", "lack a column"),
    ],
)
def test_lines_that_may_mean_something_else_are_refused(
    tmp_path: Path, head: str, line: str, fault: str
) -> None:
    with pytest.raises(InputError) as caught:
        rows(tmp_path, f"{head}\n{line}\n")
    assert fault in caught.value.line()


@pytest.mark.parametrize(
    ("column", "header"),
    [
        ("latitude_deg", "lat"),
        ("latitude_deg", "GPSLatitude"),
        ("longitude_deg", "lng"),
        ("longitude_deg", "Longitude_deg"),
        ("height_above_ground_m", "altitude (m)"),
        ("height_above_ground_m", "height_above_ground_ft"),
        ("yaw_deg", "FlightYawDegree"),
        ("pitch_deg", "gimbal_pitch"),
        ("roll_deg", "ROLL_DEG"),
        ("frame", "file"),
        ("yaw_deg", "yaw_dge"),
    ],
)
def test_headers_of_others_are_named_with_the_right_one(tmp_path: Path, column: str, header: str) -> None:
    with pytest.raises(InputError, match=rf"lack a column: {column}; rename .* to {column}") as caught:
        rows(tmp_path, f"{HEAD.replace(column, header)}\n{LINE}\n")
    assert header in caught.value.hint


def test_a_position_may_lack_but_not_by_a_near_miss(tmp_path: Path) -> None:
    without = "frame,height_above_ground_m,yaw_deg,pitch_deg,roll_deg,plateau"
    assert rows(tmp_path, f"{without}\nb.jpg,90,0,0,0,1\n")[0][1]["frame"] == "b.jpg"
    with pytest.raises(InputError, match="rename lat to latitude_deg and rename lon to longitude_deg"):
        rows(tmp_path, f"{without},lat,lon\nb.jpg,90,0,0,0,1,24.26,120.72\n")


def test_files_that_are_no_csv_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot read the poses"):
        list(read_rows(tmp_path / "none.csv"))
    for content in (f"{HEAD}\n{LINE}\n".encode("utf-16"), "L\xe4ngs".encode("latin-1"), b'"a'):
        with pytest.raises(InputError, match="the poses are not CSV"):
            rows(tmp_path, content)


@pytest.mark.parametrize("text", ["24", "-3.9", "+.5", "1e3", "7."])
def test_numbers_are_digits_and_a_point(text: str) -> None:
    assert number(text, "yaw_deg", "line 2") == float(text)


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("24,26", "with a point"),
        ("24\N{DEGREE SIGN}15'44\"N", "decimal degrees"),
        ("1_190", ""),
        ("\u0662\u0664", ""),
        ("nan", ""),
        ("", ""),
        ("north", ""),
    ],
)
def test_other_ways_to_write_numbers_are_refused(text: str, hint: str) -> None:
    with pytest.raises(InputError, match="line 2: yaw_deg is not a number") as caught:
        number(text, "yaw_deg", "line 2")
    assert hint in caught.value.hint
