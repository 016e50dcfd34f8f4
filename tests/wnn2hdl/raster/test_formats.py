"""A file's first bytes tell its format; nothing but a regular file of a known one is opened."""

import os
import socket
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from wnn2hdl.errors import InputError
from wnn2hdl.raster import format_of


@pytest.mark.parametrize(
    ("suffix", "kind"),
    [("png", "PNG"), ("jpg", "JPEG"), ("bmp", "BMP"), ("tif", "GTiff"), ("jp2", "JP2OpenJPEG")],
)
def test_the_content_counts_and_not_the_name(suffix: str, kind: str, tmp_path: Path) -> None:
    picture = tmp_path / f"a.{suffix}"
    Image.fromarray(np.zeros((8, 8, 3), dtype=np.uint8)).save(picture)
    assert format_of(picture.rename(tmp_path / "misnamed.png")) == kind


def test_virtual_formats_are_no_pictures(tmp_path: Path) -> None:
    for text in (
        "<VRTDataset rasterXSize='1' rasterYSize='1'/>",
        "<GDAL_WMS></GDAL_WMS>",
        "GIF89a",
        "%PDF-1.4",
    ):
        (tmp_path / "a.tif").write_text(text)
        with pytest.raises(InputError, match=r"not a picture that can be read: .*a\.tif"):
            format_of(tmp_path / "a.tif")


def test_what_is_no_regular_file_is_not_opened(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.png")
    (tmp_path / "folder.png").mkdir()
    with socket.socket(socket.AF_UNIX) as waiting:
        waiting.bind(str(tmp_path / "s.png"))
        for name, kind in (("pipe.png", "a pipe"), ("folder.png", "a folder"), ("s.png", "a socket")):
            with pytest.raises(InputError, match=f"it is {kind}"):
                format_of(tmp_path / name)
    with pytest.raises(InputError, match="it is a device"):
        format_of(Path("/dev/zero"))
    with pytest.raises(InputError, match="No such file"):
        format_of(tmp_path / "gone.png")
    (tmp_path / "empty.png").touch()
    with pytest.raises(InputError, match="is empty"):
        format_of(tmp_path / "empty.png")
