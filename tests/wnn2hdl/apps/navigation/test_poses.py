"""Poses: a CSV whose faults are named with their place."""

from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wnn2hdl.apps.navigation.conventions import require_aircraft_angles
from wnn2hdl.apps.navigation.pose_table import COLUMNS
from wnn2hdl.apps.navigation.poses import Pose, frame_files, read_poses, require_located
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
        ([HEAD], "no poses"),
        ([HEAD, LINE, LINE], "occurs twice"),
        ([HEAD, LINE.replace("24.26", "94.26")], "latitude_deg is not within -90 to 90: 94.26"),
        ([HEAD, LINE.replace("119.7", "0")], "height_above_ground_m is not within"),
        ([HEAD, LINE.replace("119.7", "1e999")], "height_above_ground_m is not within"),
        ([HEAD, LINE.replace("a.jpg", "")], "without a name"),
        ([HEAD, LINE.replace("24.26,120.72", "120.72,24.26")], "latitude and longitude are probably swapped"),
        ([HEAD, "a.jpg,24,2621,120,72,11,9"], "longitude_deg is not within -180 to 180: 2621"),
        ([HEAD, LINE.replace("120.72", "276.7")], "longitudes in the west are negative: -83.3"),
        ([HEAD, LINE.replace("119.7", "-3")], "above the ground, not above sea level"),
        ([HEAD, LINE.replace("24.26,120.72", "0,0.0")], "latitude and longitude are both 0"),
    ],
)
def test_values_that_cannot_be_meant_are_refused(tmp_path: Path, lines: list[str], fault: str) -> None:
    with pytest.raises(InputError) as caught:
        read(tmp_path, *lines)
    assert fault in caught.value.line()


def test_each_pose_has_its_frame(tmp_path: Path) -> None:
    poses = read(tmp_path, HEAD, LINE)
    with pytest.raises(InputError, match=r"a frame of the poses is missing: .*a\.jpg"):
        frame_files(poses, tmp_path)
    (tmp_path / "a.jpg").touch()
    assert frame_files(poses, tmp_path) == {poses[0]: tmp_path / "a.jpg"}
    for name in ("../poses.csv", str(tmp_path / "a.jpg")):
        with pytest.raises(InputError, match="a frame's name is a path: "):
            frame_files((Pose(name, 0, 0, 1, 0),), tmp_path)


def test_poses_come_in_the_order_of_flight(tmp_path: Path) -> None:
    lines = [LINE.replace("a.jpg", name) for name in ("f_1.jpg", "f_10.jpg", "f_9.jpg")]
    assert [pose.frame for pose in read(tmp_path, HEAD, *lines)] == ["f_1.jpg", "f_9.jpg", "f_10.jpg"]


def test_where_a_frame_was_taken_need_not_be_known(tmp_path: Path) -> None:
    known, unknown = read(tmp_path, HEAD, LINE, "b.jpg,,,119.7,152.1,3.1,-3.9")
    assert (known.located, unknown.located) == (True, False)
    (without,) = read(tmp_path, "frame,height_above_ground_m,yaw_deg,pitch_deg,roll_deg", "b.jpg,90,0,0,0")
    assert not without.located
    require_located([known], "calibration needs it", "add it")
    with pytest.raises(InputError, match=r"calibration needs it, and a frame has none: b\.jpg; add it"):
        require_located([known, unknown], "calibration needs it", "add it")


cells = st.one_of(
    st.text(max_size=12),
    st.floats().map(str),
    st.sampled_from(["", " ", "24.26", "120.72", "-3.9", "1e3", '"', "a.jpg", "f_0007.jpg", "0", "400"]),
)
tables = st.lists(st.lists(cells, max_size=9).map(",".join), max_size=6)
heads = st.one_of(
    st.just(HEAD), st.permutations(COLUMNS).map(",".join), st.lists(cells, max_size=9).map(",".join)
)


@settings(max_examples=300, deadline=None)
@given(heads, tables, st.sampled_from(["\n", "\r\n", "\r"]))
def test_any_table_is_read_or_refused_in_one_line(
    tmp_path_factory: pytest.TempPathFactory, head: str, lines: list[str], end: str
) -> None:
    _is_read_or_refused(tmp_path_factory, end.join([head, *lines]).encode("utf-8", "replace"))


@settings(max_examples=200, deadline=None)
@given(st.binary(max_size=80), st.booleans())
def test_any_bytes_are_read_or_refused_in_one_line(
    tmp_path_factory: pytest.TempPathFactory, content: bytes, headed: bool
) -> None:
    _is_read_or_refused(tmp_path_factory, (f"{HEAD}\n{LINE}\n".encode() if headed else b"") + content)


def _is_read_or_refused(folders: pytest.TempPathFactory, content: bytes) -> None:
    path = folders.getbasetemp() / "fuzz.csv"
    path.write_bytes(content)
    with suppress(InputError):
        poses = read_poses(path)
        assert all(0.1 <= pose.height_m <= 100_000 and abs(pose.yaw_deg) <= 360 for pose in poses)
        require_aircraft_angles(poses)
        frame_files(poses, path.parent)
