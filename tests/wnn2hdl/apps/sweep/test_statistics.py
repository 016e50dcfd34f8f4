import numpy as np
import pytest

from wnn2hdl.apps.sweep.statistics import compare, holm


def by_seed(values: object, first: int = 0) -> dict[int, float]:
    return dict(enumerate(np.asarray(values).tolist(), first))


def test_pairs_show_a_small_steady_difference_that_the_noise_between_seeds_hides() -> None:
    noise = np.random.default_rng(0).normal(0.8, 0.05, 100)
    shift = np.random.default_rng(1).normal(0.005, 0.001, 100)
    paired = compare(by_seed(noise + shift), by_seed(noise))
    assert paired.test == "signed-rank"
    assert paired.sizes == (100, 100)
    assert paired.p_value < 1e-10
    assert paired.effect == 1
    assert paired.low < paired.difference < paired.high
    assert paired.low > 0.004

    apart = compare(by_seed(noise + shift), by_seed(noise, first=100))
    assert apart.test == "rank-sum"
    assert apart.p_value > 0.05
    assert apart.low < 0 < apart.high


def test_only_common_seeds_are_paired() -> None:
    comparison = compare(by_seed(np.arange(30.0)), by_seed(np.arange(30.0), first=5))
    assert comparison.test == "signed-rank"
    assert comparison.sizes == (25, 25)
    assert comparison.difference == 5


@pytest.mark.parametrize(("common", "test"), [(9, "rank-sum"), (10, "signed-rank")])
def test_few_pairs_are_not_tested_as_pairs(common: int, test: str) -> None:
    values = np.arange(float(common))
    assert compare(by_seed(values), by_seed(values + 1)).test == test


def test_pairing_never_leaves_out_more_than_half() -> None:
    comparison = compare(by_seed(np.arange(40.0)), by_seed(np.arange(40.0), first=25))
    assert comparison.test == "rank-sum"
    assert comparison.sizes == (40, 40)


def test_the_rank_sum_effect_is_the_share_of_pairs_won_minus_lost() -> None:
    comparison = compare({1: 1.0, 2: 4.0}, {3: 2.0, 4: 3.0, 5: 0.0})
    assert comparison.effect == pytest.approx((4 - 2) / 6)


def test_equal_samples_do_not_differ() -> None:
    comparison = compare(by_seed(np.full(20, 0.9)), by_seed(np.full(20, 0.9)))
    assert (comparison.p_value, comparison.effect, comparison.difference) == (1, 0, 0)
    assert (comparison.low, comparison.high) == (0, 0)


def test_single_values_have_no_interval() -> None:
    comparison = compare({0: 0.9}, {1: 0.8})
    assert comparison.low == comparison.high == comparison.difference


def test_holm_multiplies_by_the_hypotheses_left_and_keeps_the_order() -> None:
    # The example of Holm's paper's kind: 0.005 * 4, 0.01 * 3, 0.03 * 2, and 0.04 raised to the one before.
    assert holm([0.01, 0.04, 0.03, 0.005]) == pytest.approx((0.03, 0.06, 0.06, 0.02))
    assert holm([0.9, 0.8]) == (1, 1)
    assert holm([]) == ()
