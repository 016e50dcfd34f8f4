"""Town and country: repeatable, without seams, another each season, and full of things to navigate by."""

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.samples.country import paint
from wnn2hdl.samples.plane import Window


@pytest.fixture(scope="module")
def dry() -> NDArray[np.uint8]:
    return paint(1, Window(0, 0, 700, 800), "dry")


def test_any_window_shows_the_same_place_alike(dry: NDArray[np.uint8]) -> None:
    """The pieces lie across the borders of the tiles that the whole is made of."""
    for top, left, height, width in [(480, 470, 90, 101), (0, 0, 1, 1), (333, 700, 200, 100)]:
        part = paint(1, Window(top, left, height, width), "dry")
        assert np.array_equal(part, dry[top : top + height, left : left + width])


def test_land_goes_on_before_the_origin(dry: NDArray[np.uint8]) -> None:
    part = paint(1, Window(-40, -30, 50, 60), "dry")
    assert np.array_equal(part[40:, 30:], dry[:10, :30])
    assert part[:40].std() > 5


def test_a_season_changes_colours_but_not_places(dry: NDArray[np.uint8]) -> None:
    wet = paint(1, Window(0, 0, 700, 800), "wet")
    assert (dry != wet).any(axis=2).mean() > 0.8
    # Greener by far...
    greenness = [(2 * p[..., 1].astype(int) - p[..., 0] - p[..., 2]).mean() for p in (dry, wet)]
    assert greenness[1] > greenness[0] + 5
    # ...while most edges of the one lie within two pixels of the other's.
    edges = [cv2.Canny(cv2.cvtColor(p, cv2.COLOR_RGB2GRAY), 100, 200) > 0 for p in (dry, wet)]
    near = cv2.dilate(edges[1].astype(np.uint8), np.ones((5, 5), np.uint8)) > 0
    assert near[edges[0]].mean() > 0.6
    assert near.mean() < 0.6


def test_another_seed_is_another_country(dry: NDArray[np.uint8]) -> None:
    assert (paint(2, Window(0, 0, 200, 200), "dry") != dry[:200, :200]).any(axis=2).mean() > 0.9


def test_every_footprint_of_a_frame_shows_edges(dry: NDArray[np.uint8]) -> None:
    edges = cv2.Canny(cv2.cvtColor(dry, cv2.COLOR_RGB2GRAY), 100, 200) > 0
    shares = [edges[y : y + 200, x : x + 200].mean() for y in range(0, 501, 100) for x in range(0, 601, 100)]
    assert min(shares) > 0.005
    assert np.median(shares) > 0.03
