"""Stimulus: every cared-for code, and nothing else."""

from types import ModuleType

import numpy as np
import pytest

from wnn2hdl.ir import bits_to_codes
from wnn2hdl.ir.pixels import bits_to_pixels
from wnn2hdl.verify import stimulus


@pytest.mark.parametrize("care", [1.0, 0.5])
def test_a_pixel_and_an_edge_filter_see_every_cared_for_code_once(circuits: ModuleType, care: float) -> None:
    block = circuits.random_block(4, care=care)
    pixels = stimulus.pixel(block.encoder, block.pixel_care)["rgb"]
    codes = block.encoder.codes(bits_to_pixels(pixels))[:, 0]
    assert codes.tolist() == np.flatnonzero(block.pixel_care).tolist()
    windows = stimulus.edge(block.window_care)["bits"]
    assert bits_to_codes(windows).tolist() == np.flatnonzero(block.window_care).tolist()


def test_a_matcher_sees_every_pair_of_windows() -> None:
    pairs = stimulus.match()
    words = bits_to_codes(pairs["bits"]) << 9 | bits_to_codes(pairs["reference_bits"])
    assert np.array_equal(np.unique(words), np.arange(1 << 18))


def test_a_block_sees_every_cared_for_window_made_of_cared_for_pixels(circuits: ModuleType) -> None:
    block = circuits.random_block(4, care=0.5)
    inputs = stimulus.block(block.model, block.encoder, block.pixel_care, block.window_care)
    assert inputs["window"].shape == (stimulus.BLOCK_WINDOWS, 216)
    assert block.cared(inputs).all()
    seen = np.unique(bits_to_codes(block.block(inputs)["bits"]))
    assert seen.tolist() == np.flatnonzero(block.window_care).tolist()


def test_references_equal_the_bits_differ_in_one_complement_them_and_are_random(circuits: ModuleType) -> None:
    block = circuits.random_block(4)
    window = stimulus.block(block.model, block.encoder, block.pixel_care, block.window_care)
    bits = block.block(window)["bits"]
    differing = (stimulus.with_references(window, bits)["reference_bits"] ^ bits).sum(axis=1)
    assert set(differing[0::4]) == {0}
    assert set(differing[1::4]) == {1}
    assert set(differing[2::4]) == {9}
    assert set(differing[3::4]) == set(range(10))


@pytest.mark.parametrize("care", [1.0, 0.5])
def test_a_neighbourhood_sees_every_cared_for_code_that_a_window_can_have(
    circuits: ModuleType, care: float
) -> None:
    neighbours = circuits.random_neighbours(4, care=care)
    windows = stimulus.neighbourhood(neighbours.encoder, neighbours.care)["window"]
    assert windows.shape == (stimulus.BLOCK_WINDOWS, 216)
    seen = np.unique(neighbours.codes(windows))
    assert neighbours.care[seen].all()
    # What random windows can have, by trying: the two taps of one pixel share a bit.
    tried = np.random.default_rng(0).random((20_000, 216)) < 0.5
    possible = np.unique(neighbours.codes(tried))
    assert set(seen.tolist()) == set(possible[neighbours.care[possible]].tolist())


def test_the_same_seed_gives_the_same_windows(circuits: ModuleType) -> None:
    neighbours = circuits.random_neighbours(4)
    one, other = (stimulus.neighbourhood(neighbours.encoder, neighbours.care)["window"] for _ in range(2))
    assert np.array_equal(one, other)
