"""Whole scans: what is written, what it says, and that nothing half-written is left."""

import json
import resource
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.class_raster import open_classes
from wnn2hdl.apps.deforestation.classify import Method
from wnn2hdl.apps.deforestation.cleanup import MinimumSize
from wnn2hdl.apps.deforestation.local import run_locally
from wnn2hdl.apps.deforestation.mapping import Runner
from wnn2hdl.apps.deforestation.options import ScanOptions
from wnn2hdl.apps.deforestation.scanning import Scanner
from wnn2hdl.errors import InputError
from wnn2hdl.files import output_folder
from wnn2hdl.images import write_png
from wnn2hdl.ir import WisardModel
from wnn2hdl.raster import NODATA, Reading

rasterio = pytest.importorskip("rasterio")

Scan = Callable[..., dict[str, Any]]


@pytest.fixture
def scan(model_file: Path) -> Scan:
    """Scans a picture with the red model."""

    def run(
        picture: Path,
        output: Path,
        *,
        options: ScanOptions | None = None,
        before: Path | None = None,
        before_reading: Reading | None = None,
        run: Runner = partial(run_locally, 2),  # noqa: B008
    ) -> dict[str, Any]:
        scanner = Scanner.open(model_file, options or ScanOptions(), run, lambda *_: None)
        return scanner.scan(picture, output, before, before_reading)

    return run


def save_scene(path: Path, pixels: NDArray[np.unsignedinteger[Any]], east: float = 400_000) -> Path:
    """A GeoTIFF of 100 m per pixel on the central meridian's side of a UTM zone."""
    place = {"crs": "EPSG:32720", "transform": rasterio.Affine(100, 0, east, 0, -100, 9_100_000)}
    size = {"height": pixels.shape[0], "width": pixels.shape[1], "count": 3, "dtype": pixels.dtype.name}
    with rasterio.open(path, "w", driver="GTiff", photometric="rgb", **size, **place) as target:
        target.write(np.moveaxis(pixels, 2, 0))
    return path


def classes(folder: Path) -> NDArray[np.uint8]:
    with open_classes(folder / "classes.tif") as dataset:
        found: NDArray[np.uint8] = dataset.read(1)
        return found


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


def test_a_picture_becomes_a_map_polygons_an_overlay_and_a_summary(
    scan: Scan, picture_file: Path, pixels: NDArray[np.uint8], tmp_path: Path
) -> None:
    summary = scan(picture_file, tmp_path / "out")
    assert names(tmp_path / "out") == {
        "classes.tif", "polygons.geojson", "overlay.png", "summary.html", "summary.json", "summary.md"
    }  # fmt: skip
    cleared = pixels[..., 0] >= 96
    assert np.array_equal(classes(tmp_path / "out"), cleared)
    assert summary == json.loads((tmp_path / "out" / "summary.json").read_text())
    assert summary["deforested"]["pixels"] == cleared.sum()
    assert summary["deforested"]["share"] == cleared.mean()
    assert summary["deforested"]["hectares"] is None
    assert summary["coverage"]["share"] == (pixels[..., 0] >= 64).mean()
    assert (tmp_path / "out" / "summary.md").read_text().count("| deforested |") == 1


