"""Models that look at a pixel's neighbours: trained, compiled, proved, and run over pictures."""

import json
import re
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from wnn2hdl.build.classifier import open_classifier
from wnn2hdl.build.compile import compile_model
from wnn2hdl.build.design import Design
from wnn2hdl.build.planning import CompileOptions, plan
from wnn2hdl.build.playback import play
from wnn2hdl.build.verification import verify_build
from wnn2hdl.dataset import CLASSES, Dataset, LabelledImage, from_samples
from wnn2hdl.emit import write_manifest
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.accuracy import evaluate
from wnn2hdl.evaluation.classifiers import model_classifier
from wnn2hdl.images import UNLABELLED, Picture, read_rgb
from wnn2hdl.ir import BitSelect, Neighbourhood, Tap, WisardModel, pixel_encoder
from wnn2hdl.training.budget import LIGHT
from wnn2hdl.training.neighbourhood import _draw, train_neighbourhood


def silent(step: str, done: int, total: int) -> None:
    pass


def random_neighbourhood(size: int) -> WisardModel:
    """Six random taps over two pixel bits each, and a random table over them."""
    rng = np.random.default_rng(size)
    names = [("R7", "R6"), ("R5", "G6"), ("G7", "B6"), ("B7", "R4"), ("R6", "B5"), ("G5", "G4")]
    taps = tuple(
        Tap(int(rng.integers(size)), int(rng.integers(size)), BitSelect(bits), int(rng.integers(1, 15)))
        for bits in names
    )
    answers = rng.integers(2, size=64)
    counts = (answers == np.arange(2)[:, np.newaxis]).astype(np.int64)[:, np.newaxis]
    mapping = np.arange(6).reshape(1, 1, 6)
    return WisardModel(Neighbourhood(size, taps), ("forest", "deforested"), mapping, counts, 1)


@pytest.fixture(scope="module")
def neighbourhood_build(
    imagery: Path, tested: CompileOptions, tmp_path_factory: pytest.TempPathFactory
) -> Path:
    """A 5x5 neighbourhood in domain mode, compiled once."""
    folder = tmp_path_factory.mktemp("builds") / "five"
    options = replace(tested, mode="domain", care=imagery, care_minimum=20)
    built = compile_model(random_neighbourhood(5), folder, options, silent)
    assert built.failure is None
    return folder


@pytest.mark.slow
def test_a_trained_neighbourhood_classifies_other_landscapes() -> None:
    model = train_neighbourhood(from_samples(4, 96, seed=1), 3, luts_per_pixel=13, seed=0, progress=silent)
    result = evaluate(model_classifier(model), from_samples(3, 96, seed=50), silent)
    assert result.accuracy > 0.85
    assert model.training["luts"] == 13
    promised = model.training[LIGHT]["1"]
    assert 0.6 < promised["worst_image"] < promised["accuracy"] < 1
    assert model.training["images"] == [f"landscape-{seed:05d}" for seed in range(1, 5)]


def test_nothing_is_promised_by_one_image_or_if_one_fold_alone_shows_a_class() -> None:
    pixels = np.random.default_rng(0).integers(0, 256, (100, 3)).astype(np.uint8)

    def of_class(name: str) -> LabelledImage:
        return LabelledImage(name, pixels, np.full(100, name == "b", np.uint8), (10, 10))

    mixed = LabelledImage("c", pixels, np.arange(100, dtype=np.uint8) % 2, (10, 10))
    for dataset in (Dataset(CLASSES, ("a", "b"), of_class), Dataset(CLASSES, ("c",), lambda name: mixed)):
        model = train_neighbourhood(dataset, 3, luts_per_pixel=None, seed=0, progress=silent)
        assert LIGHT not in model.training


def test_what_no_neighbourhood_can_be_trained_on_is_refused() -> None:
    with pytest.raises(InputError, match="takes 13 LUTs: 12 allowed"):
        train_neighbourhood(from_samples(2, 32, seed=0), 3, luts_per_pixel=12, seed=0, progress=silent)
    with pytest.raises(InputError, match="smaller than the neighbourhood: landscape-00000 of 4x4"):
        train_neighbourhood(from_samples(1, 4, seed=0), 5, luts_per_pixel=None, seed=0, progress=silent)
    some = LabelledImage("some", np.zeros((5, 3), np.uint8), np.zeros(5, np.uint8))
    dataset = Dataset(("forest", "deforested"), ("some",), lambda _: some)
    with pytest.raises(InputError, match="only some pixels"):
        train_neighbourhood(dataset, 3, luts_per_pixel=None, seed=0, progress=silent)


def test_a_classifier_of_pictures_has_a_halo(imagery: Path, tmp_path: Path) -> None:
    model = random_neighbourhood(5)
    model.save(tmp_path / "model.json")
    classifier = open_classifier(tmp_path / "model.json")
    assert classifier.halo == 2
    picture = read_rgb(imagery / "7.png")
    answers = classifier.classify(picture)
    assert answers.shape == (60, 60)
    assert isinstance(model.encoder, Neighbourhood)
    window = picture[10:15, 20:25]
    assert answers[10, 20] == model.evaluate_all_codes()[model.encoder.codes(window)[0, 0]]


