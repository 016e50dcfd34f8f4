import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wnn2hdl.minimise.decompose import _colour, _conflicts, decompose, expected_luts, mux_tree
from wnn2hdl.minimise.draft import Draft


def value_of(draft: Draft, signal: int) -> np.ndarray:
    draft.outputs = [signal]
    bits = (np.arange(1 << draft.width) >> np.arange(draft.width)[:, np.newaxis] & 1).astype(np.uint8)
    return draft.evaluate(bits)[signal].astype(bool)


@settings(max_examples=40, deadline=None)
@given(
    width=st.integers(1, 9),
    care=st.sampled_from([0.05, 0.3, 1.0]),
    seed=st.integers(0, 999),
    breadth=st.sampled_from([(), (3,), (2, 2)]),
)
def test_decompositions_respect_on_and_off(
    width: int, care: float, seed: int, breadth: tuple[int, ...]
) -> None:
    rng = np.random.default_rng(seed)
    values, cared = rng.random(1 << width) < 0.5, rng.random(1 << width) < care
    on, off = values & cared, ~values & cared
    searched, plain = Draft(width), Draft(width)
    everything = tuple(range(width))
    for result in (
        value_of(searched, decompose(searched, everything, on, off, rng, breadth)),
        value_of(plain, mux_tree(plain, everything, on, off)),
    ):
        assert result[on].all()
        assert not result[off].any()


@pytest.mark.parametrize("overlap", [0, 1])
def test_a_hidden_lut_is_found_even_if_it_shares_a_signal(overlap: int) -> None:
    width = 11 - overlap
    codes = np.arange(1 << width)
    rng = np.random.default_rng(1)
    inner, outer = rng.random(64) < 0.5, rng.random(64) < 0.5
    values = outer[inner[codes & 63].astype(int) + (codes >> (6 - overlap)) * 2 & 63]
    draft = Draft(width)
    value_of(draft, decompose(draft, tuple(range(width)), values, ~values, rng))
    assert draft.cost()[0] == 2


@given(width=st.integers(2, 5), seed=st.integers(0, 99))
def test_conflicting_columns_are_on_and_off_in_some_row(width: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    state = rng.integers(0, 3, 1 << width)
    bound = tuple(sorted(rng.choice(width, width - 1, replace=False).tolist()))
    found = _conflicts(state == 1, state == 2, (bound,))[0]
    wanted = np.zeros_like(found)
    mask = sum(1 << x for x in bound)
    for a, b in itertools.product(range(1 << width), repeat=2):
        if a & ~mask == b & ~mask and {state[a], state[b]} == {1, 2}:
            columns = [sum((c >> x & 1) << place for place, x in enumerate(bound)) for c in (a, b)]
            wanted[columns[0], columns[1]] = True
    assert (found == wanted).all()


@given(count=st.integers(2, 12), seed=st.integers(0, 99))
def test_bipartite_graphs_get_two_colours(count: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    side = rng.random(count) < 0.5
    edges = (side[:, np.newaxis] != side) & (rng.random((count, count)) < 0.4)
    edges |= edges.T
    colours = _colour(edges[np.newaxis])[0]
    assert colours.max() <= 1
    assert not (edges & (colours[:, np.newaxis] == colours)).any()


def test_expected_costs_are_those_of_shannon_trees() -> None:
    assert [expected_luts(x) for x in (1, 6, 7, 8, 9, 10, 11, 12)] == [0, 1, 2, 4, 8.5, 17, 34, 68]
