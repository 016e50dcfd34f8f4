"""`wnn2hdl import` as its users and programs read it."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from wnn2hdl.ir.models import load_model

Run = Callable[..., Any]

HALF_ADDER = "aag 7 2 0 2 3\n2\n4\n6\n12\n6 13 15\n12 2 4\n14 3 5\ni0 x\ni1 y\no0 s\no1 c\n"
EDGE = {"acive": 1, "values_int": [-1, 1, 0, 0]}


def test_a_network_becomes_a_model_file(run: Run, tmp_path: Path) -> None:
    source, model = tmp_path / "adder.aag", tmp_path / "model.json"
    source.write_text(HALF_ADDER)
    data = json.loads(run("import", source, "-o", model, "--json").stdout)
    loaded = load_model(model)
    assert data["digest"] == loaded.digest()
    assert {key: data[key] for key in ("format", "kind", "input_bits", "reads", "outputs")} == {
        "format": "aiger",
        "kind": "logic",
        "input_bits": 2,
        "reads": "2 bits as they are",
        "outputs": ["s", "c"],
    }
    assert data["origin"]["file"] == "adder.aag"
    assert len(data["origin"]["sha256"]) == 64


def test_the_text_says_what_the_model_reads(run: Run, tmp_path: Path) -> None:
    config, tables = tmp_path / "other.json", tmp_path / "tables.json"
    config.write_text(json.dumps({"layers": [1, 2], "layers_bitwidth": [2, 3]}))
    tables.write_text(json.dumps({"0_0_0": EDGE, "0_0_1": EDGE}))
    output = tmp_path / "model.json"
    text = run("import", tables, "--config", config, "-o", output).stdout
    assert (
        text == f"KANELÉ truth tables (JSON): reads 1 words of 2 bits, has 2 classes\nwritten to {output}\n"
    )


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (("--format", "onnx"), "'onnx' is not one of wisardpkg, bthowen, dwn, kanele, aiger, blif"),
        (("--format", "blif"), "not a BLIF file, or a damaged one"),
        (
            ("--classes", "3"),
            "an option does not apply to an and-inverter graph (AIGER): --classes; leave it out",
        ),
        (("--bleach", "0"), "0 is not in the range"),
    ],
)
def test_nothing_is_written_where_something_is_wrong(
    run: Run, tmp_path: Path, words: tuple[str, ...], complaint: str
) -> None:
    source, model = tmp_path / "adder.aag", tmp_path / "model.json"
    source.write_text(HALF_ADDER)
    assert complaint in run("import", source, "-o", model, *words).complaint()
    assert not model.exists()


@pytest.mark.realdata
def test_a_published_network_answers_as_recorded(run: Run, realdata: Path, tmp_path: Path) -> None:
    stem = realdata / "dwn" / "dwn_jsc_t4_distributive_300-100_lr"
    data = json.loads(run("import", f"{stem}_checkpoint.pt", "-o", tmp_path / "m.json", "--json").stdout)
    assert data["reads"] == "16 features as 64 thermometer bits"
    vectors = np.load(f"{stem}_testvectors.npz")
    model = load_model(tmp_path / "m.json")
    assert np.array_equal(model.evaluate(vectors["x_binarized"]), vectors["pred"])
