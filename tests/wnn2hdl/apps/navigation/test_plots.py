"""Pictures of a flight: not empty, equal for equal results, and in colours that can be distinguished."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from numpy.typing import ArrayLike, NDArray
from PIL import Image

from wnn2hdl.apps.navigation.plots import COLOURS, _scale_bar, plot_errors, plot_tracks
from wnn2hdl.apps.navigation.results import FlightResult, FrameFix, MethodResult, SearchResult

PICTURE = np.full((300, 400, 3), 128, dtype=np.uint8)


def to_pixel(latitude: ArrayLike, longitude: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """A degree is a metre, a pixel is half a metre; the origin is the picture's middle."""
    return 150 - 2 * np.asarray(latitude, float), 200 + 2 * np.asarray(longitude, float)


def method(name: str, off: float, *, missing: int = -1) -> MethodResult:
    fixes = []
    for number in range(6):
        north, east = 5.0 * number, 8.0 * number - 20
        fix = FrameFix(
            f"{number}.jpg",
            north,
            east,
            north + off,
            east + off,
            abs(off) * 2**0.5,
            None,
            1.0,
            number != 2,
            0.1,
        )
        lost = replace(fix, latitude=None, longitude=None, error_m=None, fixed=False)
        fixes.append(lost if number == missing else fix)
    return MethodResult(name, tuple(fixes))


METHODS = (method("perspective + Canny", 5, missing=3), method("rotation + Canny", -9))
WINDOW, WHOLE = SearchResult("window", 95.0, METHODS), SearchResult("map", None, METHODS)
FLIGHT = FlightResult("map.tif", 0.5, 750, (10.0,), (), (WINDOW, WHOLE))


def pixels(path: Path) -> NDArray[np.uint8]:
    with Image.open(path) as picture:
        return np.asarray(picture.convert("RGB"))


def has_colour(picture: NDArray[np.uint8], colour: str) -> bool:
    wanted = np.rint(255 * np.array(to_rgb(colour)))
    return bool((np.abs(picture - wanted).max(axis=2) < 3).sum() > 20)


def test_the_error_plot_has_a_bar_a_method_and_its_names(tmp_path: Path) -> None:
    picture, drawing = plot_errors(FLIGHT, tmp_path / "errors")
    shown = pixels(picture)
    assert has_colour(shown, COLOURS[0])
    assert has_colour(shown, COLOURS[1])
    assert not has_colour(shown, COLOURS[2])
    text = drawing.read_text(encoding="utf-8")
    for words in ("perspective + Canny", "7.1 ± 0.0 m", "within ±95 m", "the whole map", "blind guess"):
        assert words in text


def test_the_map_shows_truth_and_tracks_with_a_legend_and_a_scale(tmp_path: Path) -> None:
    picture, drawing = plot_tracks(WINDOW, PICTURE, to_pixel, 0.5, tmp_path / "tracks")
    shown = pixels(picture)
    assert has_colour(shown, COLOURS[0])
    assert has_colour(shown, COLOURS[1])
    text = drawing.read_text(encoding="utf-8")
    for words in ("truth", "perspective + Canny", "rotation + Canny", "within ±95 m"):
        assert words in text


def test_the_map_is_cut_to_the_tracks(tmp_path: Path) -> None:
    """Red ground far from the track is not shown; red ground beside it is."""
    far, near = PICTURE.copy(), PICTURE.copy()
    far[:, :10] = near[100:110, 200:210] = (255, 0, 0)
    pale = "#ff4040"  # a quarter of white shows through
    for name, ground, seen in (("far", far, False), ("near", near, True)):
        picture, _ = plot_tracks(WINDOW, ground, to_pixel, 0.5, tmp_path / name)
        assert has_colour(pixels(picture), pale) == seen


def test_a_large_map_is_shown_smaller(tmp_path: Path) -> None:
    wide = np.zeros((300, 9000, 3), dtype=np.uint8)
    far = replace(METHODS[1].fixes[0], longitude=4300.0)
    search = replace(WHOLE, methods=(METHODS[0], MethodResult("rotation + Canny", (far,))))
    picture, drawing = plot_tracks(search, wide, to_pixel, 0.5, tmp_path / "wide")
    assert pixels(picture).shape[1] < 1600
    assert drawing.stat().st_size < 1_000_000


@pytest.mark.parametrize(
    ("width_m", "label", "share"),
    [(150, "20 m", 20 / 150), (400, "100 m", 0.25), (5193, "1 km", 1000 / 5193), (1.9, "0.2 m", 0.2 / 1.9)],
)
def test_the_scale_is_a_round_number_and_at_most_a_quarter(width_m: float, label: str, share: float) -> None:
    axes = Figure().add_subplot()
    _scale_bar(axes, width_m)
    (bar,) = axes.patches
    assert isinstance(bar, Rectangle)
    assert bar.get_width() == pytest.approx(share)
    assert [text.get_text() for text in axes.texts] == [label]


def test_a_method_without_positions_leaves_its_place_empty(tmp_path: Path) -> None:
    lost = MethodResult(
        "lost",
        tuple(
            replace(fix, latitude=None, longitude=None, error_m=None, fixed=False) for fix in METHODS[0].fixes
        ),
    )
    search = replace(WINDOW, methods=(lost, METHODS[1]))
    _, drawing = plot_errors(replace(FLIGHT, searches=(search,)), tmp_path / "errors")
    assert "no position" in drawing.read_text(encoding="utf-8")
    plot_tracks(search, PICTURE, to_pixel, 0.5, tmp_path / "tracks")


def test_equal_results_give_equal_bytes(tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        plot_errors(FLIGHT, tmp_path / name / "errors")
        plot_tracks(WINDOW, PICTURE, to_pixel, 0.5, tmp_path / name / "tracks")
    for file in ("errors.png", "errors.svg", "tracks.png", "tracks.svg"):
        assert (tmp_path / "a" / file).read_bytes() == (tmp_path / "b" / file).read_bytes()


def test_colours_differ_in_lightness_or_hue_even_without_red_and_green() -> None:
    """Simulated deuteranopia (Viénot and others, 1999, in linear light) keeps all pairs apart."""
    linear = np.array([to_rgb(colour) for colour in COLOURS]) ** 2.2
    seen = linear @ np.array([[0.29275, 0.70725, 0], [0.29275, 0.70725, 0], [-0.02234, 0.02234, 1]]).T
    seen = np.clip(seen, 0, 1) ** (1 / 2.2)
    distances = np.linalg.norm(seen[:, np.newaxis] - seen, axis=2)
    assert distances[~np.eye(len(COLOURS), dtype=bool)].min() > 0.1


@pytest.mark.parametrize("count", [1, 2])
def test_one_panel_a_search(count: int, tmp_path: Path) -> None:
    picture, _ = plot_errors(replace(FLIGHT, searches=FLIGHT.searches[:count]), tmp_path / "errors")
    assert pixels(picture).shape[1] == pytest.approx(150 * (1.2 + 4.2 * count), abs=2)
