"""`wnn2hdl locate`: its bad input, and a run on the embedded flight."""

import json
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from wnn2hdl.apps.navigation import recording
from wnn2hdl.samples.flight import make_flight, write_flight

Run = Callable[..., Any]

COMMAND = [sys.executable, "-c", "import sys; from wnn2hdl.cli import main; sys.exit(main())"]

POSE = "frame,latitude_deg,longitude_deg,height_above_ground_m,yaw_deg,pitch_deg,roll_deg\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("flight")
    flight = make_flight(3, (400, 400), frames=5, frame_size=(90, 160), height_m=50, tilt_deg=3, spacing_m=15)
    assert len(list(write_flight(path, flight))) == 8
    return path


def given(folder: Path) -> list[str]:
    files = {"--map": "map.tif", "--frames": "frames", "--poses": "poses.csv"}
    return [word for option, name in files.items() for word in (option, str(folder / name))]


def test_files_are_located_and_written(run: Run, folder: Path, tmp_path: Path) -> None:
    arguments = [*given(folder), "--camera", str(folder / "camera.toml"), "--search", "map", "--json"]
    status, printed, _ = run("locate", *arguments, "-o", tmp_path / "out")
    assert status == 0
    data = json.loads(printed)
    assert data["frames"] == 5
    assert set(data["searches"]) == {"map"}
    assert data["methods"]["perspective-weightless"]["mean_m"] < 5
    assert data["calibration"] is None
    assert all(Path(path).is_file() for path in data["files"])


def test_poses_of_a_file_calibrate_and_are_not_scored(run: Run, folder: Path, tmp_path: Path) -> None:
    lines = (folder / "poses.csv").read_text().splitlines()
    some = tmp_path / "some.csv"
    some.write_text("\n".join([lines[0], *lines[1:4]]) + "\n")
    arguments = [*given(folder), "--focal", 120, "--calibrate", some, "--search", "window", "--window", 30]
    status, printed, _ = run("locate", *arguments, "--json", "-o", tmp_path / "out")
    assert status == 0
    data = json.loads(printed)
    assert data["frames"] == 2
    assert len(data["calibration"]["frames"]) == 3
    assert data["searches"]["window"]["furthest_m"] == pytest.approx(42.4, abs=0.1)


def test_frames_to_calibrate_on_may_lie_elsewhere(run: Run, folder: Path, tmp_path: Path) -> None:
    lines = (folder / "poses.csv").read_text().splitlines()
    (tmp_path / "new").mkdir()
    names = [line.split(",")[0] for line in lines[1:]]
    # The camera started to count again: the same name, another frame.
    for number, name in enumerate(names[3:], start=1):
        (tmp_path / "new" / f"frame_{number}.jpg").write_bytes((folder / "frames" / name).read_bytes())
    new, known = tmp_path / "new.csv", tmp_path / "known.csv"
    unknown = [f"frame_{number},,,{line.split(',', 3)[3]}" for number, line in enumerate(lines[4:], start=1)]
    new.write_text("\n".join([lines[0], *(line.replace(",", ".jpg,", 1) for line in unknown)]) + "\n")
    known.write_text("\n".join(lines[:4]) + "\n")
    flight = ("--map", folder / "map.tif", "--frames", tmp_path / "new", "--poses", new, "--focal", 120)
    calibrating = ("--calibrate", known, "--calibrate-frames", folder / "frames")
    done = run("locate", *flight, *calibrating, "--search", "map", "-o", tmp_path / "out", "--json")
    assert done.status == 0, done.stderr
    data = json.loads(done.stdout)
    assert data["frames"] == 2
    assert data["calibration"]["frames"] == names[:3]
    assert data["methods"]["perspective-weightless"]["mean_m"] is None
    refusal = run("locate", *flight, *calibrating, "-o", tmp_path / "out").complaint()
    assert "a window lies around a known position, and a frame has none: frame_1.jpg" in refusal


def test_what_one_run_learned_another_takes(run: Run, folder: Path, tmp_path: Path) -> None:
    lines = (folder / "poses.csv").read_text().splitlines()
    some = tmp_path / "some.csv"
    some.write_text("\n".join([lines[0], *lines[1:4]]) + "\n")
    common = [*given(folder), "--search", "map", "--methods", "grey", "--json"]
    learned = run("locate", *common, "--focal", 120, "--calibrate", some, "-o", tmp_path / "one")
    assert learned.status == 0, learned.stderr
    taking = ("--calibration", tmp_path / "one" / "calibration.json", "-o", tmp_path / "two")
    taken = run("locate", *common, "--focal", 120, *taking)
    assert taken.status == 0, taken.stderr
    one, two = json.loads(learned.stdout), json.loads(taken.stdout)
    assert list(two["methods"]) == ["grey", "grey-track"]
    # The three frames that have calibrated are not scored in the second run, either.
    assert one["frames"] == two["frames"] == 2
    for figure in ("mean_m", "fixed_percent", "confidence_threshold"):
        assert two["methods"]["grey"][figure] == one["methods"]["grey"][figure]
    reported = run("locate", *common, "--focal", 121, *taking).complaint_after_work()
    assert "belongs to other conditions: fx was 120.0, and now is 121.0" in reported


