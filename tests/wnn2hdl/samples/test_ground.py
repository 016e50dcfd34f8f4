"""The layout of a landscape before any colour."""

import numpy as np
import pytest

from wnn2hdl.samples.ground import CLASSES, FOREST, PASTURE, RIVER, ROAD, Ground, lay_out


@pytest.fixture(scope="module")
def ground() -> Ground:
    return lay_out(np.random.default_rng(2), (400, 500), 2)


def test_fields_have_the_pictures_shape(ground: Ground) -> None:
    assert ground.labels.shape == ground.relief.shape == ground.bank.shape == (400, 500)
    assert ground.along.shape == ground.across.shape == (400, 500)
    assert ground.lot.shape == (4, 400, 500)
    assert ground.labels.max() < len(CLASSES)


def test_water_is_where_the_bank_is_negative_except_under_bridges(ground: Ground) -> None:
    assert np.array_equal(ground.labels == RIVER, (ground.bank < 0) & (ground.labels != ROAD))


def test_forest_stands_along_the_river(ground: Ground) -> None:
    bank = ground.labels[(ground.bank > 0) & (ground.bank < 2)]
    assert (np.isin(bank, (FOREST, ROAD))).mean() > 0.9


def test_pastures_lie_nearer_to_the_highway_than_forest(ground: Ground) -> None:
    distance = np.abs(ground.across - 900 * np.round(ground.across / 900))
    assert distance[ground.labels == PASTURE].mean() < distance[ground.labels == FOREST].mean()
