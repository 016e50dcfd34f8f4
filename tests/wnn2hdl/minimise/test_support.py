import itertools

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from wnn2hdl.minimise.support import differences, members, minimum_supports, restrict


def partition(width: int, seed: int, care: float) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    values, cared = rng.random(1 << width) < 0.5, rng.random(1 << width) < care
    return values & cared, ~values & cared


def tells_apart(on: np.ndarray, off: np.ndarray, support: int) -> bool:
    return not {c & support for c in np.flatnonzero(on)} & {c & support for c in np.flatnonzero(off)}


@given(width=st.integers(1, 6), seed=st.integers(0, 999), care=st.sampled_from([0.05, 0.2, 0.5, 1.0]))
def test_supports_are_exactly_the_smallest_that_tell_on_from_off(width: int, seed: int, care: float) -> None:
    on, off = partition(width, seed, care)
    sufficient = [mask for mask in range(1 << width) if tells_apart(on, off, mask)]
    smallest = min(mask.bit_count() for mask in sufficient)
    assert minimum_supports(on, off) == [mask for mask in sufficient if mask.bit_count() == smallest]


@given(width=st.integers(1, 6), seed=st.integers(0, 999))
def test_differences_are_those_of_all_pairs(width: int, seed: int) -> None:
    on, off = partition(width, seed, 0.3)
    pairs = itertools.product(np.flatnonzero(on), np.flatnonzero(off))
    assert set(np.flatnonzero(differences(on, off))) == {a ^ b for a, b in pairs}


def test_one_support_can_serve_several_outputs() -> None:
    codes = np.arange(16)
    values = np.stack([codes >> 1 & 1, codes >> 3 & 1], axis=1).astype(bool)
    assert minimum_supports(values, ~values) == [0b1010]


def test_a_constant_needs_no_input() -> None:
    assert minimum_supports(np.ones(8, dtype=bool), np.zeros(8, dtype=bool)) == [0]


def test_sixteen_bits_are_exact() -> None:
    codes = np.arange(1 << 16)
    values = (codes >> 15 ^ codes >> 7 ^ codes) & 1 == 1
    assert minimum_supports(values, ~values) == [1 << 15 | 1 << 7 | 1]


@settings(max_examples=30)
@given(width=st.integers(1, 6), support=st.integers(0, 63), seed=st.integers(0, 99))
def test_restriction_keeps_the_order_of_the_inputs(width: int, support: int, seed: int) -> None:
    support &= (1 << width) - 1
    flags = np.random.default_rng(seed).random(1 << width) < 0.2
    wanted = np.zeros(1 << support.bit_count(), dtype=bool)
    for code in np.flatnonzero(flags):
        wanted[sum(1 << new for new, old in enumerate(members(support)) if code >> old & 1)] = True
    assert (restrict(flags, support) == wanted).all()
