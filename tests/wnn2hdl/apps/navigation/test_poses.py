"""Poses: a CSV whose faults are named with their place."""

from pathlib import Path

import pytest

from wnn2hdl.apps.navigation.poses import (
    COLUMNS,
    Pose,
    frame_files,
    frame_numbers,
    read_poses,
    require_located,
)
from wnn2hdl.errors import InputError

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
        ([HEAD, LINE.replace("120.72", "")], "longitude_deg is no number: ''"),
        ([HEAD.replace(",longitude_deg", ""), LINE], "lack a column: longitude_deg"),
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
    assert frame_files(poses, tmp_path) == {poses[0]: tmp_path / "a.jpg"}
    for name in ("../poses.csv", str(tmp_path / "a.jpg")):
        with pytest.raises(InputError, match="a frame's name is a path: "):
            frame_files((Pose(name, 0, 0, 1, 0),), tmp_path)


def test_the_order_of_flight_is_that_of_the_numbers_in_names(tmp_path: Path) -> None:
    lines = [LINE.replace("a.jpg", name) for name in ("f_10.jpg", "f_9.jpg", "f_0100.jpg")]
    assert [pose.frame for pose in read(tmp_path, HEAD, *lines)] == ["f_9.jpg", "f_10.jpg", "f_0100.jpg"]
    others = [LINE.replace("a.jpg", name) for name in ("f_10.jpg", "g_9.jpg")]
    assert [pose.frame for pose in read(tmp_path, HEAD, *others)] == ["f_10.jpg", "g_9.jpg"]


def test_numbers_of_frames() -> None:
    assert frame_numbers(["DJI_001.jpg", "DJI_004.jpg", "DJI_0006.jpg"]) == [1, 4, 6]
    assert frame_numbers(["7", "12"]) == [7, 12]
    for names in (["a1.png", "b2.png"], ["first.png", "IMG_2.png"], ["f1.png", "f01.png"]):
        assert frame_numbers(names) is None


def test_where_a_frame_was_taken_need_not_be_known(tmp_path: Path) -> None:
    known, unknown = read(tmp_path, HEAD, LINE, "b.jpg,,,119.7,152.1,3.1,-3.9")
    assert (known.located, unknown.located) == (True, False)
    (without,) = read(tmp_path, "frame,height_above_ground_m,yaw_deg,pitch_deg,roll_deg", "b.jpg,90,0,0,0")
    assert not without.located
    require_located([known], "calibration needs it", "add it")
    with pytest.raises(InputError, match=r"calibration needs it, and a frame has none: b\.jpg; add it"):
        require_located([known, unknown], "calibration needs it", "add it")
