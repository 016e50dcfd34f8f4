"""Open datasets of one file for several threads: GDAL's must not be shared."""

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from wnn2hdl.raster.gdal import decoding, open_raster


class Handles:
    """Lends open datasets of a file.

    Args:
        path: a file that `open_raster` opens.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._lock = threading.Lock()
        self._idle: list[Any] = []

    @contextmanager
    def borrowed(self) -> Iterator[Any]:
        """An open dataset that no other thread uses meanwhile; raises as `decoding` and `open_raster`."""
        with decoding(self._path) as rasterio:
            with self._lock:
                source = self._idle.pop() if self._idle else None
            source = source or open_raster(rasterio, self._path)
            yield source
            with self._lock:
                self._idle.append(source)
