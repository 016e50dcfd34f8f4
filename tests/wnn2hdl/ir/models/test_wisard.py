from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from wnn2hdl.ir import BitSelect, Words
from wnn2hdl.ir.models import Dynamic, SparseWisardModel
from wnn2hdl.ir.models.base import ZERO

Ram = dict[int, int]


def sparse(rams: list[list[Ram]], mapping: Any, width: int, **changes: Any) -> SparseWisardModel:
    """A model whose RAM ``rams[class][ram]`` holds counts by address."""
    flat = [sorted(ram.items()) for owner in rams for ram in owner]
    options = {"bleaching": 1} | changes
    return SparseWisardModel(
        encoder=Words(width),
        classes=tuple(f"class {index}" for index in range(len(rams))),
        mapping=np.array(mapping, dtype=np.int32),
        offsets=np.cumsum([0, *map(len, flat)], dtype=np.int64),
        addresses=np.array([address for ram in flat for address, _ in ram], dtype=np.uint64),
        counts=np.array([count for ram in flat for _, count in ram], dtype=np.int64),
        **options,
    )


@st.composite
def models(draw: st.DrawFn) -> SparseWisardModel:
    width, rams, classes = draw(st.integers(1, 9)), draw(st.integers(1, 4)), draw(st.integers(2, 4))
    bits = draw(st.integers(1, 5) | st.just(64))
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    mapping = rng.integers(ZERO, width, (draw(st.sampled_from([1, classes])), rams, bits))

    def address() -> int:
        owner, ram = rng.integers(len(mapping)), rng.integers(rams)
        row = rng.integers(0, 2, width)
        return sum(int(row[i]) << j for j, i in enumerate(mapping[owner, ram]) if i != ZERO)

    contents = [
        [{address(): int(rng.integers(1, 5)) for _ in range(4)} for _ in range(rams)] for _ in range(classes)
    ]
    bleaching = draw(st.integers(1, 3) | st.builds(Dynamic, st.integers(1, 3)))
    return sparse(
        contents, mapping, width, bleaching=bleaching, ties=draw(st.sampled_from(["first", "last"]))
    )


def slow_votes(model: SparseWisardModel, row: NDArray[np.bool_]) -> list[list[int]]:
    """The count at each RAM's address, from the definition."""
    votes = []
    for owner in range(len(model.classes)):
        mapping = model.mapping[owner if len(model.mapping) > 1 else 0].tolist()
        found = []
        for ram, inputs in enumerate(mapping):
            address = sum(int(row[i]) << j for j, i in enumerate(inputs) if i != ZERO)
            stored, counts = model.contents(owner, ram)
            found.append(dict(zip(stored.tolist(), counts.tolist(), strict=True)).get(address, 0))
        votes.append(found)
    return votes


def slow_winner(model: SparseWisardModel, row: NDArray[np.bool_]) -> int:
    """One sample, its threshold raised step by step as wisardpkg does."""
    votes = slow_votes(model, row)
    threshold = model.bleaching if isinstance(model.bleaching, int) else 1
    while True:
        responses = [sum(vote >= threshold for vote in owner) for owner in votes]
        if isinstance(model.bleaching, int):
            break
        highest, unclear = 0, False
        for response in responses:
            if response > highest:
                highest, unclear = response, False
            elif highest - response < model.bleaching.confidence:
                unclear = True
        if not unclear or highest <= 1:
            break
        threshold += 1
    best = [index for index, response in enumerate(responses) if response == max(responses)]
    return best[0] if model.ties == "first" else best[-1]


def rows(model: SparseWisardModel, seed: int = 0) -> NDArray[np.bool_]:
    return np.random.default_rng(seed).random((40, model.width)) < 0.5


@given(models())
def test_every_answer_is_that_of_the_definition(model: SparseWisardModel) -> None:
    bits = rows(model)
    assert model.votes(bits).tolist() == [slow_votes(model, row) for row in bits]
    assert model.evaluate(bits).tolist() == [slow_winner(model, row) for row in bits]


