"""`narrow` as a user meets it."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.small_networks import encoder_of, lut_network
from wnn2hdl.evaluation.rows import feature_answers
from wnn2hdl.ir.models import load_model

Run = Callable[..., Any]


@pytest.fixture
def words(tmp_path: Path) -> tuple[object, ...]:
    """A model of real numbers and rows for it, as words of the command line."""
    network = lut_network(2)
    replace(network, encoder=replace(encoder_of(network), input=None)).save(tmp_path / "m.json")
    features = np.random.default_rng(0).uniform(-5, 5, (200, 3))
    np.savez(tmp_path / "rows.npz", x_test=features, y_test=np.zeros(200, dtype=int))
    return (tmp_path / "m.json", "--table", tmp_path / "rows.npz", "-o", tmp_path / "n.json")


def test_a_model_is_narrowed_and_says_how_far(run: Run, words: tuple[Any, ...], tmp_path: Path) -> None:
    data = json.loads(run("narrow", *words, "--most-changed", 0.02, "--json").stdout)
    assert (data["rows"], data["most_changed"]) == (200, 4)
    models: list[Any] = [load_model(tmp_path / name) for name in ("m.json", "n.json")]
    features = np.load(tmp_path / "rows.npz")["x_test"]
    answers = [feature_answers(model, features) for model in models]
    assert data["changed"] == np.count_nonzero(answers[0] != answers[1]) <= 4
    assert data["format"] == str(models[1].encoder.input)
    assert data["unseen"]["rows"] == 100
    assert data["formats"][0]["format"].endswith(".12")
    text = run("narrow", *words).stdout
    assert "0 of 200 answers change; the encoder takes about" in text
    assert "of the 100 answers that it did not see" in text


def test_rows_are_asked_for(run: Run, words: tuple[Any, ...]) -> None:
    assert "give a table with --table" in run("narrow", words[0], "-o", words[4]).complaint()