@pytest.mark.parametrize(
    ("name", "change", "fault"),
    [
        ("poses.csv", ("latitude_deg,longitude_deg", "lat,lon"), "rename lat to latitude_deg"),
        ("poses.csv", (".jpg,", ".jpg,7,"), "more cells than columns are named"),
        ("poses.csv", ("pitch_deg", "yaw_deg"), "name a column twice: yaw_deg"),
        ("poses.csv", (".jpg,-9.", ".jpg,9."), "the latitude probably lacks its sign"),
        ("camera.toml", ("focal = 120.0", "focal = 8.8"), "probably in millimetres"),
        ("camera.toml", ("tilt_deg = 3", "tilt_deg = -87"), "where a gimbal's pitch is -90"),
    ],
)
def test_conventions_of_others_are_refused_by_name(
    run: Run, folder: Path, tmp_path: Path, name: str, change: tuple[str, str], fault: str
) -> None:
    text = (folder / name).read_text()
    assert change[0] in text
    (tmp_path / name).write_text(text.replace(*change))
    files = {"poses.csv": folder / "poses.csv", "camera.toml": folder / "camera.toml", name: tmp_path / name}
    words = ["--map", folder / "map.tif", "--frames", folder / "frames", "--poses", files["poses.csv"]]
    refusal = run("locate", *words, "--camera", files["camera.toml"], "-o", tmp_path / "out").complaint()
    assert fault in refusal
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
@pytest.mark.parametrize("stop", ["frame", "interrupt"])
def test_no_thread_is_left_behind_when_it_ends_early(folder: Path, tmp_path: Path, stop: str) -> None:
    """A thread inside OpenCV while Python goes down would abort the process."""
    frames = Path(shutil.copytree(folder / "frames", tmp_path / "frames"))
    if stop == "frame":
        last = sorted(frames.iterdir())[2]
        last.write_bytes(last.read_bytes()[: last.stat().st_size // 2])
    words = ["locate", "--map", folder / "map.tif", "--frames", frames, "--poses", folder / "poses.csv"]
    words += ["--focal", 120, "--heading-tolerance", 30, "--jobs", 4, "-o", tmp_path / "out"]
    running = subprocess.Popen(
        [*COMMAND, *map(str, words)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    if stop == "interrupt":
        time.sleep(6)
        running.send_signal(signal.SIGINT)
    _, reported = running.communicate(timeout=120)
    assert running.returncode == (2 if stop == "frame" else 130), reported
    assert not (tmp_path / "out").exists()


def test_the_embedded_flight_needs_no_files(
    run: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(recording, "SAMPLE_MAP", (600, 600))
    monkeypatch.setattr(recording, "SAMPLE_FRAMES", 2)
    status, printed, _ = run("locate", "--window", "95", "--search", "window", "-o", tmp_path / "out")
    assert status == 0
    assert "134 m" in printed
    assert "73 m" in printed


@pytest.mark.parametrize(
    ("arguments", "fault"),
    [
        (["--map", "map.tif"], "these options go together: --map, --frames, --poses; give --frames, --poses"),
        (["--focal", "750"], "the embedded flight has its own camera and map: --focal"),
        (["--calibrate", "some.csv"], "the embedded flight has no file of poses"),
        (["--calibrate", "3"], "3 frames are too few to calibrate on; give at least 4"),
        (["--calibrate-frames", "."], "--calibrate-frames goes with a CSV file in --calibrate"),
        (["--calibrate", "all"], "neither a count nor a CSV"),
        (["--window", "0"], "--window"),
        (["--window", "nan"], "not a finite number"),
        (["--search", "around"], "--search"),
        (["--methods", "grey,canny"], "'canny' is not one of perspective-canny, rotation-canny"),
        (["--bands", "3,2,1"], "--bands, --scale and --alpha are for a map from a file"),
        (["--calibration", "none.json"], "cannot read a calibration: none.json"),
        (
            ["--calibration", "some.json", "--calibrate", "4"],
            "--calibration takes what an earlier --calibrate learned",
        ),
    ],
)
def test_bad_usage_is_one_line_and_status_2(
    run: Run,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    arguments: list[str],
    fault: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert fault in run("locate", *arguments).complaint()


def test_too_few_frames_are_told_once_the_flight_is_there(run: Run) -> None:
    reported = run("locate", "--calibrate", "9").complaint_after_work()
    assert "too few frames are left to score: 9 of 10 calibrate" in reported


def test_a_place_that_cannot_be_written_is_told_before_the_work(run: Run, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    assert "cannot make the folder" in run("locate", "-o", tmp_path / "file" / "out").complaint()


def test_bad_files_are_one_line_and_status_2(run: Run, folder: Path, tmp_path: Path) -> None:
    def refused(arguments: list[str], fault: str) -> None:
        assert fault in run("locate", *arguments, "-o", tmp_path / "out").complaint()

    files = given(folder)
    refused(files, "the camera is not known")
    refused([*files, "--focal", "120", "--camera", "c.toml"], "both give the focal length")
    refused([*files, "--camera", str(tmp_path / "none.toml")], "cannot read the camera")
    bad = tmp_path / "poses.csv"
    bad.write_text(POSE + "frame_1.jpg,north,0,50,0,0,0\n")
    refused([*files[:5], str(bad), "--focal", "120"], "latitude_deg is not a number: 'north'")
    bad.write_text(POSE + "gone.jpg,24,120,50,0,0,0\n")
    refused([*files[:5], str(bad), "--focal", "120"], "a frame of the poses is missing")
    refused([*files, "--focal", "120", "--calibrate", str(folder / "poses.csv")], "no frame is left to score")