@given(models())
def test_json_gives_the_model_back(model: SparseWisardModel) -> None:
    again = SparseWisardModel.from_json(model.to_json())
    assert again.to_json() == model.to_json()
    assert again.digest() == model.digest()


def test_dynamic_bleaching_rises_until_one_class_is_ahead() -> None:
    rams = [[{1: 5}, {1: 2}], [{1: 1}, {1: 1}]]
    model = sparse(rams, [[[0], [0]]], 1, bleaching=Dynamic(), ties="last")
    # Both classes fire twice at threshold 1; at 2 only the first does.
    assert model.responses([[True]]).tolist() == [[2, 0]]
    # No RAM fires for the other input: nothing rises, the last class wins.
    assert model.evaluate([[False]]).tolist() == [1]


def test_the_tie_rule_is_the_models() -> None:
    rams: list[list[Ram]] = [[{1: 1}], [{1: 1}], [{}]]
    model = sparse(rams, [[[0]]], 1)
    assert model.evaluate([[True]]).tolist() == [0]
    assert replace(model, ties="last").evaluate([[True]]).tolist() == [1]


def test_a_ram_of_64_bits_tells_the_highest_bit() -> None:
    model = sparse([[{1 << 63: 1}], [{(1 << 63) - 1: 1}]], [[list(range(64))]], 64)
    bits = np.zeros((2, 64), dtype=np.bool_)
    bits[0, 63], bits[1, :63] = True, True
    assert model.responses(bits).tolist() == [[1, 0], [0, 1]]


def test_any_encoder_will_do() -> None:
    model = replace(sparse([[{1: 1}], [{0: 1}]], [[[0]]], 1), encoder=BitSelect(("R7",)))
    assert model.width == 1


def test_samples_are_answered_alike_in_one_chunk_and_in_many(monkeypatch: pytest.MonkeyPatch) -> None:
    model = sparse([[{1: 1}], [{0: 1}]], [[[0]]], 1)
    bits = np.random.default_rng(0).random((1000, 1)) < 0.5
    whole = model.responses(bits)
    monkeypatch.setattr("wnn2hdl.ir.models.base.CHUNK_BYTES", 1)
    assert np.array_equal(model.responses(bits), whole)
    assert model.responses(bits[:0]).shape == (0, 2)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"classes": ("a",)}, "at least two different classes"),
        ({"mapping": np.array([[[1]]], dtype=np.int32)}, "reads inputs 1 to 1"),
        ({"mapping": np.array([[[-2]]], dtype=np.int32)}, "reads inputs -2"),
        ({"mapping": np.zeros((1, 1, 65), dtype=np.int32)}, "1 to 64 address bits, not 65"),
        ({"mapping": np.zeros((3, 1, 1), dtype=np.int32)}, "the mapping has shape"),
        ({"offsets": np.array([0, 2, 1])}, "the offsets do not share"),
        ({"offsets": np.array([0, 1, 3])}, "the offsets do not share"),
        ({"counts": np.array([1, 0])}, "a count of at least 1"),
        ({"counts": np.array([1])}, "a count of at least 1"),
        ({"addresses": np.array([0, 2], dtype=np.uint64)}, "address 2 does not fit 1 bits"),
        ({"offsets": np.array([0, 2, 2])}, "do not rise"),
        ({"bleaching": 0}, "the lowest is 1"),
    ],
)
def test_a_model_that_contradicts_itself(change: dict[str, Any], message: str) -> None:
    model = sparse([[{1: 1}], [{0: 1}]], [[[0]]], 1)
    with pytest.raises(ValueError, match=message):
        replace(model, **change)


def test_bits_of_another_width_are_refused() -> None:
    with pytest.raises(ValueError, match=r"reads bits \[samples, 1\]"):
        sparse([[{1: 1}], [{0: 1}]], [[[0]]], 1).evaluate([[True, False]])
