"""Whatever is wrong with a picture, every command says so in the same one line."""

import os
import socket
import struct
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from PIL import Image

from wnn2hdl.ir import BitSelect, WisardModel

rasterio = pytest.importorskip("rasterio")

Run = Callable[..., Any]

PIXELS = np.random.default_rng(0).integers(0, 256, (40, 60, 3), dtype=np.uint8)
BANDS = np.moveaxis(PIXELS, 2, 0)


def picture(path: Path, cut: float = 1.0, **options: Any) -> None:
    Image.fromarray(PIXELS).save(path, **options)
    path.write_bytes(path.read_bytes()[: int(cut * path.stat().st_size)])


def raster(path: Path, bands: Any, **profile: Any) -> None:
    count, height, width = bands.shape
    size = {"driver": "GTiff", "count": count, "height": height, "width": width, "dtype": bands.dtype}
    with warnings.catch_warnings(action="ignore"), rasterio.open(path, "w", **size, **profile) as target:
        target.write(bands)


def named(path: Path, *names: str, **profile: Any) -> None:
    raster(path, BANDS, **profile)
    with warnings.catch_warnings(action="ignore"), rasterio.open(path, "r+") as target:
        target.descriptions = names


def with_units(path: Path) -> None:
    raster(path, BANDS, photometric="rgb")
    with warnings.catch_warnings(action="ignore"), rasterio.open(path, "r+") as target:
        target.scales = (1e-4,) * 3


def corrupted(path: Path) -> None:
    raster(path, BANDS, photometric="rgb", compress="deflate")
    content = bytearray(path.read_bytes())
    content[-2000:] = bytes(2000)
    path.write_bytes(content)


def huge(path: Path) -> None:
    picture(path)
    content = bytearray(path.read_bytes())
    content[18:26] = struct.pack("<ii", 100_000, 100_000)
    path.write_bytes(content)


def beside(path: Path, suffix: str, text: str) -> None:
    raster(path, BANDS, photometric="rgb")
    path.with_name(path.name + suffix).write_text(text)


def turned(path: Path) -> None:
    exif = Image.Exif()
    exif[0x0112] = 6
    Image.fromarray(PIXELS).save(path, exif=exif)


