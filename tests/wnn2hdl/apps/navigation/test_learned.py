"""What calibration frames taught, written and read back, and refused where it does not belong."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wnn2hdl.apps.navigation.flight import FlightRun
from wnn2hdl.apps.navigation.learned import Learned
from wnn2hdl.apps.navigation.matching import Acceptance
from wnn2hdl.apps.navigation.methods import METHODS, WEIGHTLESS
from wnn2hdl.apps.navigation.navigator import PoseTolerance
from wnn2hdl.errors import InputError, ModelFileError
from wnn2hdl.ir.engine import EngineFormat


@pytest.fixture(scope="module")
def learned(run: FlightRun) -> Learned:
    assert run.learned is not None
    return run.learned


def test_it_is_read_as_it_was_written(learned: Learned, tmp_path: Path) -> None:
    never = Acceptance(math.inf, 0.0, 0.0, 0.25)
    kept = replace(learned, acceptances={**learned.acceptances, ("map", "grey"): never})
    kept.write(tmp_path / "calibration.json")
    read = Learned.read(tmp_path / "calibration.json")
    assert read.calibration == kept.calibration
    assert read.conditions == kept.conditions
    assert read.poses == kept.poses
    assert read.windows == kept.windows
    assert read.acceptances == kept.acceptances
    assert read.weightless.to_json() == kept.weightless.to_json()


def test_the_same_conditions_are_accepted(learned: Learned) -> None:
    learned.require(learned.conditions, learned.windows, METHODS)
    learned.require(learned.conditions, {"map": None}, [WEIGHTLESS])


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        ({"map": "0" * 64}, "the calibration belongs to another map"),
        ({"tolerance": PoseTolerance(6.0)}, "--heading-tolerance was 0.0, and now is 6.0"),
        ({"tolerance": PoseTolerance(0.0, 0.08)}, "--height-tolerance was 0.0, and now is 8.0"),
    ],
)
def test_other_conditions_are_refused(learned: Learned, change: dict[str, Any], fault: str) -> None:
    with pytest.raises(InputError, match=fault):
        learned.require(replace(learned.conditions, **change), learned.windows, METHODS)


def test_another_camera_window_or_method_is_refused(learned: Learned) -> None:
    camera = replace(learned.conditions.camera, fx=200.0)
    with pytest.raises(InputError, match=r"fx was 195.0, and now is 200\.0"):
        learned.require(replace(learned.conditions, camera=camera), learned.windows, METHODS)
    with pytest.raises(InputError, match=r"--window was 40\.0, and now is 95\.0"):
        learned.require(learned.conditions, {"window": 95.0}, METHODS)
    known = replace(learned, windows={"map": None})
    with pytest.raises(InputError, match="no thresholds for this search: window"):
        known.require(learned.conditions, {"window": 40.0}, METHODS)
    some = {place: one for place, one in learned.acceptances.items() if place[1] != "grey"}
    with pytest.raises(InputError, match="no threshold for a method: grey"):
        replace(learned, acceptances=some).require(learned.conditions, learned.windows, METHODS)


def test_an_engine_of_other_sizes_is_refused(learned: Learned, tmp_path: Path) -> None:
    engine = EngineFormat((32, 32), (128, 128), lanes=1, columns=32)
    known = replace(
        learned,
        conditions=replace(learned.conditions, engine=engine),
        acceptances={**learned.acceptances, ("map", "engine"): Acceptance(1.0, 1.0, 1.0)},
    )
    known.write(tmp_path / "calibration.json")
    read = Learned.read(tmp_path / "calibration.json")
    assert read.conditions == known.conditions
    read.require(known.conditions, {"map": None}, ["engine"])
    larger = replace(known.conditions, engine=replace(engine, segment=(128, 256)))
    with pytest.raises(InputError, match="--segment was 128x128, and now is 128x256"):
        read.require(larger, {"map": None}, ["engine"])
    read.require(larger, {"map": None}, ["grey"])


def test_other_files_are_refused(learned: Learned, tmp_path: Path) -> None:
    path = tmp_path / "calibration.json"
    with pytest.raises(ModelFileError, match="cannot read a calibration"):
        Learned.read(path)
    path.write_text("{}")
    with pytest.raises(ModelFileError, match="not a calibration of this version"):
        Learned.read(path)
    learned.write(path)
    path.write_text(path.read_text()[:-200])
    with pytest.raises(ModelFileError, match="not a calibration, or a damaged one"):
        Learned.read(path)


junk = st.one_of(
    st.none(), st.booleans(), st.integers(-9, 9), st.floats(-9, 9), st.text(max_size=3), st.just([])
)


@settings(max_examples=200, deadline=None)
@given(data=st.data())
def test_any_damage_is_one_error_or_another_calibration(
    learned: Learned, tmp_path_factory: pytest.TempPathFactory, data: st.DataObject
) -> None:
    path = tmp_path_factory.getbasetemp() / "damaged.json"
    learned.write(path)
    whole = json.loads(path.read_text())
    at, way = whole, data.draw(st.integers(1, 5))
    for depth in range(way):
        keys = list(at) if isinstance(at, dict) else range(len(at))
        key = data.draw(st.sampled_from(list(keys)))
        if depth == way - 1 or not isinstance(at[key], (dict, list)) or not at[key]:
            at[key] = data.draw(junk)
            break
        at = at[key]
    path.write_text(json.dumps(whole))
    try:
        read = Learned.read(path)
    except ModelFileError:
        return
    read.calibration.report()
