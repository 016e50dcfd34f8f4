"""Files of all kinds of models, read by one function."""

import json
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from wnn2hdl.errors import ModelFileError
from wnn2hdl.ir import BitSelect, Thermometer, WisardModel, Words
from wnn2hdl.ir.models import (
    KINDS,
    AnyModel,
    BloomWisardModel,
    Dynamic,
    LogicModel,
    LutGroupModel,
    LutLayer,
    SparseWisardModel,
    SumLayer,
    TableSumModel,
    load_model,
)

AB = ("a", "b")
first_and_second = np.array([0, 1], dtype=np.int32)
logic = LogicModel(AB, ("y",), np.array([[2, 4]], dtype=np.uint32), np.array([6], dtype=np.uint32))
MODELS: tuple[AnyModel, ...] = (
    WisardModel(BitSelect(("R7",)), AB, np.array([[[0]]]), np.array([[[9, 0]], [[0, 7]]]), 1),
    SparseWisardModel(
        encoder=Thermometer(((0.5,),), strict=True),
        classes=AB,
        mapping=np.zeros((1, 1, 1), dtype=np.int32),
        offsets=np.array([0, 1, 2]),
        addresses=np.array([1, 0], dtype=np.uint64),
        counts=np.array([3, 4]),
        bleaching=Dynamic(),
        ties="last",
    ),
    BloomWisardModel(
        encoder=Words(2),
        classes=AB,
        mapping=np.array([[0, 1]], dtype=np.int32),
        hashes=np.array([[1, 3]], dtype=np.uint32),
        contents=np.ones((2, 1, 4), dtype=np.bool_),
    ),
    LutGroupModel(
        encoder=Words(1),
        classes=AB,
        layers=(LutLayer(np.zeros((2, 1), dtype=np.int32), np.array([[False, True], [True, False]])),),
        groups=first_and_second,
    ),
    TableSumModel(
        encoder=Words(1),
        classes=AB,
        layers=(
            SumLayer(2, 4, np.array([0, 0], dtype=np.int32), first_and_second, np.ones((2, 2), np.int32)),
        ),
    ),
    logic,
)


def test_there_is_one_of_each_kind() -> None:
    assert {model.kind for model in MODELS} == KINDS.keys()


@pytest.mark.parametrize("model", MODELS)
def test_a_file_gives_its_model_back(tmp_path: Path, model: AnyModel) -> None:
    path = tmp_path / "model.json"
    model.save(path)
    again = load_model(path)
    assert type(again) is type(model) is KINDS[model.kind]
    assert again.digest() == model.digest()


def damaged(draw: st.DrawFn, data: Any) -> Any:
    """The same data with one thing in it replaced or left out."""
    if isinstance(data, dict) and data and draw(st.booleans()):
        key = draw(st.sampled_from(sorted(data)))
        rest = {name: value for name, value in data.items() if name != key}
        return rest if draw(st.booleans()) else {**rest, key: damaged(draw, data[key])}
    if isinstance(data, list) and data and draw(st.booleans()):
        at = draw(st.integers(0, len(data) - 1))
        return [*data[:at], damaged(draw, data[at]), *data[at + 1 :]]
    if isinstance(data, str) and draw(st.booleans()):
        return data[: draw(st.integers(0, len(data)))]
    return draw(st.none() | st.integers(-(2**70), 2**70) | st.text(max_size=3) | st.just([]) | st.just({}))


@given(st.sampled_from(MODELS), st.data())
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=200)
def test_a_damaged_file_gets_one_line_or_is_a_model(
    tmp_path: Path, model: AnyModel, data: st.DataObject
) -> None:
    path = tmp_path / "model.json"
    path.write_text(json.dumps(data.draw(st.composite(damaged)(model.to_json()))))
    with suppress(ModelFileError):
        load_model(path)


def test_an_array_that_says_it_is_huge_is_refused(tmp_path: Path) -> None:
    data = logic.to_json()
    data["gates"]["shape"] = [2**39, 2]
    path = tmp_path / "model.json"
    path.write_text(json.dumps(data))
    with pytest.raises(ModelFileError, match=r"contradicts itself: .*takes 4398046511104 bytes, not 8"):
        load_model(path)
