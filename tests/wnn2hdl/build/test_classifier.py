"""A model file, a build and a picture give one and the same answer."""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from wnn2hdl.build.classifier import circuit_answers, circuit_classifier, open_classifier
from wnn2hdl.build.verification import open_build
from wnn2hdl.errors import InputError, ModelFileError
from wnn2hdl.evaluation.classifiers import model_classifier
from wnn2hdl.ir import BitSelect, LutNetwork, WisardModel, pixel_encoder
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.nodes import Table
from wnn2hdl.ir.wires import Port, Slice
from wnn2hdl.lower.deforestation import DECISION
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
    inputs = design.networks["pixel"].inputs
    nought_or_three = LutNetwork(inputs, (), (("class_bit0", inputs[0]), ("class_bit1", inputs[0])))
    encoder = pixel_encoder(design.picture_model)
    assert isinstance(encoder, BitSelect)
    code = tuple(Slice("rgb", position) for position in encoder.pixel_positions)
    pixel = design.parts["pixel"]
    wrong = replace(
        pixel,
        nodes=(Table(DECISION, code, nought_or_three),),
        drivers={"class_bits": (Slice(DECISION, 0, 2),)},
    )
    changed = replace(design, circuit=wrong)
    assert np.unique(circuit_classifier(changed).classify(PICTURE)).tolist() == [0, 1]


def test_the_circuit_of_a_build_remembers_its_colours_too(build: Path) -> None:
    design, _, _ = open_build(build)
    remembering = replace(design.picture_model, colours=np.array([0], dtype=np.int64))
    circuit = replace(circuit_classifier(design), care=np.ones(256, dtype=np.bool_))
    assert circuit.answer(PICTURE)[1].all()
    known = replace(circuit, colours=model_classifier(remembering).colours)
    assert not known.answer(PICTURE)[1].any()


def test_a_failed_build_answers_nothing(pixel_build: Path, tmp_path: Path) -> None:
    folder = shutil.copytree(pixel_build, tmp_path / "failed")
    (folder / "FAILED").write_text("differs from the model at code 3\n")
    with pytest.raises(InputError, match="the build failed: differs from the model at code 3: "):
        open_classifier(folder)


def test_what_is_no_model_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="not a build folder"):
        open_classifier(tmp_path)
    with pytest.raises(ModelFileError):
        open_classifier(tmp_path / "missing.json")


def test_a_circuits_answers_are_class_indices(build: Path) -> None:
    design = open_build(build)[0]
    network = LutNetwork(("a", "b"), (), (("class_bit0", "b"), ("class_bit1", "a")))
    code = (Slice("rgb", 0, 2),)
    wired = Circuit(
        "pixel",
        "Wires.",
        (Port("rgb", 24),),
        (Table(DECISION, code, network),),
        {"class_bits": (Slice(DECISION, 0, 2),)},
    )
    assert circuit_answers(replace(design, circuit=wired)).tolist() == [0, 2, 1, 3]