def test_foreign_imagery_is_told(
    scan: Scan, picture_file: Path, pixels: NDArray[np.uint8], tmp_path: Path
) -> None:
    write_png(tmp_path / "dark.png", pixels // 4)
    (warning,) = scan(tmp_path / "dark.png", tmp_path / "out")["warnings"]
    assert "foreign to the model: it knows the colours of" in warning
    assert f"**Warning:** {warning}" in (tmp_path / "out" / "summary.md").read_text()
    write_png(tmp_path / "bright.png", np.maximum(pixels, 64))
    assert scan(tmp_path / "bright.png", tmp_path / "out")["warnings"] == []


def test_georeferenced_scenes_have_areas(scan: Scan, pixels: NDArray[np.uint8], tmp_path: Path) -> None:
    summary = scan(save_scene(tmp_path / "a.tif", pixels), tmp_path / "out")
    hectares = [entry["hectares"] for entry in summary["classes"]]
    # A pixel of 100 m is a hectare on paper; the projection's scale there is about 0.9997.
    assert sum(hectares) == pytest.approx(pixels.size / 3, rel=2e-3)
    assert sum(hectares) > pixels.size / 3
    features = json.loads((tmp_path / "out" / "polygons.geojson").read_text())["features"]
    outlined = sum(feature["properties"]["area_ha"] for feature in features)
    assert summary["deforested"]["hectares"] == pytest.approx(outlined, rel=1e-6)
    with open_classes(tmp_path / "out" / "classes.tif") as dataset:
        assert dataset.crs.to_epsg() == 32720
        assert dataset.transform == rasterio.Affine(100, 0, 400_000, 0, -100, 9_100_000)
        assert dataset.nodata == NODATA


def test_small_regions_are_dissolved(scan: Scan, tmp_path: Path) -> None:
    pixels = np.full((60, 80, 3), 80, dtype=np.uint8)
    pixels[10:20, 10:20], pixels[40:44, 40:44] = 200, 200
    scene = save_scene(tmp_path / "a.tif", pixels)
    expected = pixels[..., 0] > 100
    assert np.array_equal(classes_of(scan, scene, tmp_path), expected)
    expected[40:44, 40:44] = False
    for options in (ScanOptions(minimum=MinimumSize(17)), ScanOptions(minimum=MinimumSize(hectares=16.5))):
        assert np.array_equal(classes_of(scan, scene, tmp_path, options), expected)
    write_png(tmp_path / "plain.png", pixels)
    with pytest.raises(InputError, match="no georeference"):
        scan(tmp_path / "plain.png", tmp_path / "plain", options=ScanOptions(minimum=MinimumSize(hectares=1)))
    assert not (tmp_path / "plain").exists()


def classes_of(
    scan: Scan, scene: Path, tmp_path: Path, options: ScanOptions | None = None
) -> NDArray[np.uint8]:
    scan(scene, tmp_path / "out", options=options)
    return classes(tmp_path / "out")


def test_clouds_are_left_out(
    scan: Scan, picture_file: Path, pixels: NDArray[np.uint8], tmp_path: Path
) -> None:
    clouds = np.zeros(pixels.shape[:2], dtype=np.uint8)
    clouds[:75] = 1
    write_png(tmp_path / "clouds.png", clouds)
    options = ScanOptions(Reading(exclude=tmp_path / "clouds.png"), Method(square=20))
    summary = scan(picture_file, tmp_path / "out", options=options)
    found = classes(tmp_path / "out")
    assert (found[:75] == NODATA).all()
    assert (found[75:] < 2).all()
    assert summary["classified_pixels"] == found[75:].size
    write_png(tmp_path / "clouds.png", np.ones_like(clouds))
    summary = scan(picture_file, tmp_path / "out", options=options)
    assert summary["warnings"] == ["no pixel is valid, so nothing was classified"]
    assert summary["deforested"]["share"] is None


@pytest.mark.parametrize("vector", ["geojson", "gpkg"])
def test_two_dates_give_what_was_cleared_between(vector: Any, scan: Scan, tmp_path: Path) -> None:
    before = np.full((60, 80, 3), 80, dtype=np.uint8)
    before[5:15, 5:15] = 200
    after = before.copy()
    after[30:40, 40:60], after[5:15, 5:10] = 200, 80
    scenes = [save_scene(tmp_path / f"{n}.tif", x) for n, x in (("before", before), ("after", after))]
    options = ScanOptions(vector=vector)
    summary = scan(scenes[1], tmp_path / "out", options=options, before=scenes[0])
    assert summary["change"]["newly_cleared"]["pixels"] == 200
    assert summary["change"]["regrown"]["pixels"] == 50
    assert summary["change"]["newly_cleared"]["hectares"] == pytest.approx(200, rel=2e-3)
    assert {"before", "change.tif", f"change.{vector}"} < names(tmp_path / "out")
    assert ".scan" not in names(tmp_path / "out")
    assert "newly cleared" in (tmp_path / "out" / "summary.md").read_text()


def test_dates_on_different_grids_are_refused_before_anything_is_written(
    scan: Scan, pixels: NDArray[np.uint8], tmp_path: Path
) -> None:
    after = save_scene(tmp_path / "after.tif", pixels)
    moved = save_scene(tmp_path / "moved.tif", pixels, east=400_050)
    smaller = save_scene(tmp_path / "smaller.tif", pixels[:-1])
    for before in (moved, smaller):
        with pytest.raises(InputError, match="different grids"):
            scan(after, tmp_path / "out", before=before)
    with pytest.raises(InputError, match="--vector none"):
        scan(after, tmp_path / "out", before=after, options=ScanOptions(vector="none"))
    assert not (tmp_path / "out").exists()


def test_a_folder_gives_each_picture_its_own_and_one_summary(
    scan: Scan, pixels: NDArray[np.uint8], tmp_path: Path
) -> None:
    chips = tmp_path / "chips"
    chips.mkdir()
    write_png(chips / "a.png", pixels[:50, :60])
    write_png(chips / "b.png", pixels[50:, 60:])
    summary = scan(chips, tmp_path / "out")
    assert names(tmp_path / "out") == {"a", "b", "summary.html", "summary.json", "summary.md"}
    cleared = (pixels[:50, :60, 0] >= 96).sum() + (pixels[50:, 60:, 0] >= 96).sum()
    assert summary["deforested"]["pixels"] == cleared
    assert [x["input"] for x in summary["pictures"]] == [str(chips / "a.png"), str(chips / "b.png")]
    write_png(chips / "a.jpg.png", pixels)
    (chips / "a.jpg.png").rename(chips / "a.jpeg")
    with pytest.raises(InputError, match="the same stem: "):
        scan(chips, tmp_path / "out")


def test_an_interrupted_folder_goes_on_with_the_next_picture(
    scan: Scan, pixels: NDArray[np.uint8], counting: Any, tmp_path: Path
) -> None:
    chips = tmp_path / "chips"
    chips.mkdir()
    for name in "abc":
        write_png(chips / f"{name}.png", pixels)
    with pytest.raises(KeyboardInterrupt):
        scan(chips, tmp_path / "out", run=counting(stop=2))
    assert names(tmp_path / "out") == {"a", "b"}
    again = counting()
    assert scan(chips, tmp_path / "out", run=again)["pixels"] == 3 * pixels[..., 0].size
    assert len(again.done) == 1
    (tmp_path / "out" / "b" / "classes.tif").unlink()
    scan(chips, tmp_path / "out", run=again)
    assert len(again.done) == 2
    scan(chips, tmp_path / "out", run=again, options=ScanOptions(method=Method(seed=1)))
    assert len(again.done) == 5


def test_an_interruption_leaves_nothing_half_written(
    scan: Scan, picture_file: Path, counting: Any, tmp_path: Path
) -> None:
    with pytest.raises(KeyboardInterrupt):
        scan(picture_file, tmp_path / "out", run=counting(stop=0))
    assert not (tmp_path / "out").exists()
    scan(picture_file, tmp_path / "out")
    assert ".scan" not in names(tmp_path / "out")


def test_files_of_an_earlier_scan_do_not_stay_beside_new_ones(
    scan: Scan, picture_file: Path, tmp_path: Path
) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "notes.txt").write_text("mine")
    scan(picture_file, tmp_path / "out", options=ScanOptions(vector="gpkg"))
    scan(picture_file, tmp_path / "out", options=ScanOptions(vector="none"))
    assert names(tmp_path / "out") == {
        "notes.txt",
        "classes.tif",
        "overlay.png",
        "summary.json",
        "summary.html",
        "summary.md",
    }