DEEP = PIXELS * np.uint16(9)
ITEM = '<MDI key="OVERVIEW_FILE">/etc/passwd</MDI>'
POINTING = f'<PAMDataset><Metadata domain="OVERVIEWS">{ITEM}</Metadata></PAMDataset>'
INFRARED = np.concatenate([BANDS, BANDS[:1] // 2 + 90])

BAD: dict[str, tuple[str, Callable[[Path], object]]] = {
    "empty": ("a.png", Path.touch),
    "text": ("a.png", lambda path: path.write_text("no picture")),
    "vrt": ("a.tif", lambda path: path.write_text("<VRTDataset rasterXSize='9' rasterYSize='9'/>")),
    "wms": ("a.tif", lambda path: path.write_text("<GDAL_WMS><Service name='TMS'/></GDAL_WMS>")),
    "gif": ("a.png", lambda path: Image.fromarray(PIXELS).save(path, format="GIF")),
    "pdf": ("a.jpg", lambda path: path.write_text("%PDF-1.7")),
    "truncated png": ("a.png", lambda path: picture(path, 0.5)),
    "truncated jpeg": ("a.jpg", lambda path: picture(path, 0.5)),
    "truncated bmp": ("a.bmp", lambda path: picture(path, 0.5)),
    "truncated tiff": ("a.tif", lambda path: picture(path, 0.5)),
    "nothing but a beginning": ("a.png", lambda path: path.write_bytes(b"\x89PNG\r\n\x1a\n")),
    "corrupted tiff": ("a.tif", corrupted),
    "huge": ("a.bmp", huge),
    "16 bits png": ("a.png", lambda path: path.write_bytes(cv2.imencode(".png", DEEP)[1].tobytes())),
    "16 bits tiff": ("a.tif", lambda path: raster(path, BANDS * np.uint16(9), photometric="rgb")),
    "float": ("a.tif", lambda path: raster(path, BANDS.astype(np.float32), photometric="rgb")),
    "complex": ("a.tif", lambda path: raster(path, BANDS.astype(np.complex64), photometric="rgb")),
    "bands without names": ("a.tif", lambda path: raster(path, INFRARED, photometric="minisblack")),
    "two readings of bands": ("a.tif", lambda path: named(path, "blue", "green", "red", photometric="rgb")),
    "infrared as alpha": ("a.tif", lambda path: raster(path, INFRARED, photometric="rgb", alpha="yes")),
    "infrared as alpha of a png": (
        "a.png",
        lambda path: Image.fromarray(np.dstack([PIXELS, PIXELS[..., 0] // 2 + 90])).save(path),
    ),
    "units": ("a.tif", with_units),
    "large colour table": ("a.tif", lambda path: raster(path, DEEP.T[:1], photometric="palette")),
    "turned tiff": ("a.tif", turned),
    "virtual mask": ("a.tif", lambda path: beside(path, ".msk", "<VRTDataset/>")),
    "pointing at another file": ("a.tif", lambda path: beside(path, ".aux.xml", POINTING)),
}  # fmt: skip


@pytest.fixture
def model(tmp_path: Path) -> Path:
    levels = np.arange(8)
    counts = np.stack([levels <= 2, levels >= 3]).astype(np.int64)[:, np.newaxis]
    names = ("forest", "deforested")
    made = WisardModel(BitSelect(("R5", "R6", "R7")), names, np.array([[[0, 1, 2]]]), counts, 1)
    made.save(tmp_path / "model.json")
    return tmp_path / "model.json"


@pytest.fixture
def commands(
    model: Path, write_build: Callable[..., Path], tmp_path: Path
) -> Callable[[Path], dict[str, list[Any]]]:
    """The commands that read a picture, by name."""
    (tmp_path / "masks").mkdir()
    Image.new("L", (60, 40)).save(tmp_path / "masks" / "a.png")
    build = write_build(tmp_path / "build")
    out = tmp_path / "out"

    def words(path: Path) -> dict[str, list[Any]]:
        pictures = ["--images", path.parent, "--masks", tmp_path / "masks"]
        return {
            "train": ["train", *pictures, "--bits", "R7", "--rams", 1, "--address-bits", 1, "-o", out],
            "evaluate": ["evaluate", model, *pictures],
            "compile": ["compile", model, "--mode", "domain", "--care", path.parent, "-o", out],
            "scan": ["scan", model, path, "-o", out],
            "simulate": ["simulate", build, "--image", path],
        }

    return words


@pytest.mark.parametrize("fault", BAD)
def test_every_command_refuses_the_same_in_the_same_words(
    fault: str, run: Run, commands: Callable[[Path], dict[str, list[Any]]], tmp_path: Path
) -> None:
    name, make = BAD[fault]
    (tmp_path / "pictures").mkdir()
    path = tmp_path / "pictures" / name
    make(path)
    said = {}
    for command, words in commands(path).items():
        done = run(*words)
        assert done.status == 2, (command, done)
        assert done.stdout == ""
        # The reported progress stands above.
        said[command] = done.stderr.splitlines()[-1]
        assert "Traceback" not in done.stderr
        assert said[command].startswith("wnn2hdl: ")
        assert not (tmp_path / "out").exists()
    assert len(set(said.values())) == 1, said
    assert name in said["scan"]


@pytest.mark.parametrize("kind", ["pipe", "socket", "device"])
def test_what_is_no_file_is_not_waited_for(
    kind: str, run: Run, commands: Callable[[Path], dict[str, list[Any]]], tmp_path: Path
) -> None:
    path = tmp_path / "a.png" if kind != "device" else Path("/dev/zero")
    if kind == "pipe":
        os.mkfifo(path)
    with socket.socket(socket.AF_UNIX) as waiting:
        if kind == "socket":
            waiting.bind(str(path))
        for command in ("scan", "simulate"):
            complaint = run(*commands(path)[command]).complaint()
            assert f"cannot read the picture: {path} (it is a {kind})" in complaint
