import base64
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from wnn2hdl.encode import high_bits, parse_bits
from wnn2hdl.errors import InputError
from wnn2hdl.ir import PIXEL_BIT_NAMES, BitSelect, Thermometer, WisardModel, codes_to_bits
from wnn2hdl.wisard import PixelClassifier, WisardClassifier, draw_mapping, train_histogram


@st.composite
def labelled_pixels(draw: st.DrawFn) -> tuple[BitSelect, NDArray[np.uint8], NDArray[np.int64]]:
    names = draw(st.permutations(sorted(PIXEL_BIT_NAMES)))[: draw(st.integers(2, 9))]
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    labels = np.r_[0, 1, 2, rng.integers(0, 3, draw(st.integers(0, 60)))]
    return BitSelect(tuple(names)), rng.integers(0, 256, (len(labels), 3)).astype(np.uint8), labels


@given(labelled_pixels(), st.sampled_from([1, 3]), st.integers(0, 9))
def test_a_histogram_trains_as_its_pixels_do(
    case: tuple[BitSelect, NDArray[np.uint8], NDArray[np.int64]], groups: int, seed: int
) -> None:
    encoder, pixels, labels = case
    codes = encoder.codes(pixels)
    mapping = np.concatenate([draw_mapping(encoder.width, 4, 2, seed + group) for group in range(groups)])
    histogram = np.stack([np.bincount(codes[labels == c], minlength=1 << encoder.width) for c in range(3)])
    by_histogram = train_histogram(histogram, encoder, ("0", "1", "2"), mapping, 2)
    by_pixel = WisardClassifier(mapping=mapping, bleaching=2).fit(codes_to_bits(codes, encoder.width), labels)
    assert by_histogram.to_json() == by_pixel.model(encoder).to_json()


def test_what_the_training_was_is_noted() -> None:
    model = train_histogram(
        np.ones((2, 4), dtype=np.int64), parse_bits("R7,B7"), ("a", "b"), MAPPING, 1, {"x": 1}
    )
    assert model.training == {"x": 1}


MAPPING = np.array([[[0, 1]]])


def test_a_class_without_pixels_gets_one_line() -> None:
    histogram = np.array([[1, 2, 3, 4], [0, 0, 0, 0]])
    with pytest.raises(InputError, match="a class has no training pixels: deforested; give images"):
        train_histogram(histogram, parse_bits("R7,B7"), ("forest", "deforested"), MAPPING, 1)


@given(labelled_pixels())
def test_an_image_is_classified_as_the_model_says(
    case: tuple[BitSelect, NDArray[np.uint8], NDArray[np.int64]],
) -> None:
    encoder, pixels, labels = case
    codes = encoder.codes(pixels)
    histogram = np.stack([np.bincount(codes[labels == c], minlength=1 << encoder.width) for c in range(3)])
    model = train_histogram(histogram, encoder, ("0", "1", "2"), draw_mapping(encoder.width, 4, 2, 0), 1)
    classifier = PixelClassifier(model)
    assert (
        classifier.classify(pixels).tolist() == model.evaluate(codes_to_bits(codes, encoder.width)).tolist()
    )


def test_an_image_gives_an_image_of_class_indices() -> None:
    model = train_histogram(
        np.array([[9, 0, 0, 0], [0, 5, 5, 5]]), parse_bits("R7,B7"), ("a", "b"), MAPPING, 1
    )
    image = np.zeros((2, 3, 3), dtype=np.uint8)
    image[1, 2] = (255, 0, 0)
    classes = PixelClassifier(model).classify(image[:, ::-1])
    assert classes.dtype == np.uint8
    assert classes.tolist() == [[0, 0, 0], [1, 0, 0]]


def test_codes_wider_than_16_bits() -> None:
    encoder = high_bits(6)
    model = WisardModel(encoder, ("a", "b"), np.array([[[17]]]), np.array([[[1, 0]], [[0, 1]]]), 1)
    pixels = np.random.default_rng(0).integers(0, 256, (50, 3)).astype(np.uint8)
    classifier = PixelClassifier(model)
    assert np.array_equal(classifier.classify(pixels), pixels[:, 2] >> 2 & 1)


def test_models_that_no_table_of_pixels_holds() -> None:
    counts = np.ones((2, 1, 2), dtype=np.int64)
    features = WisardModel(Thermometer(((1.0,),)), ("a", "b"), np.array([[[0]]]), counts, 1)
    with pytest.raises(
        InputError, match=r"the model does not read pixels: .*thermometer; use one that was trained"
    ):
        PixelClassifier(features)
    with pytest.raises(InputError, match="too large for a table: 21 bits, 2 classes; choose at most 20"):
        PixelClassifier(replace(features, encoder=high_bits(7)))


def wisardpkg_model(path: Path) -> WisardModel:
    """Mapping and counts of a model saved by wisardpkg 1.6.3; forest first, as it gets the ties."""
    classes = ("forest", "deforested")
    saved = json.loads(path.read_text())["classes"]
    record = np.dtype([("address", "<u8"), ("count", "<i4")])
    mapping = np.array([saved[name]["mapping"] for name in classes])
    counts = np.zeros((*mapping.shape[:2], 1 << mapping.shape[2]), dtype=np.int64)
    for owner, name in enumerate(classes):
        for ram, part in enumerate(saved[name]["data"].split(".")):
            entries = np.frombuffer(base64.b64decode(part), dtype=record)
            counts[owner, ram, entries["address"].astype(np.int64)] = entries["count"]
    return WisardModel(high_bits(), classes, mapping, counts, 1)


def wisardpkg_answers(path: Path) -> NDArray[np.int64]:
    """Its class index for each code of ours; it lists codes by the number whose highest bit is input 0."""
    answers = json.loads(path.read_text())["predictions_for_codes_0_to_4095"]
    ours = np.array([int(f"{code:012b}"[::-1], 2) for code in range(4096)])
    return np.array([("forest", "deforested").index(answers[theirs]) for theirs in ours])


@pytest.mark.realdata
def test_wisardpkg_answers_the_same_without_bleaching(realdata: Path) -> None:
    model = wisardpkg_model(realdata / "wisardpkg" / "pixels_n4.json")
    answers = wisardpkg_answers(realdata / "wisardpkg" / "pixels_n4.predictions.json")
    assert np.array_equal(PixelClassifier(model).table, answers)


@pytest.mark.realdata
def test_wisardpkg_answers_the_same_if_ties_raise_the_threshold(realdata: Path) -> None:
    model = wisardpkg_model(realdata / "wisardpkg" / "pixels_n4_bleach.json")
    bits = codes_to_bits(range(4096), 12)
    found = np.zeros(4096, dtype=np.int64)
    tied = np.ones(4096, dtype=np.bool_)
    threshold = 0
    while tied.any():
        threshold += 1
        responses = replace(model, bleaching=threshold).responses(bits[tied])
        found[tied] = responses.argmax(axis=1)
        still = (responses[:, 0] == responses[:, 1]) & (responses[:, 0] > 1)
        tied[tied] = still
    answers = wisardpkg_answers(realdata / "wisardpkg" / "pixels_n4_bleach.predictions.json")
    assert threshold > 1
    assert np.array_equal(found, answers)
