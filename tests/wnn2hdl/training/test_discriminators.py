"""From images to a model, and back to how good it is."""

import numpy as np
import pytest

from wnn2hdl.dataset import CLASSES, Dataset, LabelledImage, from_samples
from wnn2hdl.encode import high_bits, parse_bits
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.accuracy import evaluate
from wnn2hdl.evaluation.classifiers import model_classifier
from wnn2hdl.ir import COLOURS, BitSelect, Thermometer, WisardModel, pixel_encoder
from wnn2hdl.progress import reported
from wnn2hdl.training.discriminators import IDENTICAL, image_histograms, train, with_colours


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
    assert evaluate(model_classifier(model), from_samples(2, 96, seed=90), silent).accuracy > 0.8


def test_histograms_count_every_pixel_by_image_and_class() -> None:
    assert image_histograms(two_pixels(1), parse_bits("R7"), silent).tolist() == [[[1, 0], [0, 1]]]


def test_one_class_is_refused_by_name() -> None:
    with pytest.raises(InputError, match="no training pixel is labelled deforested"):
        image_histograms(two_pixels(0), parse_bits("R7"), silent)


def test_more_bits_than_a_table_holds_are_refused() -> None:
    with pytest.raises(InputError, match="at most 20"):
        image_histograms(two_pixels(1), high_bits(7), silent)


def test_a_model_of_features_is_no_pixel_model() -> None:
    counts = np.zeros((2, 1, 2), dtype=np.int64)
    model = WisardModel(Thermometer(((0.5,),)), ("a", "b"), np.zeros((1, 1, 1), dtype=np.int64), counts, 1)
    with pytest.raises(InputError, match="does not read pixels"):
        pixel_encoder(model)


def test_a_model_remembers_the_colours_it_was_shown() -> None:
    dataset = from_samples(2, 32, seed=3)
    model = train(dataset, parse_bits("R7,G7"), address_bits=2, rams=1, bleaching=1, seed=0, progress=silent)
    remembering = with_colours(model, dataset, silent)
    shown = np.concatenate([image.pixels for image in dataset])
    assert remembering.colours is not None
    assert np.array_equal(remembering.colours, np.unique(COLOURS.codes(shown)))
    assert remembering.digest() == model.digest()
    assert remembering.training[IDENTICAL] == []


def test_images_that_show_the_same_are_noticed_whatever_their_labels() -> None:
    one, other = np.random.default_rng(0).integers(0, 256, (2, 9, 3)).astype(np.uint8)
    shown = {"a": one, "b": other, "c": one}

    def load(name: str) -> LabelledImage:
        return LabelledImage(name, shown[name], np.arange(9, dtype=np.uint8) % 2 ^ (name == "c"))

    dataset = Dataset(CLASSES, ("a", "b", "c"), load)
    model = train(dataset, BitSelect(("R7",)), address_bits=1, rams=1, bleaching=1, seed=0, progress=silent)
    assert with_colours(model, dataset, silent).training[IDENTICAL] == [["a", "c"]]


def test_balanced_classes_weigh_alike_so_that_a_rare_one_is_found() -> None:
    pixels = np.repeat(np.array([[0, 0, 0], [255, 0, 0], [255, 255, 0]], dtype=np.uint8), [90, 9, 1], axis=0)
    labels = np.repeat(np.array([0, 0, 1], dtype=np.uint8), [90, 9, 1])
    dataset = Dataset(CLASSES, ("a",), lambda name: LabelledImage(name, pixels, labels))
    found = {
        balanced: train(
            dataset,
            parse_bits("R7,G7"),
            address_bits=2,
            rams=1,
            bleaching=5,
            balanced=balanced,
            seed=0,
            progress=silent,
        )
        for balanced in (False, True)
    }
    bits = parse_bits("R7,G7").codes(pixels[-1:])
    assert [int(model.evaluate_all_codes()[bits][0]) for model in found.values()] == [0, 1]
    assert [int(model.counts[1].sum()) for model in found.values()] == [1, 99]
    assert [model.training["pixels"] for model in found.values()] == [100, 100]


def test_a_stage_is_told_of_when_it_starts_and_after_each_item() -> None:
    seen_steps: list[tuple[str, int, int]] = []

    def report(step: str, done: int, total: int) -> None:
        seen_steps.append((step, done, total))

    for item in reported("ab", "reading", 2, report):
        report(item, -1, -1)
    assert seen_steps == [
        ("reading", 0, 2),
        ("a", -1, -1),
        ("reading", 1, 2),
        ("b", -1, -1),
        ("reading", 2, 2),
    ]
    assert list(reported((), "reading", 0, report)) == []
    assert len(seen_steps) == 5
