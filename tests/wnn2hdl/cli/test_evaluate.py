"""`wnn2hdl evaluate` as its users and programs read it."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from wnn2hdl.build.compile import compile_model
from wnn2hdl.build.planning import CompileOptions
from wnn2hdl.dataset import from_samples
from wnn2hdl.encode import parse_bits
from wnn2hdl.ir import Thermometer
from wnn2hdl.ir.models import LutGroupModel, LutLayer
from wnn2hdl.training.discriminators import train

Run = Callable[..., Any]


def silent(step: str, done: int, total: int) -> None:
    pass


@pytest.fixture
def evaluate(run: Run) -> Run:
    """``evaluate(MODEL, ...)`` gives what ``--json`` prints."""
    return lambda *words: json.loads(run("evaluate", *words, "--json").stdout)


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Deforested is what has the high bit of red set, as far as landscapes tell."""
    path = tmp_path_factory.mktemp("model") / "model.json"
    train(
        from_samples(2, 48, seed=3),
        parse_bits("R7,R6,G7"),
        address_bits=3,
        rams=1,
        bleaching=1,
        seed=0,
        progress=silent,
    ).save(path)
    return path


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    folder = tmp_path_factory.mktemp("pictures")
    for kind in ("images", "masks"):
        (folder / kind).mkdir()
    for image in from_samples(3, 48, seed=40):
        Image.fromarray(image.picture).save(folder / "images" / f"{image.name}.png")
        Image.fromarray(255 * image.label_picture).save(folder / "masks" / f"{image.name}.png")
    return folder / "images", folder / "masks"


def test_a_model_is_measured(evaluate: Run, model: Path, folders: tuple[Path, Path]) -> None:
    data = evaluate(model, "--images", folders[0], "--masks", folders[1])
    assert data["images"] == 3
    assert data["classes"] == ["forest", "deforested"]
    assert "circuit" not in data
    figures = data["model"]
    assert data["accuracy"] == figures["accuracy"]
    (tn, fp), (fn, tp) = figures["confusion"]
    assert tn + fp + fn + tp == 3 * 48 * 48
    assert figures["per_class"]["deforested"] == pytest.approx(
        {
            "precision": tp / (tp + fp),
            "recall": tp / (tp + fn),
            "f1": 2 * tp / (2 * tp + fp + fn),
            "iou": tp / (tp + fp + fn),
        }
    )
    assert set(figures["intervals"]) == {"accuracy", "kappa", "mean_iou"}
    low, high = figures["intervals"]["accuracy"]
    assert low <= figures["accuracy"] <= high
    assert len(figures["per_image"]) == 3
    total = np.sum([image["confusion"] for image in figures["per_image"].values()], axis=0)
    assert total.tolist() == figures["confusion"]
    assert data["bootstrap"]["method"].startswith("percentile bootstrap over images")


def test_a_model_is_measured_in_changed_light(
    evaluate: Run, run: Run, model: Path, folders: tuple[Path, Path]
) -> None:
    words = (
        model, "--images", folders[0], "--masks", folders[1], "--exposure", "0.5..1.5", "--haze",
        "--white-balance", "0.9..1.1", "--gamma", "0.8..1",
    )  # fmt: skip
    data = evaluate(*words)["model"]
    exposures, hazes = data["light"]["exposure"], data["light"]["haze"]
    assert [point["value"] for point in exposures] == [0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5]
    assert hazes[-1]["value"] == 0.1
    balances, gammas = data["light"]["white_balance"], data["light"]["gamma"]
    # Full light, clear air and the camera's own balance and gamma change nothing.
    middle = next(point for point in balances if point["value"] == 1)
    for point in exposures[5], hazes[0], middle, gammas[-1]:
        assert point["accuracy"] == data["accuracy"]
        assert point["interval"] == data["intervals"]["accuracy"]
        assert point["worst_image"] == data["worst_image"]
    assert exposures[0]["accuracy"] != data["accuracy"]
    lowest = min(point["accuracy"] for point in data["per_image"].values())
    assert data["worst_image"]["accuracy"] == lowest
    text = run("evaluate", *words).stdout
    assert "│ 0.5      │" in text
    assert "lowest accuracy" in text
    assert ", at white balance " in text


