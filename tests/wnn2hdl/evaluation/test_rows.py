from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from wnn2hdl.dataset.tables import FeatureTable
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.rows import load_vector_classifier, row_confusion, scaled
from wnn2hdl.ir import BitSelect, Thermometer, WisardModel, Words
from wnn2hdl.ir.models import LogicModel, LutGroupModel, LutLayer

# Says "high" where the only feature is above 1.
layer = LutLayer(np.zeros((2, 1), dtype=np.int32), np.array([[True, False], [False, True]]))
model = LutGroupModel(
    Thermometer(((1.0,),), strict=True), ("low", "high"), (layer,), np.array([0, 1], dtype=np.int32)
)
noted = replace(model, origin={"scaler": {"mean": [10.0], "scale": [2.0]}})


def table(*rows: tuple[float, str]) -> FeatureTable:
    return FeatureTable(("x",), np.array([[x] for x, _ in rows]), tuple(label for _, label in rows))


def test_rows_are_counted_by_class_and_answer() -> None:
    rows = table((0, "low"), (1, "low"), (2, "low"), (3, "high"))
    assert row_confusion(model, rows, raw=None).tolist() == [[2, 1], [0, 1]]


def test_raw_features_are_scaled_as_the_model_notes() -> None:
    rows = table((11.0, "low"), (13.0, "high"))
    assert scaled(noted, rows, raw=True).tolist() == [[0.5], [1.5]]
    assert row_confusion(noted, rows, raw=True).tolist() == [[1, 0], [0, 1]]
    assert row_confusion(noted, rows, raw=False).tolist() == [[0, 1], [0, 1]]


def test_whether_features_are_scaled_is_never_guessed() -> None:
    with pytest.raises(
        InputError, match=r"it is not said whether the table's are; give --scaled if they are, --raw if"
    ):
        row_confusion(noted, table((1.0, "low")), raw=None)
    with pytest.raises(InputError, match="records no scaling: --raw"):
        row_confusion(model, table((1.0, "low")), raw=True)
    other = replace(model, origin={"scaler": {"mean": [1.0, 2.0], "scale": [1.0, 1.0]}})
    with pytest.raises(InputError, match="for another number of features: 2"):
        row_confusion(other, table((1.0, "low")), raw=True)


def test_tables_that_the_model_cannot_read() -> None:
    with pytest.raises(InputError, match="no class for a label: middle; it has low, high"):
        row_confusion(model, table((1.0, "middle")), raw=None)
    wide = FeatureTable(("x", "y"), np.zeros((1, 2)), ("low",))
    with pytest.raises(InputError, match="another number of features than the model reads: 2, not 1"):
        row_confusion(model, wide, raw=None)
    with pytest.raises(InputError, match="cannot read the features: features must be whole numbers"):
        row_confusion(replace(model, encoder=Words(1)), table((0.5, "low")), raw=None)


def test_only_classifiers_of_feature_vectors_are_loaded(tmp_path: Path) -> None:
    path = tmp_path / "m.json"
    model.save(path)
    assert load_vector_classifier(path).digest() == model.digest()
    counts = np.array([[[1, 0]], [[0, 1]]])
    gates = LogicModel(("a",), ("y",), np.empty((0, 2), dtype=np.uint32), np.array([2], dtype=np.uint32))
    for other in (WisardModel(BitSelect(("R7",)), ("a", "b"), np.array([[[0]]]), counts, 1), gates):
        other.save(path)
        with pytest.raises(InputError, match="does not classify feature vectors"):
            load_vector_classifier(path)
