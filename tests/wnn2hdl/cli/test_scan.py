"""The command `scan` as a user meets it."""

import json
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from wnn2hdl.ir import BitSelect, WisardModel
from wnn2hdl.samples import landscape

rasterio = pytest.importorskip("rasterio")

Run = Callable[..., Any]

COMMAND = [sys.executable, "-c", "import sys; from wnn2hdl.cli import main; sys.exit(main())", "scan"]


@pytest.fixture
def model(tmp_path: Path) -> Path:
    """Deforested where red is at least 96; colours below 64 are unknown to it."""
    levels = np.arange(8)
    counts = np.stack([levels == 2, levels >= 3]).astype(np.int64)[:, np.newaxis]
    bits = BitSelect(("R5", "R6", "R7"))
    names = ("forest", "deforested")
    WisardModel(bits, names, np.array([[[0, 1, 2]]]), counts, 1).save(tmp_path / "model.json")
    return tmp_path / "model.json"


@pytest.fixture
def pixels() -> NDArray[np.uint8]:
    return np.maximum(landscape(120, 150, seed=7).image, 64)


@pytest.fixture
def picture(pixels: NDArray[np.uint8], tmp_path: Path) -> Path:
    Image.fromarray(pixels).save(tmp_path / "picture.png")
    return tmp_path / "picture.png"


@pytest.fixture
def scan(run: Run) -> Run:
    return partial(run, "scan")


def test_one_json_object_on_stdout(
    scan: Run, model: Path, picture: Path, pixels: NDArray[np.uint8], tmp_path: Path
) -> None:
    done = scan(model, picture, "-o", tmp_path / "out", "--json", "--jobs", 1)
    assert done.status == 0, done.stderr
    data = json.loads(done.stdout)
    assert data["deforested"]["share"] == (pixels[..., 0] >= 96).mean()
    assert data["coverage"]["share"] == 1
    assert data["output"] == str(tmp_path / "out")
    assert "warning" not in done.stderr.lower()
    assert (tmp_path / "out" / "overlay.png").exists()


def test_foreign_imagery_is_warned_of_on_stderr(scan: Run, model: Path, tmp_path: Path) -> None:
    Image.new("RGB", (40, 30)).save(tmp_path / "black.png")
    done = scan(model, tmp_path / "black.png", "-o", tmp_path / "out", "--square", 20)
    assert done.status == 0
    assert "wnn2hdl: warning: the imagery is foreign to the model" in done.stderr
    assert "0.00% deforested" in done.stdout


def test_the_share_left_out_is_shown(
    scan: Run, model: Path, pixels: NDArray[np.uint8], tmp_path: Path
) -> None:
    alpha = np.full((120, 150), 255, dtype=np.uint8)
    alpha[:30] = 0
    Image.fromarray(np.dstack([pixels, alpha])).save(tmp_path / "a.png")
    done = scan(model, tmp_path / "a.png", "-o", tmp_path / "out")
    assert "25.00% of the pixels left out: no data, or excluded" in done.stdout


def test_a_sentinel_product_needs_bands_and_a_scale(scan: Run, model: Path, tmp_path: Path) -> None:
    bands = np.random.default_rng(0).integers(0, 4000, (4, 60, 50), dtype=np.uint16)
    place = {"crs": "EPSG:32720", "transform": rasterio.Affine(10, 0, 4e5, 0, -10, 9.1e6)}
    size = {"count": 4, "height": 60, "width": 50, "dtype": "uint16"}
    with rasterio.open(tmp_path / "s2.tif", "w", driver="GTiff", **size, **place) as target:
        target.write(bands)
    start = (model, tmp_path / "s2.tif", "-o", tmp_path / "out")
    assert "give --bands" in scan(*start).complaint()
    assert "give --scale" in scan(*start, "--bands", "3,2,1").complaint()
    done = scan(*start, "--bands", "3,2,1", "--scale", "0..3000", "--json")
    scaled = np.clip(np.rint(bands[2] * (255 / 3000)), 0, 255)
    assert json.loads(done.stdout)["deforested"]["pixels"] == (scaled >= 96).sum()