def test_equal_scans_write_equal_bytes(scan: Scan, pixels: NDArray[np.uint8], tmp_path: Path) -> None:
    scene = save_scene(tmp_path / "a.tif", pixels)
    for folder in ("one", "two"):
        scan(scene, tmp_path / folder, options=ScanOptions(method=Method(square=7, seed=5)))
    for name in ("classes.tif", "polygons.geojson", "overlay.png"):
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes()


def test_what_cannot_be_read_leaves_no_folder(scan: Scan, tmp_path: Path) -> None:
    (tmp_path / "text.png").write_text("hello")
    with pytest.raises(InputError, match=r"text\.png"):
        scan(tmp_path / "text.png", tmp_path / "out")
    with pytest.raises(InputError, match="No such file"):
        scan(tmp_path / "none.png", tmp_path / "out")
    (tmp_path / "empty").mkdir()
    with pytest.raises(InputError, match="no pictures"):
        scan(tmp_path / "empty", tmp_path / "out")
    flat = save_scene(tmp_path / "flat.tif", np.zeros((9, 9, 3), np.uint8), east=1e12)
    with pytest.raises(InputError, match="no area on the Earth"):
        scan(flat, tmp_path / "out")
    with pytest.raises(InputError, match="not with a folder"):
        scan(tmp_path, tmp_path / "out", before=tmp_path / "text.png")
    assert not (tmp_path / "out").exists()