def test_a_model_that_leaves_the_high_bits_out_is_warned_of(
    run: Run, folders: tuple[Path, Path], tmp_path: Path
) -> None:
    pictures = ("--images", folders[0], "--masks", folders[1])
    done = run("train", *pictures, "--bits", "R6,R5,G6,G5", "--rams", 1, "-o", tmp_path / "m.json")
    warning = "brighter ground of the same kind may be answered differently: "
    assert f"{warning}R7, G7 are not read, so levels wrap around" in done.stdout
    (line,) = [x for x in run("evaluate", tmp_path / "m.json", *pictures).stdout.splitlines() if warning in x]
    assert line.endswith("R7, G7 are not read, so levels wrap around")


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (
            ("--table", "t.csv", "--label", "class", "--exposure", "0.8..1.5"),
            "a table has no light: --exposure",
        ),
        (("--chips", ".", "--tags", "t.csv", "--haze", "0..0.1"), "light is varied with masks: --haze"),
        (("--exposure", "1.5..0.8"), "'1.5..0.8' does not rise from one number to another"),
    ],
)
def test_light_that_cannot_be_varied_is_refused(
    run: Run, model: Path, words: tuple[str, ...], complaint: str
) -> None:
    assert complaint in run("evaluate", model, *words).complaint()


def test_squares_are_measured_beside_pixels(
    evaluate: Run, run: Run, model: Path, folders: tuple[Path, Path]
) -> None:
    words = (model, "--images", folders[0], "--masks", folders[1], "--square", 8, "--share", 0.5)
    squares = evaluate(*words)["model"]["squares"]
    assert (squares["side"], squares["share"]) == (8, 0.5)
    assert squares["confusion"] != squares["pixels"]["confusion"]
    assert "against each pixel of the mask" in run("evaluate", *words).stdout


def test_a_build_is_measured_as_circuit_and_as_model(
    evaluate: Run, model: Path, folders: tuple[Path, Path], tmp_path: Path
) -> None:
    from wnn2hdl.ir import WisardModel

    options = CompileOptions(target="pixel", mode="domain", care=folders[0])
    build = tmp_path / "build"
    assert compile_model(WisardModel.load(model), build, options, silent).failure is None
    data = evaluate(build, "--images", folders[0], "--masks", folders[1])
    assert data["mode"] == "domain"
    assert data["accuracy"] == data["circuit"]["accuracy"]
    # On the imagery that made the care set both are the same, and all of it is cared for.
    assert data["circuit"]["confusion"] == data["model"]["confusion"]
    assert data["circuit"]["coverage"] == 1.0


@pytest.mark.parametrize("target", ["edge", "match"])
def test_a_build_without_a_classifier_is_refused(
    run: Run, write_build: Callable[..., Path], tmp_path: Path, target: str
) -> None:
    folder = write_build(tmp_path / "a", target=target)
    assert f"the build holds no classifier, so there is nothing to measure: {folder} (target {target});" in (
        run("evaluate", folder).complaint()
    )


def test_the_embedded_landscapes_are_the_default(evaluate: Run, model: Path) -> None:
    assert evaluate(model)["images"] == 12


