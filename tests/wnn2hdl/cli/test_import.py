"""`wnn2hdl import` as its users and programs read it."""

import base64
import json
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from wnn2hdl.ir.models import load_model

Run = Callable[..., Any]

HALF_ADDER = "aag 7 2 0 2 3\n2\n4\n6\n12\n6 13 15\n12 2 4\n14 3 5\ni0 x\ni1 y\no0 s\no1 c\n"
RAM = {"a": [(3, 2), (0, 1), (1, 1), (2, 1)], "b": [(1, 2), (2, 2)]}
WISARD = {
    "base": 2,
    "ignoreZero": False,
    "addressSize": 2,
    "bleachingActivated": True,
    "classes": {
        label: {
            "entrySize": 2,
            "mapping": [[0, 1]],
            "data": base64.b64encode(b"".join(struct.pack("<Qi", *record) for record in records)).decode(),
        }
        for label, records in RAM.items()
    },
}
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


def test_rows_say_which_fixed_threshold_is_most_often_right(run: Run, tmp_path: Path) -> None:
    source, table, model = tmp_path / "wisard.json", tmp_path / "rows.csv", tmp_path / "model.json"
    source.write_text(json.dumps(WISARD))
    table.write_text("x,y,class\n1,1,a\n0,0,a\n0,1,b\n1,0,b\n")
    words = ("import", source, "--table", table, "--label", "class", "-o", model)
    assert json.loads(run(*words, "--json").stdout)["accuracy"] == {
        "rows": 4,
        "model": 1.0,
        "fixed": {"1": 1.0, "2": 0.75},
    }
    assert (
        "100.0% of 4 rows are right; with a fixed threshold at most 100.0%: --bleach 1" in run(*words).stdout
    )


def test_a_model_whose_threshold_rises_is_not_compiled(run: Run, tmp_path: Path) -> None:
    source, model = tmp_path / "wisard.json", tmp_path / "model.json"
    source.write_text(json.dumps(WISARD))
    assert run("import", source, "-o", model).status == 0
    complaint = run("compile", model, "-o", tmp_path / "build").complaint()
    assert "the bleaching threshold is found again for each sample" in complaint
    assert "--bleach N; import --table says which N is most often right" in complaint


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (("--label", "class"), "only a table has labels"),
        (("--table", "rows.csv", "--label", "class"), "rows say nothing more about the model: logic"),
    ],
)
def test_rows_are_for_models_that_leave_something_open(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...], complaint: str
) -> None:
    monkeypatch.chdir(tmp_path)
    source, model = tmp_path / "adder.aag", tmp_path / "model.json"
    source.write_text(HALF_ADDER)
    (tmp_path / "rows.csv").write_text("x,y,class\n1,1,a\n")
    assert complaint in run("import", source, "-o", model, *words).complaint()
    assert not model.exists()


@pytest.mark.realdata
def test_thresholds_of_a_published_model_come_from_its_data(run: Run, realdata: Path, tmp_path: Path) -> None:
    source = realdata / "bthowen" / "iris.pickle.lzma"
    table = realdata / "uci" / "iris.csv"
    plain = run("import", source, "-o", tmp_path / "bits.json").stdout
    assert "reads 12 bits of 4 thermometers, has 3 classes" in plain
    fitted = run("import", source, "--table", table, "--label", "label", "-o", tmp_path / "m.json").stdout
    assert "reads 4 features as 12 thermometer bits, has 3 classes" in fitted