def test_a_model_of_too_many_classes_is_refused(red_model: WisardModel, tmp_path: Path) -> None:
    many = WisardModel(
        red_model.encoder,
        tuple(f"class {index}" for index in range(256)),
        red_model.mapping,
        np.ones((256, 1, 8), dtype=np.int64),
        bleaching=1,
    )
    many.save(tmp_path / "many.json")
    with pytest.raises(InputError, match="at most 255 classes"):
        Scanner.open(tmp_path / "many.json", ScanOptions(), partial(run_locally, 1), lambda *_: None)


def test_what_is_read_is_not_written_over(
    scan: Scan, model_file: Path, pixels: NDArray[np.uint8], tmp_path: Path
) -> None:
    out = tmp_path / "out"
    (out / "before").mkdir(parents=True)
    picture = save_scene(out / "classes.tif", pixels)
    earlier = save_scene(out / "before" / "classes.tif", pixels)
    apart = save_scene(tmp_path / "a.tif", pixels)
    contents = [picture.read_bytes(), earlier.read_bytes()]
    for arguments in ({"picture": picture}, {"picture": apart, "before": earlier}):
        with pytest.raises(InputError, match=r"would write over what it reads: .*classes\.tif"):
            scan(output=out, **arguments)
    model_file.rename(out / "summary.json")
    with pytest.raises(InputError, match=r"would write over what it reads: .*summary\.json"):
        Scanner.open(out / "summary.json", ScanOptions(), partial(run_locally, 1), lambda *_: None).scan(
            apart, out
        )
    assert [picture.read_bytes(), earlier.read_bytes()] == contents


def test_the_earlier_date_has_clouds_of_its_own(
    scan: Scan, pixels: NDArray[np.uint8], tmp_path: Path
) -> None:
    clouds = np.zeros(pixels.shape[:2], dtype=np.uint8)
    clouds[:, 100:] = 1
    write_png(tmp_path / "clouds.png", clouds)
    before, after = (save_scene(tmp_path / name, pixels) for name in ("before.tif", "after.tif"))
    summary = scan(
        after, tmp_path / "out", before=before, before_reading=Reading(exclude=tmp_path / "clouds.png")
    )
    assert summary["classified_pixels"] == clouds.size
    assert summary["change"]["compared_pixels"] == clouds.size - clouds.sum()


