"""The map over its picture."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.apps.deforestation.overlay import overlay, overlay_palette, write_overlay
from wnn2hdl.images import read_rgb
from wnn2hdl.raster import Georeference
from wnn2hdl.samples import landscape

Save = Callable[[Path, NDArray[np.uint8], Georeference], Path]
PALETTE = overlay_palette(("forest", "deforested"))


def test_forest_turns_green_and_clearings_red_and_the_picture_is_seen() -> None:
    picture = landscape(64, 64, seed=2).image
    everywhere = np.ones((64, 64), dtype=np.bool_)
    for index, channel in ((0, 1), (1, 0)):
        tinted = overlay(picture, np.full((64, 64), index, np.uint8), everywhere, PALETTE)
        assert (tinted.argmax(axis=2) == channel).all()
        light = np.corrcoef(picture.mean(axis=2).ravel(), tinted.mean(axis=2).ravel())[0, 1]
        assert light > 0.95


def test_what_was_not_classified_is_left_as_it_is() -> None:
    picture = np.full((2, 2, 3), 100, dtype=np.uint8)
    valid = np.array([[True, False], [False, True]])
    tinted = overlay(picture, np.full((2, 2), 255, np.uint8) * ~valid, valid, PALETTE)
    assert ((tinted == 100).all(axis=2) == ~valid).all()


def test_more_classes_have_their_own_colours() -> None:
    assert overlay_palette(("forest", "burnt soil", "river")).colours[2] == (58, 120, 192)


def test_a_large_raster_is_thinned_and_its_picture_asked_for_in_that_size(
    save_classes: Save, tmp_path: Path
) -> None:
    pytest.importorskip("rasterio")
    classes = np.zeros((60, 120), dtype=np.uint8)
    classes[:, 60:] = 1
    raster = save_classes(tmp_path / "c.tif", classes, Georeference())
    asked = []

    def grey(height: int, width: int) -> NDArray[np.uint8]:
        asked.append((height, width))
        return np.full((height, width, 3), 128, dtype=np.uint8)

    write_overlay(grey, raster, tmp_path / "o.png", PALETTE, max_side=40)
    assert asked == [(20, 40)]
    found = read_rgb(tmp_path / "o.png")
    assert found.shape == (20, 40, 3)
    assert (found[:, :20].argmax(axis=2) == 1).all()
    assert (found[:, 20:].argmax(axis=2) == 0).all()
