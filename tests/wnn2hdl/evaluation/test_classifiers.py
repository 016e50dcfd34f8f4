"""Classifiers of pictures: their answers, and what they know."""

from dataclasses import replace

import numpy as np
import pytest

from wnn2hdl.encode import parse_bits
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.classifiers import PixelTable, familiar_codes, model_classifier
from wnn2hdl.ir import COLOURS, BitSelect, Thermometer, WisardModel, codes_to_bits
from wnn2hdl.samples import landscape

PICTURE = landscape(40, 50, seed=7).image


def test_colours_of_the_training_are_familiar_and_foreign_ones_are_not(model: WisardModel) -> None:
    classifier = model_classifier(model)
    assert classifier.answer(landscape(64, 64, seed=1).image)[1].all()
    violet = np.full((2, 3, 3), (255, 0, 255), dtype=np.uint8)
    assert not classifier.answer(violet)[1].any()


def test_a_model_that_remembers_its_colours_knows_no_others(model: WisardModel) -> None:
    codes = COLOURS.codes(PICTURE)
    model = replace(model, colours=np.unique(codes)[:-1].astype(np.int64))
    assert np.array_equal(model_classifier(model).answer(PICTURE)[1], codes != codes.max())


@pytest.mark.parametrize("encoder", [COLOURS, parse_bits("R7,G6,B5,B0")])
def test_an_answer_is_the_class_and_whether_code_and_colour_are_known(encoder: BitSelect) -> None:
    rng = np.random.default_rng(0)
    size = 1 << encoder.width
    answers, care = rng.integers(0, 2, size, dtype=np.uint8), rng.random(size) < 0.7
    colours = rng.random(1 << COLOURS.width) < 0.7
    table = PixelTable(("forest", "deforested"), encoder, answers, care, colours)
    classes, known = table.answer(PICTURE)
    codes = encoder.codes(PICTURE)
    assert np.array_equal(classes, answers[codes])
    assert np.array_equal(classes, table.classify(PICTURE))
    assert np.array_equal(known, care[codes] & colours[COLOURS.codes(PICTURE)])


def test_what_was_seen_too_rarely_to_fire_is_familiar_all_the_same(model: WisardModel) -> None:
    fires_fully = model.responses(codes_to_bits(np.arange(256), 8)) == model.rams
    familiar = familiar_codes(model)
    assert model.bleaching > 1
    assert familiar[fires_fully.any(axis=1)].all()
    assert familiar.sum() > fires_fully.any(axis=1).sum()


def test_a_model_of_features_classifies_no_pictures() -> None:
    features = WisardModel(
        Thermometer(((0.5, 1.5),)),
        ("a", "b"),
        np.array([[[0, 1]]]),
        np.ones((2, 1, 4), dtype=np.int64),
        bleaching=1,
    )
    with pytest.raises(InputError, match="does not read pixels"):
        model_classifier(features)
