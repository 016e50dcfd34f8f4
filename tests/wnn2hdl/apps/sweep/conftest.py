"""Pixel sets that the sweep's tests share."""

import pytest

from wnn2hdl.apps.sweep.grid import Plan, Recipe, grid
from wnn2hdl.apps.sweep.pixels import PixelSets, draw
from wnn2hdl.dataset import from_samples
from wnn2hdl.encode import high_bits


@pytest.fixture(scope="session")
def sets() -> PixelSets:
    """2,000 training pixels of four small landscapes."""
    return draw(from_samples(4, 64, seed=3), pixels=2_000, seed=0, progress=lambda *_: None)


@pytest.fixture(scope="session")
def recipe() -> Recipe:
    """The reference design's pixel bits, everything else chosen automatically."""
    return Recipe(seed=5, bits=high_bits().bits, bleaching=None, care_minimum=1)


@pytest.fixture(scope="session")
def plan(recipe: Recipe) -> Plan:
    """Six architectures, three trials each."""
    return grid(recipe, (2, 3, 4), (3, 6), trials=3)
