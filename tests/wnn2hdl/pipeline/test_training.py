"""From images to a model, and back to how good it is."""

import numpy as np
import pytest

from wnn2hdl.dataset import CLASSES, Dataset, LabelledImage, from_samples
from wnn2hdl.encode import high_bits, parse_bits
from wnn2hdl.errors import InputError
from wnn2hdl.ir import LutNetwork, Thermometer, WisardModel
from wnn2hdl.pipeline.evaluation import circuit_answers, evaluate
from wnn2hdl.pipeline.training import image_histograms, pixel_encoder, train


def silent(step: str, done: int, total: int) -> None:
    pass


def two_pixels(label: int) -> Dataset:
    pixels = np.array([[0, 0, 0], [255, 0, 0]], dtype=np.uint8)
    labels = np.array([0, label], dtype=np.uint8)
    return Dataset(CLASSES, ("a",), lambda name: LabelledImage(name, pixels, labels))


def test_the_embedded_landscapes_are_learned() -> None:
    model = train(
        from_samples(4, 96, seed=0),
        high_bits(),
        address_bits=4,
        rams=16,
        bleaching=None,
        seed=0,
        progress=silent,
    )
    result = evaluate(model.evaluate_all_codes(), pixel_encoder(model), from_samples(2, 96, seed=90), silent)
    assert result.accuracy > 0.8
    assert list(result.accuracies) == ["landscape-00090", "landscape-00091"]
    assert result.codes.sum() == 2 * 96 * 96


def test_histograms_count_every_pixel_by_image_and_class() -> None:
    assert image_histograms(two_pixels(1), parse_bits("R7"), silent).tolist() == [[[1, 0], [0, 1]]]


def test_one_class_is_refused_by_name() -> None:
    with pytest.raises(InputError, match="no training pixel is labelled deforested"):
        image_histograms(two_pixels(0), parse_bits("R7"), silent)


def test_more_bits_than_a_table_holds_are_refused() -> None:
    with pytest.raises(InputError, match="at most 20"):
        image_histograms(two_pixels(1), high_bits(7), silent)


def test_an_evaluation_counts_by_true_class_and_answer() -> None:
    always_forest = np.zeros(2, dtype=np.int64)
    result = evaluate(always_forest, parse_bits("R7"), two_pixels(1), silent)
    assert result.confusion.tolist() == [[[1, 0], [1, 0]]]
    assert result.accuracy == 0.5


def test_more_classes_than_the_masks_have_are_refused() -> None:
    with pytest.raises(InputError, match="more classes than the masks"):
        evaluate(np.array([0, 2]), parse_bits("R7"), two_pixels(1), silent)


def test_a_circuits_answers_are_class_indices() -> None:
    network = LutNetwork(("a", "b"), (), (("class_bit0", "b"), ("class_bit1", "a")))
    assert circuit_answers(network).tolist() == [0, 2, 1, 3]


def test_a_model_of_features_is_no_pixel_model() -> None:
    counts = np.zeros((2, 1, 2), dtype=np.int64)
    model = WisardModel(Thermometer(((0.5,),)), ("a", "b"), np.zeros((1, 1, 1), dtype=np.int64), counts, 1)
    with pytest.raises(InputError, match="does not read pixels"):
        pixel_encoder(model)
