"""The claims that belong to a model, by its kind."""

from types import ModuleType

import numpy as np
import pytest

from wnn2hdl.errors import InputError
from wnn2hdl.ir import Thermometer, WisardModel
from wnn2hdl.ir.care import CareSet, Codes, Everything
from wnn2hdl.lower.targets import TARGETS, Ingredients
from wnn2hdl.verify.specify import care_sets, specify


def test_a_model_of_pixels_and_one_of_neighbourhoods_have_claims_of_their_own(circuits: ModuleType) -> None:
    assert tuple(sorted(circuits.exact(circuits.random_block(0)).claims)) == tuple(sorted(circuits.PARTS))
    assert set(circuits.exact(circuits.random_neighbours(0)).claims) == {
        "neighbourhood",
        "taps",
        "decision",
    }


def test_claims_stand_innermost_first(circuits: ModuleType) -> None:
    names = list(circuits.exact(circuits.random_block(0)).claims)
    assert names.index("pixel") < names.index("block") < names.index("block_match")


def test_an_empty_care_set_is_refused_since_any_circuit_would_pass(circuits: ModuleType) -> None:
    block, neighbours = circuits.random_block(0), circuits.random_neighbours(5)
    empty = {width: Codes(np.zeros(1 << width, dtype=np.bool_)) for width in (5, 6, 9)}
    for model, care in (
        (block.model, {"pixel": empty[6]}),
        (block.model, {"edge": empty[9]}),
        (neighbours.model, {"neighbourhood": empty[5]}),
    ):
        with pytest.raises(InputError, match=r"care set .* is empty, so there is nothing to prove"):
            specify(model, block.edges, care)


def test_features_without_a_fixed_point_format_are_refused(circuits: ModuleType) -> None:
    mapping = np.zeros((1, 1, 1), dtype=np.int64)
    counts = np.zeros((2, 1, 2), dtype=np.int64)
    model = WisardModel(Thermometer(((0.5,),)), ("a", "b"), mapping, counts, 1)
    with pytest.raises(
        InputError, match=r"no fixed-point format of its features: thermometer; state one with --input"
    ):
        specify(model, circuits.random_block(0).edges, {})


def test_the_care_sets_of_a_circuit_are_those_of_its_definitions(circuits: ModuleType) -> None:
    block = circuits.random_block(0, care=0.5)
    care: dict[str, CareSet] = {"pixel": Codes(block.pixel_care)}
    found = care_sets(TARGETS["block"].lower(Ingredients(block.model, block.edges, care)))
    assert found == {"pixel": care["pixel"], "edge": Everything(9)}
