"""Georeferenced rasters of any size, read and written window by window."""

from wnn2hdl.raster.exclusion import Exclusion
from wnn2hdl.raster.formats import format_of
from wnn2hdl.raster.gdal import Georeference, same_grid
from wnn2hdl.raster.reading import RasterReader, Reading, require_decodable
from wnn2hdl.raster.stored import Stored, read_stored
from wnn2hdl.raster.validity import AlphaMeaning
from wnn2hdl.raster.writing import NODATA, ClassWriter, add_overviews

__all__ = [
    "NODATA",
    "AlphaMeaning",
    "ClassWriter",
    "Exclusion",
    "Georeference",
    "RasterReader",
    "Reading",
    "Stored",
    "add_overviews",
    "format_of",
    "read_stored",
    "require_decodable",
    "same_grid",
]