def test_chips_are_ranked_by_their_tags(evaluate: Run, run: Run, model: Path, tmp_path: Path) -> None:
    for name, level in (("dark", 10), ("bright", 180)):
        Image.new("RGB", (4, 4), (level, 100, 100)).save(tmp_path / f"{name}.png")
    tags = tmp_path / "labels.csv"
    tags.write_text("image_name,tags\ndark,clear primary\nbright,agriculture clear\n")
    data = evaluate(model, "--chips", tmp_path, "--tags", tags)
    assert data["auc"] == data["model"]["auc"] == 1.0
    assert data["model"]["interval"] is None
    assert data["model"]["chips"]["bright"] == {"cleared": True, "deforested_share": 1.0}
    assert data["rule"].startswith("negative: tagged clear and primary alone")
    assert (
        "area under the ROC curve 1.0000, 1 chips"
        in run("evaluate", model, "--chips", tmp_path, "--tags", tags).stdout
    )


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (("--chips", "."), "these options go together: --chips and --tags"),
        (("--chips", ".", "--tags", "a.csv", "--square", "3"), "chips with tags have no masks"),
        (("--images", "."), "these options go together: --images and --masks"),
    ],
)
def test_options_that_do_not_fit(run: Run, model: Path, words: tuple[str, ...], complaint: str) -> None:
    assert complaint in run("evaluate", model, *words).complaint()


@pytest.fixture
def table(tmp_path: Path) -> tuple[Path, Path]:
    """A model that says "high" above 1, and a table on which it errs once."""
    layer = LutLayer(np.zeros((2, 1), dtype=np.int32), np.array([[True, False], [False, True]]))
    groups = np.array([0, 1], dtype=np.int32)
    LutGroupModel(Thermometer(((1.0,),)), ("low", "high"), (layer,), groups).save(tmp_path / "vectors.json")
    (tmp_path / "t.csv").write_text("x,class\n0,low\n0.5,low\n1,low\n2,high\n")
    return tmp_path / "vectors.json", tmp_path / "t.csv"


def test_a_table_of_feature_vectors_has_wilsons_interval(
    evaluate: Run, run: Run, table: tuple[Path, Path]
) -> None:
    model, rows = table
    data = evaluate(model, "--table", rows, "--label", "class")
    assert (data["accuracy"], data["samples"], data["classes"]) == (0.75, 4, ["low", "high"])
    assert data["model"]["confusion"] == [[2, 1], [0, 1]]
    assert data["model"]["intervals"]["accuracy"] == pytest.approx([0.3006, 0.9544], abs=1e-4)
    assert data["interval"]["method"] == "Wilson score"
    text = run("evaluate", model, "--table", rows, "--label", "class").stdout
    assert text.startswith("model, 4 samples: accuracy 0.7500 (0.3006 to 0.9544), kappa ")


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (("--label", "class"), "only a table has feature vectors, and none is given with --table: --label"),
        (("--table", "t.csv", "--label", "class", "--images", "."), "a table has no pictures"),
        (("--table", "t.csv", "--label", "class"), "the model does not classify feature vectors"),
    ],
)
def test_tables_that_do_not_fit(run: Run, model: Path, words: tuple[str, ...], complaint: str) -> None:
    assert complaint in run("evaluate", model, *words).complaint()


@pytest.mark.slow
def test_a_build_of_a_network_is_measured_as_circuit_and_as_model(
    evaluate: Run, run: Run, table: tuple[Path, Path], tmp_path: Path
) -> None:
    model, rows = table
    words = ("--table", rows, "--label", "class")
    done = run(
        "compile", model, "--input", "UQ2.0", "--test-table", rows, "--label", "class", "-o", tmp_path / "b"
    )
    # Half is rounded down to 0, which is no other side of the threshold.
    assert "accuracy of the circuit: 75.00% (30.06% to 95.44%)" in done.stdout
    assert "answered differently" not in done.stdout
    data = evaluate(tmp_path / "b", *words)
    assert data["circuit"]["confusion"] == data["model"]["confusion"] == [[2, 1], [0, 1]]
    assert data["accuracy"] == 0.75


def test_a_folder_that_is_no_build_is_not_measured(
    run: Run, table: tuple[Path, Path], tmp_path: Path
) -> None:
    assert (
        "not a build folder" in run("evaluate", tmp_path, "--table", table[1], "--label", "class").complaint()
    )
