from dataclasses import replace

import numpy as np
import pytest

from wnn2hdl.apps.sweep.grid import Plan, Recipe, grid
from wnn2hdl.apps.sweep.selection import (
    collect,
    decide,
    finalists,
    hypervolume,
    pareto_front,
    peaks,
    surface,
)
from wnn2hdl.apps.sweep.trial import Record, Status

RECIPE = Recipe(seed=0, bits=("R7", "G7", "B7"), bleaching=None, care_minimum=1)


def record(n: int, k: int, number: int, accuracy: float, luts: int = 3, status: Status = "valid") -> Record:
    trial = RECIPE.trial((n, k), number)
    return Record(
        trial.name,
        n,
        k,
        trial.seed,
        trial.bits,
        1,
        status,
        accuracy=accuracy,
        circuit_accuracy=accuracy,
        luts=luts,
    )


def surface_of(heights: list[list[float]], status: Status = "valid") -> tuple[Plan, list[Record]]:
    plan = grid(RECIPE, range(2, 2 + len(heights)), range(2, 2 + len(heights[0])), trials=1)
    cells = {(n, k): height for n, row in enumerate(heights, 2) for k, height in enumerate(row, 2)}
    return plan, [record(*cell, 0, cells[cell], status=status) for cell in plan.cells]


def test_saturated_and_failed_trials_count_but_enter_no_mean() -> None:
    plan = grid(RECIPE, [4], [3], trials=4)
    failed = Record("n4-k3-t3", 4, 3, 1, ("R7",), 1, "failed", error="x")
    records = [
        record(4, 3, 0, 0.8, luts=2),
        record(4, 3, 1, 0.9, luts=4),
        record(4, 3, 2, 0.1, luts=50, status="saturated"),
        failed,
    ]
    found = surface(plan, records)
    assert found.at((4, 3)) == pytest.approx((0.85, 3))
    assert (found.valid.item(), found.saturated.item(), found.failed.item()) == (2, 1, 1)


def test_an_architecture_without_a_valid_trial_is_a_hole_and_no_peak() -> None:
    plan, records = surface_of([[0.9, 0.8], [0.7, 0.6]], status="saturated")
    found = surface(plan, records)
    assert np.isnan(found.accuracy).all()
    assert peaks(found) == ()
    assert decide(collect(records)) is None


def test_peaks_are_higher_than_their_eight_neighbours() -> None:
    plan, records = surface_of(
        [
            [0.5, 0.6, 0.5, 0.7],
            [0.6, 0.8, 0.5, 0.6],
            [0.5, 0.6, 0.9, 0.5],
            [0.5, 0.5, 0.5, 0.5],
        ]
    )  # fmt: skip
    assert peaks(surface(plan, records)) == ((4, 4), (2, 5))


def test_a_peak_of_lucky_mappings_is_none() -> None:
    plan = grid(RECIPE, [4], [3, 4], trials=3)
    records = [
        record(4, 3, 0, 0.99),
        record(4, 3, 1, 0.5, status="saturated"),
        record(4, 3, 2, 0.5, status="saturated"),
        *(record(4, 4, x, 0.8) for x in range(3)),
    ]
    assert peaks(surface(plan, records)) == ((4, 4),)


def test_the_reference_architectures_are_finalists_where_the_grid_has_them() -> None:
    plan = grid(RECIPE, range(4, 6), range(9, 17), trials=1)
    records = [record(*cell, 0, 0.9 if cell == (4, 9) else 0.8 - cell[1] / 100) for cell in plan.cells]
    assert finalists(surface(plan, records), plan) == ((4, 9), (4, 16), (5, 10))
    small = grid(RECIPE, [4], [9], trials=1)
    assert finalists(surface(small, records[:1]), small) == ((4, 9),)


def test_the_front_is_what_nothing_equals_or_beats() -> None:
    records = [
        record(4, 3, 0, 0.80, luts=5),
        record(4, 3, 1, 0.90, luts=5),
        record(4, 3, 2, 0.90, luts=6),
        record(4, 3, 3, 0.95, luts=9),
        record(4, 3, 4, 0.70, luts=1),
        record(4, 3, 5, 0.99, luts=1, status="saturated"),
    ]
    assert [(x.luts, x.accuracy) for x in pareto_front(records)] == [(1, 0.7), (5, 0.9), (9, 0.95)]
    assert pareto_front([]) == ()


def test_the_hypervolume_is_the_area_under_the_staircase() -> None:
    front = [record(4, 3, 0, 0.7, luts=1), record(4, 3, 1, 0.9, luts=3)]
    # From log2(1 + 1) = 1 to log2(1 + 3) = 2 at 0.2, from there to log2(1 + 7) = 3 at 0.4.
    assert hypervolume(front, 7) == pytest.approx(0.2 + 0.4)
    assert hypervolume([], 7) == 0


def finalist_records(n: int, k: int, mean: float, luts: int, spread: float = 0.01) -> list[Record]:
    noise = np.random.default_rng(n * 100 + k).normal(0, spread, 100)
    return [record(n, k, x, mean + noise[x], luts) for x in range(100)]


def test_the_most_accurate_is_chosen_where_the_test_shows_it() -> None:
    records = finalist_records(4, 16, 0.90, luts=9) + finalist_records(5, 10, 0.865, luts=3)
    decision = decide(collect(records))
    assert decision is not None
    assert decision.chosen.cell == (4, 16)
    comparison, p_value = decision.comparisons[(4, 16), (5, 10)]
    assert comparison.test == "signed-rank"
    assert p_value < 1e-6
    assert "significantly more accurate than 5 address bits, 10 RAMs" in decision.reasons
    assert decision.reasons.endswith("Chosen: 4 address bits, 16 RAMs.")


def test_of_those_not_shown_to_differ_the_smallest_is_chosen() -> None:
    records = finalist_records(4, 16, 0.9001, luts=9, spread=0.05) + finalist_records(
        5, 10, 0.9, luts=3, spread=0.05
    )
    decision = decide(collect(records))
    assert decision is not None
    assert decision.chosen.cell == (5, 10)
    assert "Not shown to differ" in decision.reasons


def test_the_best_trial_is_the_most_accurate_then_the_smallest() -> None:
    first, second = record(4, 3, 0, 0.9, luts=5), record(4, 3, 1, 0.9, luts=2)
    saturated = record(4, 3, 2, 0.95, status="saturated")
    decision = decide(collect([first, second, saturated]))
    assert decision is not None
    assert decision.chosen.best == second
    assert decision.chosen.saturated == 1


def test_a_trial_with_an_error_is_no_finalist() -> None:
    broken = replace(record(4, 3, 0, 0.9), status="failed", accuracy=None)
    assert collect([broken]) == ()