def test_bad_usage_is_one_line(scan: Run, model: Path, picture: Path, tmp_path: Path) -> None:
    start = (model, picture, "-o", tmp_path / "out")
    assert "'3,2' is neither three band numbers" in scan(*start, "--bands", "3,2").complaint()
    assert "'9..1' does not rise" in scan(*start, "--scale", "9..1").complaint()
    assert "nan is not a finite number" in scan(*start, "--share", "nan").complaint()
    assert "inf is not a finite number" in scan(*start, "--min-area", "inf").complaint()
    assert "is not in the range" in scan(*start, "--square", 1_000_000).complaint()
    assert "'low' is not a range" in scan(*start, "--scale", "low").complaint()
    assert "limit the same regions" in scan(*start, "--min-area", 1, "--min-pixels", 9).complaint()
    assert "--jobs is for this machine" in scan(*start, "--jobs", 1, "--scheduler", "tcp://a:1").complaint()
    assert "does not exist" in scan(model, tmp_path / "none.tif", "-o", tmp_path / "out").complaint()
    assert "not a model" in scan(picture, picture, "-o", tmp_path / "out").complaint()
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_a_killed_scan_goes_on_and_ends_the_same(scan: Run, model: Path, tmp_path: Path) -> None:
    scene = tmp_path / "scene.tif"
    tile = np.moveaxis(landscape(512, 512, seed=1).image, 2, 0)
    place = {"crs": "EPSG:32720", "transform": rasterio.Affine(10, 0, 4e5, 0, -10, 9.1e6)}
    size = {"count": 3, "height": 4096, "width": 4096, "dtype": "uint8"}
    layout = {"tiled": True, "blockxsize": 512, "blockysize": 512, "compress": "deflate", "zlevel": 1}
    with rasterio.open(scene, "w", driver="GTiff", photometric="rgb", **size, **layout, **place) as target:
        for row in range(0, 4096, 512):
            for column in range(0, 4096, 512):
                target.write(tile, window=((row, row + 512), (column, column + 512)))
    words = [model, scene, "--square", 20, "--vector", "none", "--jobs", 1]
    arguments = [*words, "-o", tmp_path / "out"]
    running = subprocess.Popen([*COMMAND, *map(str, arguments)], stderr=subprocess.DEVNULL)
    journal = tmp_path / "out" / ".scan" / "windows"
    while not journal.exists() or journal.stat().st_size < 2_000:
        assert running.poll() is None
        time.sleep(0.01)
    running.send_signal(signal.SIGKILL)
    running.wait()
    assert not (tmp_path / "out" / "classes.tif").exists()
    assert scan(*words, "-o", tmp_path / "out").status == 0
    assert scan(*words, "-o", tmp_path / "at-once").status == 0
    resumed, at_once = (tmp_path / x / "classes.tif" for x in ("out", "at-once"))
    assert resumed.read_bytes() == at_once.read_bytes()


def test_ground_that_is_counted_once_is_not_left_out(
    scan: Run, model: Path, pixels: NDArray[np.uint8], tmp_path: Path
) -> None:
    (tmp_path / "dates").mkdir()
    place = {"crs": "EPSG:32720", "transform": rasterio.Affine(10, 0, 5e5, 0, -10, 9e6)}
    size = {"height": pixels.shape[0], "width": pixels.shape[1], "count": 3, "dtype": "uint8"}
    for name in ("2023", "2024"):
        with rasterio.open(
            tmp_path / "dates" / f"{name}.tif", "w", photometric="rgb", **size, **place
        ) as target:
            target.write(np.moveaxis(pixels, 2, 0))
    done = scan(model, tmp_path / "dates", "-o", tmp_path / "out")
    assert done.status == 0, done.stderr
    assert "1 of 2 pictures share ground with later ones" in done.stderr
    assert "left out" not in done.stdout
