"""Where rasters lie, and which files GDAL is let at."""

import os
import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.images import open_picture
from wnn2hdl.raster import Georeference, same_grid

rasterio = pytest.importorskip("rasterio")

PLACE = Georeference(rasterio.crs.CRS.from_epsg(32720).to_wkt(), (10.0, 0.0, 500.0, 0.0, -10.0, 900.0))


def test_the_same_place_is_the_same_grid() -> None:
    assert same_grid(PLACE, PLACE, 100, 100)
    assert same_grid(PLACE, replace(PLACE, transform=(10.0, 0.0, 500.09, 0.0, -10.0, 900.0)), 100, 100)
    assert not same_grid(PLACE, replace(PLACE, transform=(10.0, 0.0, 500.2, 0.0, -10.0, 900.0)), 100, 100)


def test_a_small_difference_of_scale_adds_up() -> None:
    other = replace(PLACE, transform=(10.0001, 0.0, 500.0, 0.0, -10.0, 900.0))
    assert same_grid(PLACE, other, 100, 100)
    assert not same_grid(PLACE, other, 100, 10_000)


def test_another_coordinate_system_is_another_grid() -> None:
    other = replace(PLACE, crs=rasterio.crs.CRS.from_epsg(32721).to_wkt())
    assert not same_grid(PLACE, other, 100, 100)


def test_a_system_tied_to_no_place_on_the_earth_gives_no_areas_but_a_grid() -> None:
    site = Georeference('LOCAL_CS["building site",UNIT["metre",1]]', PLACE.transform)
    assert PLACE.located
    assert not site.located
    assert same_grid(site, site, 100, 100)
    assert not same_grid(site, replace(site, transform=(10.0, 0.0, 600.0, 0.0, -10.0, 900.0)), 100, 100)


def test_what_has_no_place_contradicts_nothing() -> None:
    assert same_grid(PLACE, Georeference(), 100, 100)


@contextmanager
def changed(path: Path) -> Iterator[Any]:
    """A raster that is changed in place."""
    with warnings.catch_warnings(action="ignore"), rasterio.open(path, "r+") as raster:
        yield raster


def points(transform: Any, nudge: float = 0.0) -> list[Any]:
    """Control points of a picture of 40 x 70, the last of them off by ``nudge`` of its units."""
    a, b, c, d, e, f = tuple(transform)[:6]
    found = [
        rasterio.control.GroundControlPoint(row, column, a * column + b * row + c, d * column + e * row + f)
        for row, column in ((0, 0), (0, 70), (40, 0), (40, 70))
    ]
    found[-1].x += nudge
    return found


def test_control_points_that_an_affine_map_fits_locate_a_raster(save: Any, scene: NDArray[np.uint8]) -> None:
    transform = rasterio.Affine(10, 1, 500, 2, -10, 900)
    path = save(scene, photometric="rgb", crs="EPSG:32720", gcps=points(transform))
    found = open_picture(path).georeference
    assert found.transform == pytest.approx(tuple(transform)[:6])
    assert found.located
    path = save(scene, "bent.tif", photometric="rgb", crs="EPSG:32720", gcps=points(transform, nudge=3))
    with pytest.raises(InputError, match=r"4 control points .* no affine map"):
        _ = open_picture(path).georeference


def test_pixel_is_point_is_half_a_pixel_elsewhere(save: Any, scene: NDArray[np.uint8]) -> None:
    place = {"crs": "EPSG:32720", "transform": rasterio.Affine(10, 0, 500, 0, -10, 900)}
    path = save(scene, photometric="rgb", **place)
    with changed(path) as target:
        target.update_tags(AREA_OR_POINT="Point")
    assert open_picture(path).georeference.transform == (10, 0, 500, 0, -10, 900)


@pytest.fixture
def address() -> Iterator[tuple[str, list[str]]]:
    """An address that GDAL could read from, and what was asked for there."""
    asked: list[str] = []

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            asked.append(self.path)
            self.send_error(404)

        do_HEAD = do_GET  # noqa: N815  # the name that the server looks for

        def log_message(self, *_: Any) -> None:
            """Nothing is printed."""

    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"/vsicurl/http://127.0.0.1:{server.server_port}/x.tif", asked
        server.shutdown()


def virtual(target: str | Path) -> str:
    source = (
        f"<SimpleSource><SourceFilename>{target}</SourceFilename><SourceBand>1</SourceBand></SimpleSource>"
    )
    band = f'<VRTRasterBand dataType="Byte" band="1">{source}</VRTRasterBand>'
    return f'<VRTDataset rasterXSize="700" rasterYSize="600">{band}</VRTDataset>'


def pointing(target: str) -> str:
    item = f'<MDI key="OVERVIEW_FILE">{target}</MDI>'
    return f'<PAMDataset><Metadata domain="OVERVIEWS">{item}</Metadata></PAMDataset>'


@pytest.mark.parametrize("suffix", ["", ".msk", ".ovr", ".aux.xml", ".msk.aux.xml", "tag"])
@pytest.mark.parametrize("away", [False, True], ids=["file", "network"])
def test_files_that_point_at_others_are_refused(
    suffix: str, away: bool, save: Any, tmp_path: Path, address: tuple[str, list[str]]
) -> None:
    bands = np.random.default_rng(0).integers(0, 256, (3, 600, 700), dtype=np.uint8)
    secret = save(bands, "secret.tif", photometric="rgb")
    target = address[0] if away else str(secret)
    path = save(bands, photometric="rgb")
    if suffix == ".msk.aux.xml":
        with rasterio.Env(GDAL_TIFF_INTERNAL_MASK=False), changed(path) as raster:
            raster.write_mask(np.full((600, 700), 255, np.uint8))
    if suffix == "tag":
        with changed(path) as raster:
            raster.update_tags(ns="OVERVIEWS", OVERVIEW_FILE=target)
    else:
        text = pointing(target) if suffix.endswith("xml") else virtual(target)
        path.with_name(path.name + suffix).write_text(text)
    with pytest.raises(InputError, match=r"not a picture that can be read|may point at other files"):
        open_picture(path)
    assert address[1] == []


def test_a_pipe_beside_a_picture_is_not_waited_for(save: Any, scene: NDArray[np.uint8]) -> None:
    path = save(scene, photometric="rgb")
    os.mkfifo(path.with_suffix(".tfw"))
    with pytest.raises(InputError, match=r"scene\.tfw \(it is a pipe\)"):
        open_picture(path)


@pytest.mark.parametrize("name", ["a!b.tif", "a?b=c.tif", "zip:x.tif", "GTIFF_DIR:1:x.tif", "a#b %20.tif"])
def test_names_that_mean_something_to_gdal_are_names(
    name: str, save: Any, scene: NDArray[np.uint8], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    save(scene, photometric="rgb").rename(tmp_path / name)
    monkeypatch.chdir(tmp_path)
    assert np.array_equal(open_picture(Path(name)).read(0, 0, 40, 70)[0], np.moveaxis(scene, 0, 2))
