"""Georeferenced rasters of any size, read and written window by window."""

from wnn2hdl.raster.gdal import PICTURE_DRIVERS, Georeference, same_grid
from wnn2hdl.raster.reading import RasterReader, Reading
from wnn2hdl.raster.writing import NODATA, ClassWriter, add_overviews

__all__ = [
    "NODATA",
    "PICTURE_DRIVERS",
    "ClassWriter",
    "Georeference",
    "RasterReader",
    "Reading",
    "add_overviews",
    "same_grid",
]
