from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from wnn2hdl.ir import Words
from wnn2hdl.ir.models import BloomWisardModel
from wnn2hdl.ir.models.base import ZERO


@st.composite
def models(draw: st.DrawFn) -> BloomWisardModel:
    width, filters, inputs = draw(st.integers(1, 9)), draw(st.integers(1, 4)), draw(st.integers(1, 5))
    entries, hashes, classes = 1 << draw(st.integers(1, 5)), draw(st.integers(1, 3)), draw(st.integers(2, 4))
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    return BloomWisardModel(
        encoder=Words(width),
        classes=tuple(map(str, range(classes))),
        mapping=rng.integers(ZERO, width, (filters, inputs), dtype=np.int32),
        hashes=rng.integers(0, entries, (hashes, inputs), dtype=np.uint32),
        contents=rng.random((classes, filters, entries)) < 0.6,
    )


def slow_responses(model: BloomWisardModel, row: NDArray[np.bool_]) -> list[int]:
    """The definition, one filter and one hash at a time."""
    responses = [0] * len(model.classes)
    for owner, filters in enumerate(model.contents):
        for inputs, entries in zip(model.mapping.tolist(), filters, strict=True):
            fires = True
            for constants in model.hashes.tolist():
                place = 0
                for position, constant in zip(inputs, constants, strict=True):
                    if position != ZERO and row[position]:
                        place ^= constant
                fires &= bool(entries[place])
            responses[owner] += fires
    return responses


@given(models())
def test_every_response_is_that_of_the_definition(model: BloomWisardModel) -> None:
    bits = np.random.default_rng(0).random((30, model.width)) < 0.5
    responses = [slow_responses(model, row) for row in bits]
    assert model.responses(bits).tolist() == responses
    assert model.evaluate(bits).tolist() == [each.index(max(each)) for each in responses]


@given(models())
def test_json_gives_the_model_back(model: BloomWisardModel) -> None:
    assert BloomWisardModel.from_json(model.to_json()).to_json() == model.to_json()


def small() -> BloomWisardModel:
    return BloomWisardModel(
        encoder=Words(2),
        classes=("a", "b"),
        mapping=np.array([[0, 1]], dtype=np.int32),
        hashes=np.array([[1, 3]], dtype=np.uint32),
        contents=np.ones((2, 1, 4), dtype=np.bool_),
    )


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"mapping": np.array([[0, 2]], dtype=np.int32)}, "reads inputs 0 to 2"),
        ({"mapping": np.zeros((0, 2), dtype=np.int32)}, "the mapping has shape"),
        ({"hashes": np.array([[1]], dtype=np.uint32)}, "the hashes have shape"),
        ({"hashes": np.array([[1, 4]], dtype=np.uint32)}, "hash constant 4 is not an index of 4 entries"),
        ({"contents": np.ones((2, 1, 3), dtype=np.bool_)}, "a power of two of entries"),
        ({"contents": np.ones((2, 2, 4), dtype=np.bool_)}, "the contents have shape"),
        ({"classes": ("a", "a")}, "two different classes"),
    ],
)
def test_a_model_that_contradicts_itself(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        replace(small(), **change)
