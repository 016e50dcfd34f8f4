"""Poses: a CSV whose faults are named with their place."""

from pathlib import Path

import pytest

from wnn2hdl.errors import InputError
from wnn2hdl.navigate.poses import COLUMNS, Pose, frame_files, read_poses

HEAD = ",".join(COLUMNS)
LINE = "a.jpg,24.26,120.72,119.7,152.1,3.1,-3.9"


def read(folder: Path, *lines: str) -> tuple[Pose, ...]:
    path = folder / "poses.csv"
    path.write_text("\n".join(lines) + "\n")
    return read_poses(path)


def test_a_line_is_a_pose(tmp_path: Path) -> None:
    assert read(tmp_path, HEAD, LINE) == (Pose("a.jpg", 24.26, 120.72, 119.7, 152.1, 3.1, -3.9),)


def test_columns_may_come_in_any_order_among_others(tmp_path: Path) -> None:
    names = ["speed", *reversed(COLUMNS)]
    values = ["9", *reversed(LINE.split(","))]
    assert read(tmp_path, ",".join(names), ",".join(values)) == read(tmp_path, HEAD, LINE)


@pytest.mark.parametrize(
    ("lines", "fault"),
    [
        ([HEAD.replace(",yaw_deg", ""), LINE], "lack a column: yaw_deg"),
        ([HEAD], "no poses"),
        ([], "lack a column"),
        ([HEAD, LINE, LINE], "occurs twice"),
        (
            [HEAD, LINE.replace("24.26", "north")],
            "line 2 of",
        ),
        ([HEAD, LINE.replace("24.26", "north")], "latitude_deg is no number: 'north'"),
        ([HEAD, LINE.replace("24.26", "nan")], "latitude_deg is not within -90 to 90: nan"),
        ([HEAD, LINE.replace("24.26", "94.26")], "latitude_deg is not within -90 to 90: 94.26"),
        ([HEAD, LINE.replace("119.7", "0")], "height_above_ground_m is not within"),
        ([HEAD, "a.jpg,24.26"], "longitude_deg is no number: None"),
        ([HEAD, LINE.replace("a.jpg", "")], "without a name"),
    ],
)
def test_bad_files_are_refused(tmp_path: Path, lines: list[str], fault: str) -> None:
    with pytest.raises(InputError) as caught:
        read(tmp_path, *lines)
    assert fault in caught.value.line()


def test_files_that_are_none_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot read the poses"):
        read_poses(tmp_path / "none.csv")
    (tmp_path / "poses.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="no CSV"):
        read_poses(tmp_path / "poses.csv")


def test_each_pose_has_its_frame(tmp_path: Path) -> None:
    poses = read(tmp_path, HEAD, LINE)
    with pytest.raises(InputError, match=r"a frame of the poses is missing: .*a\.jpg"):
        frame_files(poses, tmp_path)
    (tmp_path / "a.jpg").touch()
    assert frame_files(poses, tmp_path) == (tmp_path / "a.jpg",)
    with pytest.raises(InputError, match="is missing"):
        frame_files((Pose("../poses.csv", 0, 0, 1, 0),), tmp_path)
