from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from wnn2hdl.edges import boundary, canny, filter_agreement, learned
from wnn2hdl.edges.budget import _choose, learned_under_budget
from wnn2hdl.edges.evidence import gather
from wnn2hdl.errors import InputError
from wnn2hdl.ir import EdgeFilter
from wnn2hdl.minimise import map_luts
from wnn2hdl.samples import landscape

Pictures = list[tuple[NDArray[np.bool_], NDArray[np.bool_]]]


@pytest.fixture(scope="module")
def pictures() -> Pictures:
    """Landscapes; the classifier errs on some pixels."""
    rng = np.random.default_rng(0)
    made = []
    for seed in range(3):
        scene = landscape(96, 96, seed)
        grey = scene.image.mean(axis=2).astype(np.uint8)
        made.append((scene.deforested ^ (rng.random((96, 96)) < 0.01), canny(grey)))
    return made


def luts(edge_filter: EdgeFilter) -> int:
    return len(map_luts(edge_filter.table(), effort=1).network.luts)


def f1(edge_filter: EdgeFilter, pictures: Pictures) -> float:
    return gather(pictures).f1(edge_filter.patterns)


@pytest.mark.parametrize("budget", [1, 2, 3])
def test_the_exact_circuit_keeps_the_budget(pictures: Pictures, budget: int) -> None:
    assert luts(learned_under_budget(pictures, budget)) <= budget


def test_more_luts_agree_better_and_none_is_far_from_patterns_without_a_budget(pictures: Pictures) -> None:
    one, two, three = (f1(learned_under_budget(pictures, budget), pictures) for budget in (1, 2, 3))
    free = max(f1(learned(pictures, count), pictures) for count in (20, 40, 75))
    assert one <= two <= three
    assert three > 0.98 * free


@pytest.mark.parametrize("budget", [2, 3])
def test_a_number_of_patterns_can_be_prescribed(pictures: Pictures, budget: int) -> None:
    edge_filter = learned_under_budget(pictures, budget, 75)
    assert edge_filter.size == 75
    assert luts(edge_filter) <= budget


def test_one_lut_holds_multiples_of_eight_only(pictures: Pictures) -> None:
    assert learned_under_budget(pictures, 1, 80).size == 80
    with pytest.raises(
        InputError, match=r"no edge filter of 1 LUTs with this number of patterns was found: 75"
    ):
        learned_under_budget(pictures, 1, 75)


@pytest.mark.parametrize("budget", [1, 2])
def test_windows_of_one_colour_are_never_an_edge_even_among_dense_edges(
    pictures: Pictures, budget: int
) -> None:
    dense = [(binary, np.ones_like(edges)) for binary, edges in pictures]
    assert gather(dense).gains(boundary().patterns)[[0, 511]].min() > 0
    assert not learned_under_budget(dense, budget).patterns[[0, 511]].any()


def test_same_seed_gives_the_same_filter(pictures: Pictures) -> None:
    first, second = (learned_under_budget(pictures, 2, seed=7) for _ in range(2))
    assert (first.patterns == second.patterns).all()


@pytest.mark.parametrize("budget", [0, 4])
def test_other_budgets_are_refused(pictures: Pictures, budget: int) -> None:
    with pytest.raises(InputError, match=rf"for 1 to 3 LUTs: {budget}; choose 1, 2 or 3"):
        learned_under_budget(pictures, budget)


@pytest.mark.parametrize("count", [0, 511])
def test_impossible_numbers_of_patterns_are_refused(pictures: Pictures, count: int) -> None:
    with pytest.raises(InputError, match=rf"1 to 510 patterns: {count}"):
        learned_under_budget(pictures, 2, count)


def test_pooled_agreement_rises_over_that_of_no_training(pictures: Pictures) -> None:
    trained = filter_agreement(learned_under_budget(pictures, 1), pictures).f1
    by_rule = filter_agreement(boundary(), pictures).f1
    assert trained is not None
    assert by_rule is not None
    assert trained > by_rule


@given(
    st.lists(
        st.lists(st.tuples(st.integers(-5, 5), st.integers(0, 4)), min_size=2, max_size=2),
        min_size=1,
        max_size=6,
    ),
    st.integers(0, 15),
)
def test_the_choice_under_a_total_is_the_best_of_all(items: list[list[tuple[int, int]]], total: int) -> None:
    values = np.array([[value for value, _ in options] for options in items], dtype=np.float64)
    sizes = np.array([[size for _, size in options] for options in items])
    rows = np.arange(len(items))
    fitting = [
        values[rows, options].sum()
        for options in product(range(2), repeat=len(items))
        if sizes[rows, options].sum() == total
    ]
    chosen = _choose(values, sizes, total)
    if chosen is None:
        assert not fitting
    else:
        assert sizes[rows, chosen].sum() == total
        assert values[rows, chosen].sum() == max(fitting)
