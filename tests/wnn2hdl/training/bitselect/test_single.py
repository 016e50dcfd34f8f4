from itertools import combinations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.ir import bits_to_codes, codes_to_bits
from wnn2hdl.training.bitselect.single import best_subset

WIDTH = 5
masses = st.lists(st.integers(-100, 100), min_size=1 << WIDTH, max_size=1 << WIDTH).map(np.array)


@given(masses, st.integers(0, WIDTH))
def test_no_other_choice_of_bits_is_better(
    mass: np.ndarray[tuple[int], np.dtype[np.int64]], size: int
) -> None:
    bits = codes_to_bits(np.arange(1 << WIDTH), WIDTH)
    scores = [
        np.abs(np.bincount(bits_to_codes(bits[:, chosen]), mass)).sum()
        for chosen in combinations(range(WIDTH), size)
    ]
    assert best_subset(mass, size).score == max(scores)


@given(masses, st.integers(1, WIDTH))
def test_mass_is_indexed_by_the_chosen_bits(
    mass: np.ndarray[tuple[int], np.dtype[np.int64]], size: int
) -> None:
    best = best_subset(mass, size)
    bits = codes_to_bits(np.arange(1 << WIDTH), WIDTH)[:, best.bits]
    assert best.mass.tolist() == np.bincount(bits_to_codes(bits), mass, 1 << size).tolist()
    assert best.score == np.abs(best.mass).sum()


def test_bits_that_decide_are_found() -> None:
    bits = codes_to_bits(np.arange(256), 8)
    mass = np.where(bits[:, 1] ^ bits[:, 6], 1, -1)
    assert best_subset(mass, 2).bits == (1, 6)
