"""Two dates of one area."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.change import CHANGES, write_change
from wnn2hdl.apps.deforestation.class_raster import open_classes
from wnn2hdl.apps.deforestation.cleanup import MinimumSize
from wnn2hdl.dataset import cleared_classes
from wnn2hdl.errors import InputError
from wnn2hdl.raster import Georeference

pyogrio = pytest.importorskip("pyogrio")
pyproj = pytest.importorskip("pyproj")

Save = Callable[[Path, NDArray[np.uint8], Georeference], Path]

PLACE = Georeference(pyproj.CRS("EPSG:32720").to_wkt(), (10.0, 0.0, 500_000.0, 0.0, -10.0, 9_000_000.0))
BEFORE = np.array([[0, 0, 0, 1, 1, 2, 255, 0]], dtype=np.uint8)
AFTER = np.array([[0, 1, 2, 0, 1, 1, 1, 255]], dtype=np.uint8)

CLEARED = (1, 2)


def silent(step: str, done: int, total: int) -> None:
    pass


def test_newly_cleared_is_what_was_background_and_is_not(save_classes: Save, tmp_path: Path) -> None:
    before = save_classes(tmp_path / "before.tif", BEFORE, PLACE)
    after = save_classes(tmp_path / "after.tif", AFTER, PLACE)
    change = write_change(
        before, after, CLEARED, None, tmp_path / "change.tif", tmp_path / "change.gpkg", silent
    )
    with open_classes(tmp_path / "change.tif") as dataset:
        assert dataset.read(1).tolist() == [[0, 1, 1, 2, 0, 0, 255, 255]]
        assert dataset.crs.to_epsg() == 32720
    assert change.compared_pixels == 6
    assert (change.newly_cleared.pixels, change.regrown.pixels) == (2, 1)
    assert change.newly_cleared.hectares == pytest.approx(0.02 / 0.9996**2, rel=1e-6)
    _, _, _, fields = pyogrio.raw.read(tmp_path / "change.gpkg")
    assert fields[0].tolist() == list(CHANGES[1:])


def test_a_river_that_moves_clears_nothing(save_classes: Save, tmp_path: Path) -> None:
    river = cleared_classes(("forest", "pasture", "river"))
    assert river == (1,)
    before = save_classes(tmp_path / "before.tif", BEFORE, PLACE)
    after = save_classes(tmp_path / "after.tif", AFTER, PLACE)
    write_change(before, after, river, None, tmp_path / "change.tif", tmp_path / "change.gpkg", silent)
    with open_classes(tmp_path / "change.tif") as dataset:
        assert dataset.read(1).tolist() == [[0, 1, 0, 2, 0, 1, 255, 255]]


def test_the_dates_the_other_way_round_swap_what_is_found(save_classes: Save, tmp_path: Path) -> None:
    before = save_classes(tmp_path / "before.tif", BEFORE, PLACE)
    after = save_classes(tmp_path / "after.tif", AFTER, PLACE)
    outputs = tmp_path / "change.tif", tmp_path / "change.geojson"
    forwards, backwards = (
        write_change(before, after, CLEARED, None, *outputs, silent),
        write_change(after, before, CLEARED, None, *outputs, silent),
    )
    assert forwards.newly_cleared.pixels == backwards.regrown.pixels == 2
    assert forwards.regrown.pixels == backwards.newly_cleared.pixels == 1


@pytest.mark.parametrize(
    ("shape", "place"),
    [
        ((1, 7), PLACE),
        ((1, 8), Georeference(PLACE.crs, (10.0, 0.0, 500_010.0, 0.0, -10.0, 9_000_000.0))),
        ((1, 8), Georeference(pyproj.CRS("EPSG:32719").to_wkt(), PLACE.transform)),
    ],
)
def test_other_grids_are_refused(
    save_classes: Save, tmp_path: Path, shape: tuple[int, int], place: Georeference
) -> None:
    before = save_classes(tmp_path / "before.tif", BEFORE, PLACE)
    after = save_classes(tmp_path / "after.tif", np.zeros(shape, np.uint8), place)
    with pytest.raises(InputError, match="different grids"):
        write_change(
            before, after, CLEARED, None, tmp_path / "change.tif", tmp_path / "change.geojson", silent
        )
    assert not (tmp_path / "change.tif").exists()


def test_changes_below_the_limit_take_what_surrounds_them(save_classes: Save, tmp_path: Path) -> None:
    after = np.zeros((6, 9), dtype=np.uint8)
    after[1, 1], after[2:5, 4:8], after[3, 6] = 1, 1, 0
    before = save_classes(tmp_path / "before.tif", np.zeros_like(after), PLACE)
    later = save_classes(tmp_path / "after.tif", after, PLACE)
    outputs = tmp_path / "change.tif", tmp_path / "change.gpkg"
    change = write_change(before, later, CLEARED, MinimumSize(3), *outputs, silent)
    with open_classes(outputs[0]) as dataset:
        found = dataset.read(1)
    assert np.argwhere(found).tolist() == [[row, column] for row in (2, 3, 4) for column in (4, 5, 6, 7)]
    assert change.newly_cleared.pixels == 12


@pytest.mark.parametrize("located", [0, 1])
def test_one_date_that_is_located_locates_the_change(
    save_classes: Save, tmp_path: Path, located: int
) -> None:
    places = [Georeference(), Georeference()]
    places[located] = PLACE
    before = save_classes(tmp_path / "before.tif", BEFORE, places[0])
    after = save_classes(tmp_path / "after.tif", AFTER, places[1])
    outputs = tmp_path / "change.tif", tmp_path / "change.gpkg"
    change = write_change(before, after, CLEARED, None, *outputs, silent)
    assert change.newly_cleared.hectares == pytest.approx(0.02 / 0.9996**2, rel=1e-6)
