import math

import numpy as np
import pytest

from wnn2hdl.errors import ToolError, ToolStoppedError
from wnn2hdl.minimise import recipes
from wnn2hdl.minimise.decompose import decompose
from wnn2hdl.minimise.draft import Draft
from wnn2hdl.minimise.recipes import (
    care_candidates,
    from_blif,
    network_candidates,
    to_blif,
    truth_candidates,
    two_lut_candidates,
)

WIDTH = 8
BITS = (np.arange(1 << WIDTH) >> np.arange(WIDTH)[:, np.newaxis] & 1).astype(np.uint8)


def values_of(draft: Draft) -> np.ndarray:
    values = draft.evaluate(BITS)
    return np.stack([values[x] for x in draft.outputs], axis=1).astype(bool)


@pytest.fixture
def truth() -> np.ndarray:
    return np.random.default_rng(0).random((1 << WIDTH, 2)) < 0.3


def test_every_truth_recipe_works_and_is_right(truth: np.ndarray) -> None:
    found = list(truth_candidates(truth, effort=2))
    assert len(found) == sum(map(len, recipes._FROM_TRUTH[:3]))
    assert all((values_of(draft) == truth).all() for _, draft in found)


def test_care_recipes_are_right_on_the_care_set(truth: np.ndarray) -> None:
    care = np.random.default_rng(1).random(1 << WIDTH) < 0.4
    found = list(care_candidates(truth, care, effort=2))
    assert len(found) == 2
    assert all((values_of(draft)[care] == truth[care]).all() for _, draft in found)


def test_networks_go_to_abc_and_back(truth: np.ndarray) -> None:
    draft = Draft(WIDTH)
    rng = np.random.default_rng(0)
    everything = tuple(range(WIDTH))
    draft.outputs = [decompose(draft, everything, x, ~x, rng) for x in truth.T]
    assert (values_of(from_blif(to_blif(draft), WIDTH)) == truth).all()
    assert all((values_of(found) == truth).all() for _, found in network_candidates(draft))


@pytest.mark.parametrize(
    ("inner", "outer"),
    [
        ((0, 1, 2, 3, 4, 5), (0, 1, 2, 6, 7)),
        ((0, 1, 2, 3, 4, 5), (6, 7, 8, 9, 10)),
        ((11, 9, 7, 5, 3, 1), (1, 3, 5, 2, 6)),  # inputs 0, 4, 8 and 10 are not read
    ],
)
def test_two_luts_are_found_where_there_are_two(inner: tuple[int, ...], outer: tuple[int, ...]) -> None:
    rng = np.random.default_rng(0)
    width = max(*inner, *outer) + 1
    built = Draft(width)
    built.outputs = [built.add(inner, rng.integers(0, 2, 64).astype(np.uint8))]
    built.outputs = [built.add((*outer, built.outputs[0]), rng.integers(0, 2, 64).astype(np.uint8))]
    bits = (np.arange(1 << width) >> np.arange(width)[:, np.newaxis] & 1).astype(np.uint8)
    truth = built.evaluate(bits)[built.outputs[0]]
    ((method, found),) = two_lut_candidates(truth.astype(np.bool_))
    assert method == "lutexact"
    assert len(found.order()) == 2
    assert (found.evaluate(bits)[found.outputs[0]] == truth).all()


@pytest.mark.parametrize("width", [6, 8, 11, 12])
def test_nothing_is_found_where_two_luts_are_too_few_or_too_many(width: int) -> None:
    truth = np.random.default_rng(0).random(1 << width) < 0.5
    assert list(two_lut_candidates(truth)) == []


def test_a_recipe_that_crashes_costs_only_itself(truth: np.ndarray, monkeypatch: pytest.MonkeyPatch) -> None:
    # A malformed truth table makes ABC end with a segmentation fault.
    scripts = (("first", "lutmin -K 6"), ("crash", "read_truth 12345"), ("last", "lutmin -K 6"))
    monkeypatch.setattr(recipes, "_FROM_TRUTH", (tuple(recipes._Recipe(*x) for x in scripts),))
    assert [name for name, _ in truth_candidates(truth, effort=0)] == ["first", "last"]


def test_a_recipe_s_network_does_not_depend_on_the_others(
    truth: np.ndarray, monkeypatch: pytest.MonkeyPatch
) -> None:
    together = {name: to_blif(draft) for name, draft in truth_candidates(truth, effort=2)}
    every = [recipe for level in recipes._FROM_TRUTH[:3] for recipe in level]
    for recipe in every:
        monkeypatch.setattr(recipes, "_FROM_TRUTH", ((recipe,),))
        ((name, draft),) = truth_candidates(truth, effort=0)
        assert to_blif(draft) == together[name]


def test_a_function_too_large_for_a_recipe_is_not_given_to_it(
    truth: np.ndarray, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Two random functions of eight inputs, 1 at three codes of ten, are 297 nodes.
    limits = {"any": math.inf, "too small": 250, "large enough": 350}
    group = tuple(recipes._Recipe(name, "lutmin -K 6", limit) for name, limit in limits.items())
    monkeypatch.setattr(recipes, "_FROM_TRUTH", ((), group))
    assert [name for name, _ in truth_candidates(truth, effort=1)] == ["any", "large enough"]


def test_a_recipe_that_takes_too_long_is_an_error_and_no_other_result(
    truth: np.ndarray, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(recipes, "_SAFETY_NET", 0.001)
    with pytest.raises(ToolStoppedError, match=r"yosys-abc did not finish in 0\.001 s"):
        list(truth_candidates(truth, effort=0))


def test_a_missing_abc_is_told(truth: np.ndarray, monkeypatch: pytest.MonkeyPatch) -> None:
    def missing() -> None:
        raise ToolError("no yosys-abc found")

    monkeypatch.setattr(recipes, "find_abc", missing)
    with pytest.raises(ToolError, match="no yosys-abc found"):
        list(truth_candidates(truth, effort=0))
