import pytest

from wnn2hdl.apps.sweep.grid import Plan, Recipe, batches, grid, parse_name
from wnn2hdl.errors import InputError


def test_a_grid_holds_every_combination_in_order(plan: Plan) -> None:
    names = [plan.trial(position).name for position in range(len(plan))]
    assert len(set(names)) == len(plan) == 18
    assert names[:4] == ["n2-k3-t0", "n2-k3-t1", "n2-k3-t2", "n2-k6-t0"]
    assert [plan.position(name) for name in names] == list(range(18))


def test_the_full_grid_has_2090_trials(recipe: Recipe) -> None:
    assert len(grid(recipe, range(2, 13), range(2, 21), trials=10)) == 2090


@pytest.mark.parametrize("name", ["n2-k3-t3", "n5-k3-t0", "s7", "n02-k3-t0", ""])
def test_names_of_other_trials_have_no_position(plan: Plan, name: str) -> None:
    assert plan.position(name) is None


def test_mapping_seeds_pair_architectures_and_differ_between_trials_and_sweeps(recipe: Recipe) -> None:
    assert recipe.trial((4, 16), 7).seed == recipe.trial((5, 10), 7).seed
    other = Recipe(recipe.seed + 1, recipe.bits, None, None)
    seeds = {x.mapping_seed(number) for x in (recipe, other) for number in range(100)}
    assert len(seeds) == 200


def test_a_trial_does_not_depend_on_the_grid_around_it(plan: Plan, recipe: Recipe) -> None:
    wider = grid(recipe, range(2, 9), range(2, 21), trials=10)
    position = wider.position("n3-k6-t2")
    assert position is not None
    assert wider.trial(position) == plan.trial(plan.position("n3-k6-t2") or 0)


def test_a_bad_name_is_refused() -> None:
    assert parse_name("n12-k20-t99") == ((12, 20), 99)
    with pytest.raises(InputError, match="no such trial: 'best'; name one of the table, as n4-k16-t3"):
        parse_name("best")


def test_batches_keep_the_order_and_take_trials_as_they_are_needed(plan: Plan) -> None:
    trials = (plan.trial(position) for position in range(5))
    runs = batches(trials, 2)
    assert next(runs) == (plan.trial(0), plan.trial(1))
    assert next(trials) == plan.trial(2)
    assert list(runs) == [(plan.trial(3), plan.trial(4))]