def test_targets_and_models_must_fit(model: WisardModel) -> None:
    with pytest.raises(InputError, match="the model reads a pixel's neighbours"):
        plan(random_neighbourhood(3), "mine", CompileOptions(target="block"), silent)
    with pytest.raises(InputError, match="the model reads single pixels"):
        plan(model, "mine", CompileOptions(target="neighbourhood"), silent)
    with pytest.raises(InputError, match="more than one pixel: at 3x3"):
        pixel_encoder(random_neighbourhood(3))
    with pytest.raises(InputError, match="--care"):
        plan(random_neighbourhood(3), "mine", CompileOptions(mode="domain"), silent)


@pytest.mark.slow
def test_a_build_is_proved_counted_and_measured(neighbourhood_build: Path) -> None:
    report = json.loads((neighbourhood_build / "report.json").read_text())
    assert report["target"] == "neighbourhood"
    assert report["proof"]["status"] == "proved"
    assert 0 < report["care"]["codes"] < report["care"]["of"] == 64
    assert 0 < report["care"]["coverage"] <= 1
    assert report["parts"]["neighbourhood"]["luts"] <= 7
    assert set(report["parts"]) == {"neighbourhood", "sobel"}
    assert report["options"]["simulated_vectors"] == {"neighbourhood": 10240}
    (verilog,) = neighbourhood_build.glob(f"{neighbourhood_build.name}.v")
    assert "_neighbourhood (\n    input  wire [599:0] window" in verilog.read_text()


@pytest.mark.slow
def test_a_build_answers_as_its_model_where_it_cares(neighbourhood_build: Path, imagery: Path) -> None:
    circuit = open_classifier(neighbourhood_build)
    picture = read_rgb(imagery / "8.png")
    answers, cared = circuit.answer(picture)
    assert cared.mean() > 0.9
    model = model_classifier(random_neighbourhood(5))
    assert np.array_equal(answers[cared], model.classify(picture)[cared])


@pytest.mark.slow
@pytest.mark.simulator
@pytest.mark.parametrize("simulator", ["amaranth", "icarus"])
def test_a_picture_runs_through_the_circuit(neighbourhood_build: Path, imagery: Path, simulator: str) -> None:
    result = play(neighbourhood_build, imagery / "7.png", simulator, silent)  # type: ignore[arg-type]
    assert result.windows == 60 * 60
    assert result.edges is None
    expected = open_classifier(neighbourhood_build).classify(read_rgb(imagery / "7.png"))
    assert np.array_equal(result.foreground, expected != 0)


@pytest.mark.slow
def test_verify_passes_an_untouched_build_and_finds_an_inverted_table(
    neighbourhood_build: Path, tmp_path: Path
) -> None:
    assert verify_build(neighbourhood_build, silent)[0] == []
    copy = Path(shutil.copytree(neighbourhood_build, tmp_path / "copy"))
    path = copy / f"{neighbourhood_build.name}.v"
    text = path.read_text()
    inits = re.findall(r"'h(\w+)", text)
    inverted = format(int(inits[-1], 16) ^ ((1 << 4 * len(inits[-1])) - 1), "x").zfill(len(inits[-1]))
    path.write_text(text.replace(f"'h{inits[-1]}", f"'h{inverted}", 1))
    (copy / "manifest.json").unlink()
    write_manifest(copy, sorted(file.name for file in copy.iterdir()), versions={}, options={})
    problems, _ = verify_build(copy, silent)
    assert any("differs from the model" in problem for problem in problems)


@pytest.mark.slow
def test_a_design_survives_its_file(neighbourhood_build: Path, tmp_path: Path) -> None:
    Design.load(neighbourhood_build).save(tmp_path)
    for name in ("design.json", "model.json"):
        assert (tmp_path / name).read_bytes() == (neighbourhood_build / name).read_bytes()


def test_windows_with_a_pixel_that_is_no_data_are_not_drawn() -> None:
    pixels = np.full((30, 30, 3), 10, dtype=np.uint8)
    valid = np.ones((30, 30), dtype=np.bool_)
    valid[:, 12:] = False
    pixels[~valid] = 255
    classes = np.zeros((30, 30), dtype=np.uint8)
    classes[:4] = UNLABELLED
    windows, labels = _draw(
        LabelledImage.of("a", Picture(pixels, valid), classes), 3, np.random.default_rng(0)
    )
    assert len(windows) == len(labels) > 0
    assert (windows == 10).all()
    assert (labels == 0).all()
    nothing = LabelledImage.of("a", Picture(pixels, ~valid & valid), classes)
    assert len(_draw(nothing, 3, np.random.default_rng(0))[0]) == 0
