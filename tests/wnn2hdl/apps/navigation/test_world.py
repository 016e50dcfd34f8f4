"""Maps: any coordinate system and a turned transform become one north-up metric grid."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rasterio
from affine import Affine
from numpy.typing import NDArray
from PIL import Image
from pyproj import Geod

from wnn2hdl.apps.navigation.world import WorldMap
from wnn2hdl.errors import InputError
from wnn2hdl.raster import Reading

LATITUDE, LONGITUDE = 24.26, 120.72
DEGREES = Affine(4.93e-6, 4.0e-8, LONGITUDE, 2.0e-8, -4.51e-6, LATITUDE)
"""About 0.5 m per pixel, turned by half a degree."""
METRES = Affine(0.5, 0, 268_600, 0, -0.5, 2_684_800)
"""In UTM zone 51 north."""


def dots(shape: tuple[int, int] = (300, 400)) -> NDArray[np.uint8]:
    """Smooth round marks at rows and columns 40, 120, 200, ..."""
    rows, columns = np.mgrid[: shape[0], : shape[1]]
    distance = np.hypot((rows - 40 + 40) % 80 - 40, (columns - 40 + 40) % 80 - 40)
    mark = np.clip(255 * np.exp(-((distance / 4) ** 2)), 1, 255).astype(np.uint8)
    return np.repeat(mark[..., None], 3, axis=-1)


def written(path: Path, image: NDArray[Any], **profile: Any) -> Path:
    bands = np.moveaxis(image, -1, 0)
    size = {"count": len(bands), "height": bands.shape[1], "width": bands.shape[2]}
    with rasterio.open(path, "w", driver="GTiff", dtype=image.dtype, **size, **profile) as dataset:
        dataset.write(bands)
    return path


@pytest.mark.parametrize(
    ("crs", "transform"), [("EPSG:4326", DEGREES), ("EPSG:32651", METRES)], ids=["degrees", "metres"]
)
def test_marks_stay_where_they_are(crs: str, transform: Affine, tmp_path: Path) -> None:
    world = WorldMap.of_array(dots(), transform, crs)
    assert world.gsd_m == pytest.approx(0.5, abs=0.002)
    grid = world.resampled()
    rows, columns = (axis.ravel() for axis in np.meshgrid([40.0, 120, 200], [120.0, 200, 280]))
    there = grid.to_pixel(*world.to_geographic(rows, columns))
    for row, column in zip(*there, strict=True):
        part = np.s_[round(row) - 12 : round(row) + 13, round(column) - 12 : round(column) + 13]
        weight = grid.image[part][..., 0].astype(float) - 1
        found = [(axis * weight).sum() / weight.sum() for axis in np.mgrid[part]]
        assert found == pytest.approx([row, column], abs=0.05)
    from_file = WorldMap.read(written(tmp_path / "map.tif", dots(), crs=crs, transform=transform)).resampled()
    assert (from_file.image == grid.image).all()
    assert (from_file.valid == grid.valid).all()


def test_a_grid_is_metric_and_north_up() -> None:
    grid = WorldMap.of_array(dots((2000, 3000)), DEGREES, "EPSG:4326").resampled(1.0)
    geod = Geod(ellps="WGS84")
    latitude, longitude = grid.to_geographic([100.0, 100.0, 900.0], [100.0, 1300.0, 100.0])
    east, south = (geod.inv(longitude[0], latitude[0], longitude[i], latitude[i]) for i in (1, 2))
    assert east[2] == pytest.approx(1200, abs=0.001)
    assert south[2] == pytest.approx(800, abs=0.001)
    assert abs(south[0]) == pytest.approx(180, abs=0.01)


def test_conversions_are_each_other_s_inverse() -> None:
    world = WorldMap.of_array(dots(), DEGREES, "EPSG:4326")
    for place in (world, world.resampled(0.7)):
        assert place.to_pixel(*place.to_geographic(12.25, 345.5)) == pytest.approx((12.25, 345.5), abs=1e-6)


def test_a_coarse_grid_averages() -> None:
    board = np.zeros((400, 400, 3), dtype=np.uint8)
    board[::2, ::2] = board[1::2, 1::2] = 254
    grid = WorldMap.of_array(board, METRES, "EPSG:32651").resampled(4.0)
    inner = grid.image[5:-5, 5:-5].astype(int)
    assert abs(inner - 127).max() <= 3


@pytest.mark.parametrize("plain", [0, 255])
def test_plain_margins_of_a_mosaic_are_no_map(plain: int) -> None:
    image = dots()
    image[:, :150] = plain
    image[100:103, 300:303] = plain
    grid = WorldMap.of_array(image, METRES, "EPSG:32651").resampled()
    assert grid.valid.mean() == pytest.approx(250 / 400, abs=0.03)
    rows, columns = np.nonzero(grid.valid)
    centre = [
        axis.mean()
        for axis in grid.to_pixel(*WorldMap.of_array(image, METRES, "EPSG:32651").to_geographic(149.5, 275.0))
    ]
    assert [rows.mean(), columns.mean()] == pytest.approx(centre, abs=2)


def test_no_data_is_no_map(tmp_path: Path) -> None:
    image = dots()
    image[:, 300:] = 77
    path = written(tmp_path / "map.tif", image, crs="EPSG:32651", transform=METRES, nodata=77)
    assert WorldMap.read(path).resampled().valid.mean() == pytest.approx(300 / 400, abs=0.03)


def test_bad_maps_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot read the picture"):
        WorldMap.read(tmp_path / "none.tif")
    (tmp_path / "text.tif").write_text("no map")
    with pytest.raises(InputError, match="not a picture"):
        WorldMap.read(tmp_path / "text.tif")
    Image.fromarray(dots()).save(tmp_path / "plain.tif")
    with pytest.raises(InputError, match="no georeference"):
        WorldMap.read(tmp_path / "plain.tif")
    deep = written(tmp_path / "deep.tif", dots().astype(np.uint16), crs="EPSG:32651", transform=METRES)
    with pytest.raises(InputError, match=r"samples are uint16.*--scale"):
        WorldMap.read(deep)


PLACE: dict[str, Any] = {"crs": "EPSG:32651", "transform": METRES}


def coloured() -> NDArray[np.uint8]:
    """Another picture in each channel."""
    return np.stack([dots()[..., 0], dots()[::-1, :, 0], dots()[:, ::-1, 0]], axis=-1)


def test_bands_are_taken_as_the_file_names_them(tmp_path: Path) -> None:
    path = written(tmp_path / "bgr.tif", coloured()[..., ::-1], photometric="minisblack", **PLACE)
    with rasterio.open(path, "r+") as dataset:
        dataset.colorinterp = [rasterio.enums.ColorInterp[name] for name in ("blue", "green", "red")]
    straight = WorldMap.read(written(tmp_path / "rgb.tif", coloured(), photometric="rgb", **PLACE))
    assert (WorldMap.read(path).resampled().image == straight.resampled().image).all()


def test_bands_and_values_that_the_file_does_not_tell_are_named_by_the_user(tmp_path: Path) -> None:
    four = np.concatenate([coloured()[..., ::-1], dots()[..., :1]], axis=-1)
    path = written(tmp_path / "four.tif", four.astype(np.uint16) * 10, photometric="minisblack", **PLACE)
    with pytest.raises(InputError, match="which of its 4 bands"):
        WorldMap.read(path)
    chosen = WorldMap.read(path, Reading(bands=(3, 2, 1), scale=(0, 2550)))
    straight = WorldMap.read(written(tmp_path / "rgb.tif", coloured(), photometric="rgb", **PLACE))
    assert (chosen.resampled().image == straight.resampled().image).all()


def test_indices_of_a_colour_table_become_its_colours(tmp_path: Path) -> None:
    path = written(tmp_path / "map.tif", dots()[..., :1], photometric="palette", **PLACE)
    with rasterio.open(path, "r+") as dataset:
        dataset.write_colormap(1, {level: (255 - level, level, 7, 255) for level in range(256)})
    image = WorldMap.read(path).resampled().image
    assert (image[20:-20, 20:-20, 2] == 7).all()
    assert (image[20:-20, 20:-20, :2].sum(axis=-1) == 255).mean() > 0.9


def test_a_damaged_map_is_refused(tmp_path: Path) -> None:
    path = written(tmp_path / "map.tif", dots(), crs="EPSG:32651", transform=METRES)
    path.write_bytes(path.read_bytes()[:100_000])
    with pytest.raises(InputError, match=r"damaged or truncated: .*map\.tif"):
        WorldMap.read(path).resampled()


@pytest.mark.parametrize(
    ("transform", "crs", "fault"),
    [
        (Affine(0.5, 0, 268_600, 0.5, 0, 2_684_800), "EPSG:32651", "no size on the ground"),
        (METRES, 'LOCAL_CS["site",UNIT["metre",1]]', "coordinate system does not give latitudes"),
        (Affine(0.5, 0, 1e9, 0, -0.5, 1e9), "EPSG:32651", "not on the earth"),
        (Affine(5000, 0, 268_600, 0, -5000, 2_684_800), "EPSG:32651", "too large to be laid on a grid"),
        (Affine(0.001, 0, 268_600, 0, -0.001, 2_684_800), "EPSG:32651", "less than 3x3 pixels"),
    ],
)
def test_maps_of_no_use_are_refused(transform: Affine, crs: str, fault: str) -> None:
    with pytest.raises(InputError, match=fault):
        WorldMap.of_array(dots(), transform, crs).resampled(2.0)


@pytest.mark.realdata
@pytest.mark.parametrize(("flight", "gsd", "valid"), [("fengyuan", 0.500, 0.99), ("seneca", 0.462, 0.44)])
def test_real_maps(realdata: Path, flight: str, gsd: float, valid: float) -> None:
    world = WorldMap.read(realdata / f"flight_{flight}" / "map.tif")
    assert world.gsd_m == pytest.approx(gsd, abs=0.001)
    assert world.resampled().valid.mean() == pytest.approx(valid, abs=0.01)
