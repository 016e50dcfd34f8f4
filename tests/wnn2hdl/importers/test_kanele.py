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
from wnn2hdl.importers.kanele import read, recognises

Write = Callable[..., Path]
CONFIG = {"layers": [2, 1, 2], "layers_bitwidth": [2, 3, 4], "seed": 7}


def edge(*values: int, active: int = 1) -> dict[str, Any]:
    return {"acive": active, "values_int": list(values)}


def tables(**changes: Any) -> dict[str, Any]:
    """Two words of two bits, their sum in three bits, and classes that want it high and low."""
    return {
        "0_0_0": edge(-4, -3, 2, 3),
        "0_1_0": edge(0, 1, 2, 3),
        "1_0_0": edge(*range(-4, 4)),
        "1_0_1": edge(*range(4, -4, -1)),
    } | changes


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """``write(tables, config)`` writes both files."""

    def write_json(data: dict[str, Any], config: Any = CONFIG) -> Path:
        if config is not None:
            (tmp_path / "config.json").write_text(json.dumps(config))
        (tmp_path / "truth_tables.json").write_text(json.dumps(data))
        return tmp_path / "truth_tables.json"

    return write_json


def test_words_count_from_0_and_sums_saturate(write: Write) -> None:
    source = Source(write(tables()))
    assert recognises(source)
    model = read(source, ImportOptions())
    # The sums are -4, -2 and 6; the last saturates to 3.
    assert model.responses(model.encoder.bits([[0, 0], [1, 1], [3, 3]])).tolist() == [
        [-4, 4],
        [-2, 2],
        [3, -3],
    ]


def test_an_edge_that_is_not_active_adds_nothing(write: Write) -> None:
    path = write(tables(**{"0_1_0": edge(0, 1, 2, 3, active=0)}))
    model = read(Source(path), ImportOptions())
    assert model.responses(model.encoder.bits([[3, 3], [3, 0]])).tolist() == [[3, -3], [3, -3]]
    assert model.layers[0].sources.tolist() == [0]


def test_the_config_is_asked_for_where_there_is_none(write: Write, tmp_path: Path) -> None:
    path = write(tables(), config=None)
    with pytest.raises(
        InputError, match=r"do not say how wide .*; give the model's config\.json with --config"
    ):
        read(Source(path), ImportOptions())
    elsewhere = tmp_path / "other.json"
    elsewhere.write_text(json.dumps(CONFIG))
    assert read(Source(path), ImportOptions(config=elsewhere)).classes == ("0", "1")


@pytest.mark.parametrize(
    ("data", "config", "reason"),
    [
        (tables(), {"layers": [2, 1, 2]}, "no layers_bitwidth"),
        (tables(), {**CONFIG, "layers": [2.0, 1, 2]}, "no layers"),
        (tables(), {**CONFIG, "layers": [2, 1, 3]}, "4 edges; config.json asks for 5"),
        (tables(), {**CONFIG, "layers": [2, 1]}, "do not describe a network"),
        (tables(), {**CONFIG, "layers_bitwidth": [2, 99, 4]}, "do not describe a network"),
        (tables(), {**CONFIG, "layers_bitwidth": [3, 3, 4]}, "does not hold 8 whole numbers"),
        (tables(), {**CONFIG, "layers": [10**9, 1, 2]}, "4 edges; config.json asks for"),
        (tables(**{"0_0_0": edge(1, 2)}), CONFIG, "edge 0_0_0 does not hold 4 whole numbers"),
        (
            tables(**{"0_0_0": {"acive": 1, "values_int": [1, 2, 3, 4.5]}}),
            CONFIG,
            "not a list of whole numbers",
        ),
        (tables(**{"0_0_0": edge(1, 2, 3, 2**31)}), CONFIG, "beyond 32 bits"),
        (tables(**{"0_0_0": edge(1, 2, 3, 4, active=2)}), CONFIG, "active or not, 1 or 0, not 2"),
        (tables(**{"0_0_0": [1]}), CONFIG, "or a damaged one"),
    ],
)
def test_files_that_contradict_themselves_get_one_line(
    write: Write, data: dict[str, Any], config: dict[str, Any], reason: str
) -> None:
    with pytest.raises(InputError, match=reason):
        read(Source(write(data, config)), ImportOptions())


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=200)
@given(st.data())
def test_any_damage_gives_a_model_or_one_line(write: Write, data: st.DataObject) -> None:
    path = write(tables())
    damaged = data.draw(st.sampled_from([path, path.with_name("config.json")]))
    text = damaged.read_text()
    at = data.draw(st.integers(0, len(text) - 1))
    other = data.draw(st.sampled_from('0123456789"[]{},.-e'))
    damaged.write_text(text[:at] + other + text[at + data.draw(st.integers(0, 3)) :])
    with suppress(InputError):
        read(Source(path), ImportOptions())


@pytest.mark.realdata
@pytest.mark.parametrize("name", ["jsc_openml", "mnist"])
def test_recorded_vectors_are_reproduced(realdata: Path, name: str) -> None:
    folder = realdata / "kanele" / name
    model = read(Source(folder / "truth_tables.json"), ImportOptions())
    inputs, outputs = (np.loadtxt(folder / f"vectors_{way}.txt", dtype=int) for way in ("in", "out"))
    assert np.array_equal(model.responses(model.encoder.bits(inputs)), outputs)


@pytest.mark.realdata
def test_mnist_is_read_with_the_threshold_that_was_found_for_it(realdata: Path) -> None:
    model = read(Source(realdata / "kanele" / "mnist" / "truth_tables.json"), ImportOptions())
    digits = np.load(realdata / "mnist" / "mnist.npz")
    answers = model.evaluate(digits["x_test"].reshape(-1, 784) > 95)
    assert (answers == digits["y_test"]).mean() == pytest.approx(0.956, abs=0.001)
