"""A model file, a build and a picture give one and the same answer."""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from wnn2hdl.build.classifier import circuit_classifier, open_classifier
from wnn2hdl.build.verification import open_build
from wnn2hdl.encode import parse_bits
from wnn2hdl.errors import InputError, ModelFileError
from wnn2hdl.evaluation.classifiers import PixelTable, familiar_codes, model_classifier
from wnn2hdl.ir import COLOURS, BitSelect, LutNetwork, Thermometer, WisardModel, codes_to_bits
from wnn2hdl.samples import landscape
from wnn2hdl.wisard import PixelClassifier

PICTURE = landscape(40, 50, seed=7).image


def test_a_model_file_answers_as_the_model(model: WisardModel, tmp_path: Path) -> None:
    model.save(tmp_path / "model.json")
    classifier = open_classifier(tmp_path / "model.json")
    assert classifier.classes == model.classes
    assert classifier.halo == 0
    assert np.array_equal(classifier.classify(PICTURE), PixelClassifier(model).classify(PICTURE))


def test_a_build_answers_as_its_model_where_it_cares(model: WisardModel, build: Path) -> None:
    circuit, trained = open_classifier(build), model_classifier(model)
    answers, cared = circuit.answer(PICTURE)
    assert cared.mean() > 0.9
    assert np.array_equal(answers[cared], trained.classify(PICTURE)[cared])


def test_an_answer_that_is_no_class_is_taken_for_the_last_one(build: Path) -> None:
    design, _, _ = open_build(build)
    inputs = design.decision.inputs
    nought_or_three = LutNetwork(inputs, (), (("class_bit0", inputs[0]), ("class_bit1", inputs[0])))
    changed = replace(design, networks={**design.networks, "pixel": nought_or_three})
    assert np.unique(circuit_classifier(changed).classify(PICTURE)).tolist() == [0, 1]


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


def test_the_circuit_of_a_build_remembers_its_colours_too(build: Path) -> None:
    design, _, _ = open_build(build)
    remembering = replace(design.model, colours=np.array([0], dtype=np.int64))
    circuit = replace(circuit_classifier(design), care=np.ones(256, dtype=np.bool_))
    assert circuit.answer(PICTURE)[1].all()
    known = replace(circuit, colours=model_classifier(remembering).colours)
    assert not known.answer(PICTURE)[1].any()


def test_what_was_seen_too_rarely_to_fire_is_familiar_all_the_same(model: WisardModel) -> None:
    fires_fully = model.responses(codes_to_bits(np.arange(256), 8)) == model.rams
    familiar = familiar_codes(model)
    assert model.bleaching > 1
    assert familiar[fires_fully.any(axis=1)].all()
    assert familiar.sum() > fires_fully.any(axis=1).sum()


def test_a_failed_build_answers_nothing(pixel_build: Path, tmp_path: Path) -> None:
    folder = shutil.copytree(pixel_build, tmp_path / "failed")
    (folder / "FAILED").write_text("differs from the model at code 3\n")
    with pytest.raises(InputError, match="the build failed: differs from the model at code 3: "):
        open_classifier(folder)


def test_what_is_no_model_is_refused(model: WisardModel, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="not a build folder"):
        open_classifier(tmp_path)
    with pytest.raises(ModelFileError):
        open_classifier(tmp_path / "missing.json")
    features = WisardModel(
        Thermometer(((0.5, 1.5),)),
        ("a", "b"),
        np.array([[[0, 1]]]),
        np.ones((2, 1, 4), dtype=np.int64),
        bleaching=1,
    )
    with pytest.raises(InputError, match="does not read pixels"):
        model_classifier(features)
