"""Which formats are read, recognised by a file's first bytes, not by its name; nothing else is opened."""

from pathlib import Path

from wnn2hdl.errors import InputError
from wnn2hdl.files import require_file

PNG, JPEG, BMP, TIFF, JP2 = "PNG", "JPEG", "BMP", "GTiff", "JP2OpenJPEG"
"""GDAL's names of the formats that are read.

Whatever else GDAL can open is not opened: its virtual formats (VRT, WMS and so on) fetch other files and
addresses of the network that their text names.
"""

PLAIN_FORMATS = (PNG, JPEG, BMP)
"""Formats of plain pictures: georeferenced by files beside them at most."""

_BEGINNINGS = {
    b"\x89PNG\r\n\x1a\n": PNG,
    b"\xff\xd8\xff": JPEG,
    b"BM": BMP,
    b"II*\0": TIFF,
    b"MM\0*": TIFF,
    b"II+\0": TIFF,
    b"MM\0+": TIFF,
    b"\0\0\0\x0cjP  \r\n\x87\n": JP2,
    b"\xff\x4f\xff\x51": JP2,
}


def format_of(path: Path) -> str:
    """The format of a file by its first bytes: `PNG`, `JPEG`, `BMP`, `TIFF` or `JP2`.

    Raises:
        InputError: there is no such file, it is not a regular one, it cannot be read, it is empty, or of
            another format.
    """
    require_file(path, "the picture")
    try:
        with path.open("rb") as stream:
            head = stream.read(max(map(len, _BEGINNINGS)))
    except OSError as error:
        raise InputError("cannot read the picture", value=f"{path} ({error.strerror})") from error
    if not head:
        raise InputError("the picture is empty", value=path, hint="copy or save it again")
    for beginning, name in _BEGINNINGS.items():
        if head.startswith(beginning):
            return name
    raise InputError(
        "not a picture that can be read", value=path, hint="give a PNG, JPEG, TIFF, BMP or JPEG 2000 file"
    )