def test_bad_input_leaves_no_folder(scan: Scan, picture_file: Path, tmp_path: Path) -> None:
    whole = picture_file.read_bytes()
    picture_file.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(InputError, match="damaged or truncated"):
        scan(picture_file, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_folder_takes_the_place_of_a_picture(scan: Scan, picture_file: Path, tmp_path: Path) -> None:
    scan(picture_file, tmp_path / "out")
    (tmp_path / "out" / ".scan").mkdir()
    (tmp_path / "out" / ".scan" / "windows").write_text("of a killed scan")
    scan(picture_file.parent, tmp_path / "out")
    assert names(tmp_path / "out") == {"picture", "summary.html", "summary.json", "summary.md"}


def test_a_folder_is_one_step_that_never_falls_back(model_file: Path, tmp_path: Path) -> None:
    (tmp_path / "chips").mkdir()
    for name, height in (("a", 40), ("b", 9000), ("c", 40)):
        write_png(tmp_path / "chips" / f"{name}.png", np.zeros((height, 900, 3), dtype=np.uint8))
    reported: list[tuple[str, int, int]] = []
    run = partial(run_locally, 1)
    scanner = Scanner.open(model_file, ScanOptions(), run, lambda *step: reported.append(step))
    scanner.scan(tmp_path / "chips", tmp_path / "out")
    assert {step for step, _, _ in reported} == {"scanning pictures"}
    done = [share for _, share, _ in reported]
    assert done == sorted(done)
    assert {total for _, _, total in reported} == {done[-1]}
    assert any(1000 < share < 2000 for share in done), "a large picture's windows are reported"


def test_a_damaged_picture_does_not_keep_others_of_a_folder_from_being_scanned(
    scan: Scan, pixels: NDArray[np.uint8], counting: Any, tmp_path: Path
) -> None:
    chips, out, run = tmp_path / "chips", tmp_path / "out", counting()
    chips.mkdir()
    for name in "abc":
        write_png(chips / f"{name}.png", pixels)
    (chips / "a.png").write_bytes((chips / "a.png").read_bytes()[:2000])
    with pytest.raises(InputError, match=r"1 of 3 pictures are not scanned: .*truncated: .*a\.png"):
        scan(chips, out, run=run)
    assert names(out) == {"b", "c"}
    assert len(run.done) == 2
    write_png(chips / "a.png", pixels)
    assert len(scan(chips, out, run=run)["pictures"]) == 3
    assert len(run.done) == 3


def levels(path: Path, pixels: NDArray[np.uint8], added: int, scale: float, offset: float) -> Path:
    """A scene in Sentinel-2's levels, with the scale and the offset that its file states."""
    save_scene(path, pixels.astype(np.uint16) * 12 + np.uint16(added))
    with rasterio.open(path, "r+") as target:
        target.scales, target.offsets = (scale,) * 3, (offset,) * 3
    return path


def test_dates_that_state_their_units_share_a_scale(
    scan: Scan, pixels: NDArray[np.uint8], tmp_path: Path
) -> None:
    before = levels(tmp_path / "before.tif", pixels, 0, 1e-4, 0.0)
    after = levels(tmp_path / "after.tif", pixels, 1000, 1e-4, -0.1)
    summary = scan(after, tmp_path / "out", options=ScanOptions(Reading(scale=(0, 0.3072))), before=before)
    assert summary["deforested"]["pixels"] > 0
    assert summary["change"]["newly_cleared"]["pixels"] == summary["change"]["regrown"]["pixels"] == 0


def test_dates_that_are_calibrated_otherwise_are_refused_or_scaled_each_by_itself(
    scan: Scan, pixels: NDArray[np.uint8], tmp_path: Path
) -> None:
    before = levels(tmp_path / "before.tif", pixels, 0, 1.0, 0.0)
    after = levels(tmp_path / "after.tif", pixels, 1000, 1.0, -0.1)
    with pytest.raises(InputError, match=r"offset 0, .* offset -0\.1, .*give --scale .* --before-scale"):
        scan(after, tmp_path / "out", options=ScanOptions(Reading(scale=(0, 3072))), before=before)
    assert not (tmp_path / "out").exists()
    options = ScanOptions(Reading(scale=(1000, 4072)))
    summary = scan(
        after, tmp_path / "out", options=options, before=before, before_reading=Reading(scale=(0, 3072))
    )
    assert summary["deforested"]["pixels"] > 0
    assert summary["change"]["newly_cleared"]["pixels"] == summary["change"]["regrown"]["pixels"] == 0
    assert summary["before_options"]["scale"] == [0, 3072]


def test_the_earlier_date_has_bands_of_its_own(scan: Scan, pixels: NDArray[np.uint8], tmp_path: Path) -> None:
    after = save_scene(tmp_path / "after.tif", pixels)
    before = save_scene(tmp_path / "before.tif", pixels[..., ::-1])
    assert scan(after, tmp_path / "a", before=before)["change"]["newly_cleared"]["pixels"] > 0
    reading = Reading(bands=(3, 2, 1))
    summary = scan(after, tmp_path / "b", before=before, before_reading=reading)
    assert summary["change"]["newly_cleared"]["pixels"] == 0


def test_pictures_of_a_folder_are_calibrated_alike(
    scan: Scan, pixels: NDArray[np.uint8], tmp_path: Path
) -> None:
    folder = tmp_path / "folder"
    folder.mkdir()
    levels(folder / "a.tif", pixels, 0, 1.0, 0.0)
    levels(folder / "b.tif", pixels, 1000, 1.0, -0.1)
    with pytest.raises(InputError, match=r"1 of 2 pictures are not scanned: .*mean different values"):
        scan(folder, tmp_path / "out", options=ScanOptions(Reading(scale=(0, 3072))))


def test_totals_of_a_folder_count_ground_once(scan: Scan, pixels: NDArray[np.uint8], tmp_path: Path) -> None:
    whole = scan(save_scene(tmp_path / "whole.tif", pixels), tmp_path / "whole")
    tiles = tmp_path / "tiles"
    tiles.mkdir()
    save_scene(tiles / "a.tif", pixels[:, :150])
    save_scene(tiles / "b.tif", pixels[:, 60:], east=400_000 + 60 * 100)
    summary = scan(tiles, tmp_path / "out")
    for figure in ("pixels", "share"):
        assert summary["deforested"][figure] == whole["deforested"][figure]
    assert summary["deforested"]["hectares"] == pytest.approx(whole["deforested"]["hectares"])
    assert summary["overlap"]["pictures"] == 1
    assert summary["overlap"]["pixels"] == 150 * 90
    assert summary["overlap"]["hectares"] == pytest.approx(150 * 90, rel=1e-3)
    assert any("1 of 2 pictures share ground with later ones" in x for x in summary["warnings"])
    assert "share ground" in (tmp_path / "out" / "summary.md").read_text()


def test_of_two_dates_in_a_folder_the_last_by_name_is_counted(scan: Scan, tmp_path: Path) -> None:
    dates = tmp_path / "dates"
    dates.mkdir()
    for name, level in (("2023", 200), ("2024", 80)):
        save_scene(dates / f"{name}.tif", np.full((50, 60, 3), level, dtype=np.uint8))
    summary = scan(dates, tmp_path / "out")
    assert summary["deforested"]["pixels"] == 0
    assert summary["classified_pixels"] == 50 * 60
    assert [x["deforested"]["pixels"] for x in summary["pictures"]] == [50 * 60, 0]


def test_pictures_that_lie_nowhere_are_taken_to_lie_apart(
    scan: Scan, pixels: NDArray[np.uint8], tmp_path: Path
) -> None:
    (tmp_path / "pictures").mkdir()
    for name in "ab":
        write_png(tmp_path / "pictures" / f"{name}.png", pixels)
    summary = scan(tmp_path / "pictures", tmp_path / "out")
    assert summary["overlap"] == {"pictures": 0, "pixels": 0, "hectares": None}
    assert summary["classified_pixels"] == 2 * pixels[..., 0].size


def test_two_scans_into_one_folder_are_refused(scan: Scan, picture_file: Path, tmp_path: Path) -> None:
    with (
        output_folder(tmp_path / "out", "scan"),
        pytest.raises(InputError, match="another process is writing"),
    ):
        scan(picture_file, tmp_path / "out")


@pytest.mark.parametrize("room", [0, 100, 2_000, 20_000, 60_000])
def test_a_full_disk_is_one_line_and_leaves_nothing_half_written(
    room: int, scan: Scan, pixels: NDArray[np.uint8], tmp_path: Path
) -> None:
    scene = save_scene(tmp_path / "a.tif", np.tile(pixels, (4, 4, 1)))
    options = ScanOptions(vector="gpkg")
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (room, hard))
    try:
        with pytest.raises(InputError) as caught:
            scan(scene, tmp_path / "out", options=options)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert "\n" not in str(caught.value)
    assert not (tmp_path / "out").exists() or names(tmp_path / "out") <= {".scan"}
    scan(scene, tmp_path / "out", options=options)
    scan(scene, tmp_path / "undisturbed", options=options)
    for file in (tmp_path / "undisturbed").iterdir():
        assert file.read_bytes() == (tmp_path / "out" / file.name).read_bytes()


