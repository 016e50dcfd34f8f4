import base64
import json
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from wnn2hdl.errors import InputError
from wnn2hdl.importers import ImportOptions, Source
from wnn2hdl.importers.wisardpkg import RECORD, read, recognises
from wnn2hdl.ir.models import Dynamic

Write = Callable[..., Path]


def data_of(*rams: dict[int, int]) -> str:
    """RAMs as wisardpkg writes them."""
    packed = (np.array(list(ram.items()), dtype=RECORD).tobytes() for ram in rams)
    return ".".join(base64.b64encode(ram).decode() for ram in packed)


def model(**changes: Any) -> dict[str, Any]:
    """Two classes over three bits: RAMs of two bits and of one."""
    rams = {"count": 9, "entrySize": 3, "mapping": [[0, 2], [1, 1]]}
    return {
        "addressSize": 2,
        "base": 2,
        "bleachingActivated": False,
        "ignoreZero": False,
        "completeAddressing": True,
        "confidence": 1,
        "indexes": [],
        "version": "1.6.3",
        "classes": {
            "b": {**rams, "data": data_of({3: 2, 0: 1}, {3: 4})},
            "a": {**rams, "data": data_of({3: 1}, {0: 5, 3: 1})},
        },
    } | changes


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """``write(data)`` writes a file of wisardpkg."""

    def write_json(data: dict[str, Any]) -> Path:
        path = tmp_path / "model.json"
        path.write_text(json.dumps(data))
        return path

    return write_json


def test_the_first_mapped_bit_is_the_lowest_and_the_last_label_wins(write: Write) -> None:
    source = Source(write(model()))
    assert recognises(source)
    found = read(source, ImportOptions())
    assert (found.classes, found.ties, found.bleaching) == (("a", "b"), "last", 1)
    assert found.mapping.tolist() == [[[0, 2], [1, 1]]]
    assert found.votes([[1, 0, 1], [0, 0, 0]]).tolist() == [[[1, 5], [2, 0]], [[0, 5], [1, 0]]]
    assert found.evaluate([[1, 1, 1]]).tolist() == [1]


def test_bleaching_stays_dynamic_unless_it_is_asked_for(write: Write) -> None:
    source = Source(write(model(bleachingActivated=True, confidence=2)))
    assert read(source, ImportOptions()).bleaching == Dynamic(2)
    fixed = read(source, ImportOptions(bleach=4))
    assert fixed.bleaching == 4
    assert fixed.origin["bleaching"] == "fixed at 4 by request: not the classifier of the file"


def test_ignoring_zero_is_storing_nothing_there(write: Write) -> None:
    found = read(Source(write(model(ignoreZero=True))), ImportOptions())
    assert found.votes([[0, 0, 0]]).tolist() == [[[0, 0], [0, 0]]]


def test_smaller_rams_and_fewer_of_them(write: Write) -> None:
    data = model()
    data["classes"]["a"] = {"count": 1, "entrySize": 3, "mapping": [[2]], "data": data_of({1: 1})}
    found = read(Source(write(data)), ImportOptions())
    assert found.mapping.tolist() == [[[2, -1], [-1, -1]], [[0, 2], [1, 1]]]
    assert found.responses([[0, 0, 1], [1, 1, 1]]).tolist() == [[1, 0], [1, 2]]


def test_rams_in_files_of_their_own_are_found_beside_the_model(write: Write, tmp_path: Path) -> None:
    data = model()
    data["classes"]["a"]["data"] = "/home/someone/elsewhere/a__ramdata.wdpkg"
    (tmp_path / "a__ramdata.wdpkg").write_text(data_of({3: 1}, {0: 5, 3: 1}))
    path = write(data)
    assert (
        read(Source(path), ImportOptions()).digest() == read(Source(write(model())), ImportOptions()).digest()
    )
    write(data)
    (tmp_path / "a__ramdata.wdpkg").unlink()
    with pytest.raises(InputError, match=r"cannot read a model: .*a__ramdata\.wdpkg"):
        read(Source(path), ImportOptions())


def broken(**changes: Any) -> dict[str, Any]:
    data = model()
    data["classes"]["a"].update(changes)
    return data


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (model(base=3), r"reads digits, not bits: .*base 3"),
        (model(classes={}), "is not a list of whole numbers"),
        (broken(entrySize=4), "classes read inputs of 3 to 4 bits"),
        (broken(entrySize=3.0), "entrySize is not a list of whole numbers"),
        (broken(mapping=[[0, 3], [1, 1]]), "reads inputs 0 to 3; there are 3"),
        (broken(mapping=[[0, -1], [1, 1]]), "reads input -1"),
        (broken(mapping=[[0, 1.5], [1, 1]]), "not a list of whole numbers"),
        (broken(mapping=[[0] * 65, [1]]), "65 address bits"),
        (broken(mapping=[[0, 1]]), "data of 2 RAMs"),
        (broken(data=data_of({4: 1}, {})), "address 4 does not fit 2 bits"),
        (broken(data="AAAA.AAAA"), "not a wisardpkg model, or a damaged one"),
        (broken(data="?.?"), "not a wisardpkg model, or a damaged one"),
        (broken(data=data_of({1: 1}) + data_of({1: 1}) + "." + data_of({})), "stores an address twice"),
        (broken(data=7), "not a wisardpkg model, or a damaged one"),
        ({key: value for key, value in model().items() if key != "base"}, "base"),
    ],
)
def test_a_file_that_contradicts_itself_gets_one_line(
    write: Write, data: dict[str, Any], reason: str
) -> None:
    with pytest.raises(InputError, match=reason):
        read(Source(write(data)), ImportOptions())


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=200)
@given(st.data())
def test_any_damage_gives_a_model_or_one_line(write: Write, data: st.DataObject) -> None:
    text = json.dumps(model())
    at = data.draw(st.integers(0, len(text) - 1))
    other = data.draw(st.sampled_from('0123456789"[]{},.-eA') | st.characters(codec="utf-8"))
    path = write({})
    path.write_text(text[:at] + other + text[at + data.draw(st.integers(0, 3)) :], encoding="utf-8")
    with suppress(InputError):
        read(Source(path), ImportOptions())


@pytest.mark.realdata
@pytest.mark.parametrize("name", ["pixels_n4", "pixels_n4_bleach"])
def test_all_answers_of_wisardpkg_are_reproduced(realdata: Path, name: str) -> None:
    folder = realdata / "wisardpkg"
    found = read(Source(folder / f"{name}.json"), ImportOptions())
    answers = json.loads((folder / f"{name}.predictions.json").read_text())["predictions_for_codes_0_to_4095"]
    # Input 0 is the most significant bit of a code.
    bits = np.arange(4096)[:, np.newaxis] >> np.arange(11, -1, -1) & 1
    assert [found.classes[index] for index in found.evaluate(bits)] == answers
