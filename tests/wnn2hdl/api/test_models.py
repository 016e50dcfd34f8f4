"""Models from arrays, without a file."""

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.api import Model, evaluate, evaluate_table, load, train, train_table
from wnn2hdl.dataset import from_masks
from wnn2hdl.errors import InputError
from wnn2hdl.images import write_png
from wnn2hdl.ir import Context, Neighbourhood, WisardModel
from wnn2hdl.samples import landscape
from wnn2hdl.training.tables import TableOptions

Arrays = tuple[list[NDArray[np.uint8]], list[NDArray[np.bool_]]]


@pytest.fixture(scope="module")
def arrays() -> Arrays:
    scenes = [landscape(48, 48, seed) for seed in range(3)]
    return [scene.image for scene in scenes], [scene.deforested for scene in scenes]


@pytest.fixture(scope="module")
def model(arrays: Arrays) -> Model:
    return train(*arrays, bits="R7,R6,R5,B7,B6,B5", rams=4, bleaching=5)


def test_arrays_train_what_files_of_them_train(arrays: Arrays, model: Model, tmp_path: Path) -> None:
    images, masks = tmp_path / "images", tmp_path / "masks"
    images.mkdir()
    masks.mkdir()
    for number, (picture, mask) in enumerate(zip(*arrays, strict=True)):
        write_png(images / f"{number}.png", picture)
        write_png(masks / f"{number}.png", mask)
    options = {"bits": "R7,R6,R5,B7,B6,B5", "rams": 4, "bleaching": 5}
    of_folders = train(images, str(masks), **options)  # type: ignore[arg-type]
    of_dataset = train(from_masks(images, masks), **options)  # type: ignore[arg-type]
    assert model.model.digest() == of_folders.model.digest() == of_dataset.model.digest()


@pytest.mark.slow
def test_a_budget_and_a_neighbourhood_train_other_classifiers(arrays: Arrays) -> None:
    budget = train(*arrays, luts_per_pixel=1, trials=0)
    assert isinstance(budget.model, WisardModel)
    assert budget.model.training["luts"] <= 1
    window = train(*arrays, neighbourhood=3)
    assert isinstance(window.model, WisardModel)
    assert isinstance(window.model.encoder, Neighbourhood)
    counts = train(*arrays, context=3)
    assert isinstance(counts.model, WisardModel)
    assert isinstance(counts.model.encoder, Context)


def test_a_model_says_what_it_is_and_can_be_kept(model: Model, tmp_path: Path) -> None:
    assert "4 of 4 address bits for each class" in repr(model)
    assert "<th" in model._repr_html_()
    model.save(tmp_path / "model.json")
    assert load(tmp_path / "model.json").model.digest() == model.model.digest()


def test_a_model_is_measured(arrays: Arrays, model: Model) -> None:
    found = evaluate(model, *arrays)
    assert found.confusion.sum() == 3 * 48 * 48
    assert found.interval is not None
    assert found.interval[0] <= found.accuracy <= found.interval[1]
    assert set(found.per_class) == {"forest", "deforested"}
    assert f"{found.accuracy:.2%}" in repr(found)


def test_unlabelled_pixels_count_nowhere(arrays: Arrays, model: Model) -> None:
    images, masks = arrays
    some = [mask.astype(np.uint8) for mask in masks]
    some[0][:10] = 255
    assert evaluate(model, images, some).confusion.sum() == 3 * 48 * 48 - 480


def test_rows_train_and_measure() -> None:
    rng = np.random.default_rng(0)
    features = np.concatenate([rng.integers(0, 9, (40, 3)), rng.integers(6, 15, (40, 3))])
    labels = ["low"] * 40 + ["high"] * 40
    model = train_table(features, labels, options=TableOptions(address_bits=4))
    found = evaluate_table(model, features, labels)
    assert found.accuracy > 0.9
    assert found.classes == ("high", "low")


@pytest.mark.parametrize(
    ("images", "masks", "fault"),
    [
        ([np.zeros((4, 4, 3), np.uint8)], None, "pictures go together with masks"),
        ("images", [np.zeros((4, 4), np.uint8)], "one is a folder and the other is not"),
        ([np.zeros((4, 4, 3), np.uint8)], [], "each picture has a mask: 1 pictures, 0 masks"),
        ([np.zeros((4, 4, 3))], [np.zeros((4, 4))], r"a picture is uint8 \[height, width, 3\]: float64"),
        ([np.zeros((4, 4, 3), np.uint8)], [np.zeros((4, 5))], "a mask has its picture's shape"),
        ([np.zeros((4, 4, 3), np.uint8)], [np.full((4, 4), 7)], "a mask holds class indices: 7"),
        ([np.zeros((4, 4, 3), np.uint8)], [np.full((4, 4), 256)], "a mask holds class indices: 256"),
        ([np.zeros((4, 4, 3), np.uint8)], [np.full((4, 4), 0.5)], r"a mask holds class indices: 0\.5"),
    ],
)
def test_what_does_not_fit_is_refused(images: object, masks: object, fault: str) -> None:
    with pytest.raises(InputError, match=fault):
        train(images, masks, bleaching=1)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("choice", "fault"),
    [
        ({"context": 7, "luts_per_pixel": 10}, "context= chooses the classifier itself"),
        ({"context": 7, "neighbourhood": 3}, "context= chooses the classifier itself"),
        ({"context": 5}, "there is no such context: 5; choose one of 3, 7, 15, 31"),
        ({"nested": True}, "only a choice within luts_per_pixel= is nested"),
        ({"nested": True, "neighbourhood": 3, "luts_per_pixel": 4}, "only a choice within luts_per_pixel="),
    ],
)
def test_choices_that_contradict_each_other_are_refused(
    arrays: Arrays, choice: dict[str, int], fault: str
) -> None:
    with pytest.raises(InputError, match=fault):
        train(*arrays, **choice)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("features", "labels", "fault"),
    [
        (
            [["red"], ["green"]],
            ["a", "b"],
            "features are numbers .* could not convert string to float: 'red'",
        ),
        ([[1], [2, 3]], ["a", "b"], "features are numbers"),
        ([[1, 2], [3, 4]], ["a"], "with a label each"),
        ([1, 2], ["a", "b"], "features are numbers"),
        ([[1, 2], [3, np.nan]], ["a", "b"], "not a finite number"),
        ([[1], [2], [3]], ["a", "b", None], "a label is missing"),
        ([[1], [2], [3]], [0.0, 1.0, np.nan], "a label is missing"),
    ],
)
def test_rows_that_do_not_fit_are_refused(features: object, labels: list[str], fault: str) -> None:
    with pytest.raises(InputError, match=fault):
        train_table(features, labels)  # type: ignore[arg-type]


def test_real_numbers_need_a_format_of_words() -> None:
    with pytest.raises(InputError, match="the features are no whole numbers"):
        train_table([[0.5], [0.7]], ["a", "b"], max_luts=20)