HOSTILE = "=1|<script>`*a*`\n# b\"'&"


def test_no_name_changes_a_summary(red_model: WisardModel, pixels: NDArray[np.uint8], tmp_path: Path) -> None:
    model = replace(red_model, classes=("forest", HOSTILE + "x" * 5000))
    model.save(tmp_path / "model.json")
    folder = tmp_path / HOSTILE.replace("/", "")
    folder.mkdir()
    write_png(folder / f"{HOSTILE}.png", pixels)
    scanner = Scanner.open(tmp_path / "model.json", ScanOptions(), partial(run_locally, 1), lambda *_: None)
    summary = scanner.scan(folder, tmp_path / "out")
    assert summary["classes"][1]["class"] == HOSTILE + "x" * 5000
    assert names(tmp_path / "out") == {HOSTILE, "summary.html", "summary.json", "summary.md"}
    page = (tmp_path / "out" / "summary.md").read_text()
    headings = [line for line in page.splitlines() if line.startswith("#")]
    assert [line.split()[1] for line in headings] == ["Scan", "Pictures", "How"]
    assert "<script>" not in page.replace("\\<script\\>", "")
    rows = [line.replace("\\|", "") for line in page.splitlines() if line.startswith("|")]
    assert {row.count("|") for row in rows} == {5, 3}
