"""Class rasters as other programs see them."""

from pathlib import Path

import numpy as np
import pytest

from wnn2hdl.errors import InputError
from wnn2hdl.raster import NODATA, ClassWriter, Georeference, add_overviews

rasterio = pytest.importorskip("rasterio")

COLOURS = ((0, 120, 10), (200, 30, 40), (9, 8, 7))
PLACE = Georeference(rasterio.crs.CRS.from_epsg(32720).to_wkt(), (10.0, 0.0, 500.0, 0.0, -10.0, 900.0))


@pytest.mark.parametrize("step", [1, 100, 512, 777, 2000])
def test_rows_come_back_as_they_were_given(step: int, tmp_path: Path) -> None:
    classes = np.random.default_rng(0).integers(0, 3, (1300, 600), dtype=np.uint8)
    classes[:50, :50] = NODATA
    path = tmp_path / "classes.tif"
    with ClassWriter(path, 1300, 600, PLACE, COLOURS) as writer:
        for row in range(0, 1300, step):
            writer.write(classes[row : row + step])
    with rasterio.open(path) as source:
        assert np.array_equal(source.read(1), classes)
        assert source.nodata == NODATA
        assert source.crs.to_epsg() == 32720
        assert tuple(source.transform)[:6] == PLACE.transform
        assert source.block_shapes == [(512, 512)]
        assert source.profile["compress"] == "deflate"
        assert [source.colormap(1)[index][:3] for index in range(3)] == list(COLOURS)


def test_rows_given_one_by_one_take_no_more_space(tmp_path: Path) -> None:
    classes = np.random.default_rng(0).integers(0, 3, (1300, 600), dtype=np.uint8)
    for step in (100, 1300):
        with ClassWriter(tmp_path / f"{step}.tif", 1300, 600, PLACE, COLOURS) as writer:
            for row in range(0, 1300, step):
                writer.write(classes[row : row + step])
    assert (tmp_path / "100.tif").stat().st_size == (tmp_path / "1300.tif").stat().st_size


def test_a_raster_without_a_place_stays_without_one(tmp_path: Path) -> None:
    path = tmp_path / "classes.tif"
    with ClassWriter(path, 3, 4, Georeference(), COLOURS) as writer:
        writer.write(np.zeros((3, 4), dtype=np.uint8))
    with pytest.warns(rasterio.errors.NotGeoreferencedWarning):
        source = rasterio.open(path)
    assert Georeference.of(source) == Georeference()


def test_overviews_show_the_most_frequent_class(tmp_path: Path) -> None:
    path = tmp_path / "classes.tif"
    # Three of every four pixels are of class 1, now these, now those.
    quads = np.ones((300, 2, 550, 2), dtype=np.uint8)
    rows, columns = np.indices((300, 550))
    places = np.random.default_rng(0).integers(0, 2, (2, 300, 550))
    quads[rows, places[0], columns, places[1]] = 0
    classes = quads.reshape(600, 1100)
    with ClassWriter(path, 600, 1100, PLACE, COLOURS) as writer:
        writer.write(classes)
    add_overviews(path)
    with rasterio.open(path) as source:
        assert source.overviews(1) == [2, 4, 8]
        assert (source.read(1, out_shape=(300, 550)) == 1).all()


def test_an_error_leaves_no_file(tmp_path: Path) -> None:
    def fail() -> None:
        with ClassWriter(tmp_path / "classes.tif", 3, 4, PLACE, COLOURS):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fail()
    assert not list(tmp_path.iterdir())


def test_a_place_that_cannot_be_written_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"classes\.tif"):
        ClassWriter(tmp_path / "none" / "classes.tif", 3, 4, PLACE, COLOURS)
    assert not list(tmp_path.iterdir())
