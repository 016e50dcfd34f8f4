"""What changed between the class rasters of two dates."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from wnn2hdl.apps.deforestation.areas import ClassArea
from wnn2hdl.apps.deforestation.class_raster import STRIP_PIXELS, open_classes, read_strip, strip_rows
from wnn2hdl.apps.deforestation.cleanup import MinimumSize, sieve_in_place
from wnn2hdl.apps.deforestation.polygons import write_polygons
from wnn2hdl.errors import InputError
from wnn2hdl.progress import Progress
from wnn2hdl.raster import NODATA, ClassWriter, Georeference, same_grid

CHANGES = ("unchanged", "newly cleared", "regrown")
"""The classes of a raster of changes, by index."""

_COLOURS = ((40, 40, 40), (226, 60, 40), (60, 190, 90))


@dataclass(frozen=True)
class Change:
    """The outcome of a comparison.

    Attributes:
        compared_pixels: pixels with data on both dates.
        newly_cleared: not cleared before, and cleared after.
        regrown: the reverse.
    """

    compared_pixels: int
    newly_cleared: ClassArea
    regrown: ClassArea


def write_change(
    before: Path,
    after: Path,
    cleared: Sequence[int],
    minimum: MinimumSize | None,
    output_raster: Path,
    output_polygons: Path,
    progress: Progress,
) -> Change:
    """Map what was not cleared before and is after, and the reverse.

    A change from one cleared class to another does not count, nor does one among the others, as when a river
    moves. A strip of rows is in memory at a time, and what `sieve_raster` and `write_polygons` need.

    Args:
        before: the class raster of the earlier date.
        after: that of the later one, of the same grid.
        cleared: indices of the classes that count as cleared.
        minimum: smaller regions of the raster of changes take what surrounds them, see `sieve_raster`; None
            leaves them.
        output_raster: a GeoTIFF of the indices of `CHANGES`; nodata where either has none.
        output_polygons: GeoJSON or GeoPackage of what is newly cleared and regrown, by `write_polygons`.
        progress: called with each strip.

    Raises:
        ExtraMissingError: the extra ``geo`` is not installed.
        InputError: a file cannot be read or written, or the grids differ.
    """
    compared = 0
    counts = np.isin(np.arange(256), cleared)
    with open_classes(before) as earlier, open_classes(after) as later:
        places = Georeference.of(earlier), Georeference.of(later)
        if earlier.shape != later.shape or not same_grid(*places, *earlier.shape):
            raise InputError(
                "the rasters of the two dates are on different grids",
                value=f"{before} and {after}",
                hint="bring them onto one grid first, for instance with gdalwarp -r near",
            )
        place = next((one for one in places if one.located), places[0])
        strips = strip_rows(earlier, STRIP_PIXELS)
        with ClassWriter(output_raster, earlier.height, earlier.width, place, _COLOURS) as written:
            for index, rows in enumerate(strips):
                old, new = read_strip(earlier, rows), read_strip(later, rows)
                both = old.valid & new.valid
                changed = np.zeros(both.shape, dtype=np.uint8)
                was, now = counts[old.classes], counts[new.classes]
                changed[~was & now] = CHANGES.index("newly cleared")
                changed[was & ~now] = CHANGES.index("regrown")
                changed[~both] = NODATA
                compared += int(both.sum())
                written.write(changed)
                progress("comparing dates", index + 1, len(strips))
    if minimum is not None:
        sieve_in_place(output_raster, minimum, progress)
    newly, regrown = write_polygons(output_raster, output_polygons, CHANGES, progress)
    return Change(compared, newly, regrown)
