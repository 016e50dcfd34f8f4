"""Stimulus: every cared-for code, and nothing else."""

from types import ModuleType

import numpy as np
import pytest

from wnn2hdl.verify.vectors import BLOCK_WINDOWS, stimulus


@pytest.mark.parametrize("care", [1.0, 0.5])
def test_a_neighbourhood_sees_every_cared_for_code_that_a_window_can_have(
    circuits: ModuleType, care: float
) -> None:
    specification = circuits.random_neighbourhood(4, care=care)
    windows = stimulus(specification, "neighbourhood")["window"]
    assert windows.shape == (BLOCK_WINDOWS, 9, 3)
    seen = np.unique(specification.codes(windows))
    assert specification.care[seen].all()
    # What random windows can have, by trying: the two taps of one pixel share a bit.
    tried = np.random.default_rng(0).integers(0, 256, (20_000, 9, 3), dtype=np.uint8)
    possible = np.unique(specification.codes(tried))
    assert set(seen.tolist()) == set(possible[specification.care[possible]].tolist())


def test_the_same_seed_gives_the_same_windows(circuits: ModuleType) -> None:
    specification = circuits.random_neighbourhood(4)
    one, other = (stimulus(specification, "neighbourhood")["window"] for _ in range(2))
    assert np.array_equal(one, other)
