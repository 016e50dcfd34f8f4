"""A network's circuit is measured on rows through words, and the model as it was given beside it."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.small_networks import encoder_of, lut_network
from wnn2hdl.build.compile import compile_model
from wnn2hdl.build.measuring import LabelledRows, labelled_data
from wnn2hdl.build.planning import CompileOptions
from wnn2hdl.dataset.tables import FeatureTable, read_table
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.rows import row_answers
from wnn2hdl.ir import BitSelect, WisardModel
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.ir.models import LutGroupModel, load_model
from wnn2hdl.report import report_markdown


def silent(step: str, done: int, total: int) -> None:
    pass


@pytest.fixture
def model() -> LutGroupModel:
    """A network that reads real numbers, of a range in which words of Q2.0 matter."""
    network = lut_network(2)
    return replace(network, encoder=replace(encoder_of(network), input=None))


@pytest.fixture
def table(tmp_path: Path, model: LutGroupModel) -> Path:
    """Rows of which the model answers five in six right."""
    features = np.random.default_rng(0).uniform(-5, 5, (300, 3)).round(3)
    path = tmp_path / "rows.csv"
    answers = row_answers(model, FeatureTable(("a", "b", "c"), features, ("",) * 300), None)
    answers[::6] = (answers[::6] + 1) % 3
    lines = [f"{a},{b},{c},class {i}\n" for (a, b, c), i in zip(features, answers, strict=True)]
    path.write_text("a,b,c,class\n" + "".join(lines))
    return path


@pytest.mark.slow
def test_a_build_states_what_words_cost_in_answers(model: LutGroupModel, table: Path, tmp_path: Path) -> None:
    options = CompileOptions(input="Q2.0", test_table=table, label="class")
    built = compile_model(model, tmp_path / "net", options, silent)
    report = json.loads((tmp_path / "net" / "report.json").read_text())
    rows = read_table(table, "class")
    narrow = replace(model, encoder=replace(encoder_of(model), input=FixedPoint(3, 0)))
    changed = int((row_answers(narrow, rows, None) != row_answers(model, rows, None)).sum())
    assert changed > 0
    assert report["rows"]["changed"] == changed
    assert report["rows"]["count"] == np.sum(report["confusion"]) == 300
    assert report["model_accuracy"] == pytest.approx(250 / 300)
    assert report["accuracy"] == pytest.approx(np.trace(report["confusion"]) / 300)
    low, high = report["rows"]["model_interval"]
    assert low < report["model_accuracy"] < high
    assert f"| rows on which circuit and model as given differ | {changed} of 300 |" in report_markdown(
        report
    )
    assert f'data-key="rows.changed" value="{changed}"' in (tmp_path / "net" / "report.html").read_text()
    assert built.report["evaluation"] == f"wnn2hdl evaluate net --table {table} --label class"


def test_rows_are_read_before_anything_is_built(model: LutGroupModel, table: Path) -> None:
    found = labelled_data(model, CompileOptions(test_table=table, label="class"))
    assert isinstance(found, LabelledRows)
    assert np.count_nonzero(found.answers == found.truth) == 250


@pytest.mark.parametrize(
    ("options", "line"),
    [
        ({"test_table": Path("t.csv"), "test_images": Path()}, "--test-table has no pictures"),
        ({"label": "class"}, "--label and --raw or --scaled are for tables; give --test-table too"),
        ({"raw": False}, "are for tables"),
        ({"test_images": Path()}, "these options go together: --test-images and --test-masks"),
    ],
)
def test_options_that_do_not_fit(model: LutGroupModel, options: dict[str, object], line: str) -> None:
    with pytest.raises(InputError, match=line):
        labelled_data(model, CompileOptions(**options))  # type: ignore[arg-type]


def test_a_table_is_no_test_of_a_model_of_pixels(table: Path) -> None:
    pixels = WisardModel(BitSelect(("R7",)), ("a", "b"), np.array([[[0]]]), np.array([[[1, 0]], [[0, 1]]]), 1)
    with pytest.raises(InputError, match="the model does not classify feature vectors"):
        labelled_data(pixels, CompileOptions(test_table=table, label="class"))


@pytest.mark.slow
def test_a_pruned_model_is_what_is_built_and_proved(
    model: LutGroupModel, table: Path, tmp_path: Path
) -> None:
    options = CompileOptions(
        input="Q2.4", prune=True, prune_table=table, most_changed=0.1, test_table=table, label="class"
    )
    with pytest.raises(InputError, match="the table has no such column"):
        compile_model(model, tmp_path / "net", replace(options, label="other"), silent)
    report = compile_model(model, tmp_path / "net", options, silent).report
    pruned = report["options"]["pruned"]
    assert 0 < pruned["tables"] < pruned["of"] == 12
    assert 0 < pruned["changed"] <= 30
    built = load_model(tmp_path / "net" / "model.json")
    assert isinstance(built, LutGroupModel)
    assert built.layers[-1].nodes == 12 - pruned["tables"]
    assert report["proof"]["status"] == "proved"
    assert report["model_accuracy"] == pytest.approx(250 / 300)
    assert report["rows"]["changed"] >= pruned["changed"] - 10
    assert "--prune" not in report["command"]
    text = report_markdown(report)
    assert f"| tables pruned; the proof is about the pruned model | {pruned['tables']} of 12 |" in text
    page = (tmp_path / "net" / "report.html").read_text()
    assert f'data-key="options.pruned.changed" value="{pruned["changed"]}"' in page


@pytest.mark.parametrize(
    ("options", "line"),
    [
        (CompileOptions(prune_table=Path("t.csv")), "are for --prune; give --prune too"),
        (CompileOptions(most_changed=0.1), "are for --prune"),
        (CompileOptions(prune=True, most_changed=0.1), "whose answers may change"),
    ],
)
def test_pruning_asks_for_what_it_needs(
    model: LutGroupModel, tmp_path: Path, options: CompileOptions, line: str
) -> None:
    with pytest.raises(InputError, match=line):
        compile_model(model, tmp_path / "net", options, silent)
