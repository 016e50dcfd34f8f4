"""`train` as a user meets it."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from wnn2hdl.dataset import from_samples

Run = Callable[..., Any]


def save(path: Path, array: NDArray[np.generic]) -> None:
    path.parent.mkdir(exist_ok=True)
    Image.fromarray(array).save(path)


@pytest.fixture
def folders(tmp_path: Path) -> tuple[Path, Path]:
    """A picture and its mask, half and half."""
    rgb = np.zeros((8, 8, 3), dtype=np.uint8)
    rgb[:, 4:] = 200
    save(tmp_path / "images" / "a.png", rgb)
    save(tmp_path / "masks" / "a.png", rgb[..., 0])
    return tmp_path / "images", tmp_path / "masks"


def test_training_prints_one_json_object_and_nothing_else(
    run: Run, folders: tuple[Path, Path], tmp_path: Path
) -> None:
    images, masks = folders
    done = run(
        "train", "--images", images, "--masks", masks, "--bits", "R7,G7", "--address-bits", 2, "--rams", 1,
        "--json", "-o", tmp_path / "m.json",
    )  # fmt: skip
    assert done.status == 0, done.stderr
    assert json.loads(done.stdout)["bits"] == ["R7", "G7"]
    assert json.loads((tmp_path / "m.json").read_text())["training"]["command"] == (
        f"wnn2hdl train --images {images} --masks {masks} --bits R7,G7 --address-bits 2 --rams 1"
    )
    done = run("evaluate", tmp_path / "m.json", "--images", images, "--masks", masks, "--json")
    assert json.loads(done.stdout)["accuracy"] == 1.0
    assert json.loads(done.stdout)["images"] == 1


def test_more_classes_by_a_palette(run: Run, folders: tuple[Path, Path], tmp_path: Path) -> None:
    images, masks = folders
    colours = np.zeros((8, 8, 3), dtype=np.uint8)
    colours[:, 2:4], colours[:, 4:] = (255, 0, 0), (0, 0, 255)
    save(masks / "a.png", colours)
    palette = tmp_path / "palette.json"
    palette.write_text(json.dumps({"forest": "#000000", "burnt": "#ff0000", "water": "#0000ff"}))
    model = tmp_path / "new" / "m.json"
    done = run(
        "train", "--images", images, "--masks", masks, "--palette", palette, "--bits", "R7,G7",
        "--address-bits", 2, "--rams", 1, "--json", "-o", model,
    )  # fmt: skip
    assert json.loads(done.stdout)["classes"] == ["forest", "burnt", "water"]
    assert "different classes" in run("evaluate", model, "--images", images, "--masks", masks).complaint()


def test_garbage_gets_one_line(run: Run, folders: tuple[Path, Path], tmp_path: Path) -> None:
    images, masks = folders
    model = tmp_path / "m.json"

    def train(*words: object) -> str:
        return str(run("train", "-o", model, *words).complaint())

    def train_on_these() -> str:
        return str(run("train", "-o", model, "--images", images, "--masks", masks).complaint_after_work())

    empty = tmp_path / "empty"
    empty.mkdir()
    assert "empty" in train("--images", empty, "--masks", masks)
    assert "--images and --masks" in train("--images", images)
    assert "10 of 2" in train("--images", images, "--masks", masks, "--bits", "R7,G7", "--address-bits", 10)
    save(masks / "a.png", np.zeros((4, 4), dtype=np.uint8))
    assert "4x4" in train_on_these()
    save(masks / "a.png", np.zeros((8, 8), dtype=np.uint8))
    assert "deforested" in train_on_these()
    (images / "a.png").write_text("not a picture")
    assert "a.png" in train_on_these()
    save(images / "a.png", np.zeros((8, 8), dtype=np.uint16))
    assert "16" in train_on_these()
    assert "X9" in train("--images", images, "--masks", masks, "--bits", "X9")
    assert not model.exists()


def test_a_choice_says_what_to_expect_of_other_images(run: Run, tmp_path: Path) -> None:
    for image in from_samples(3, 32, seed=3):
        save(tmp_path / "images" / f"{image.name}.png", image.picture)
        save(tmp_path / "masks" / f"{image.name}.png", 255 * image.label_picture)
    words = (
        "train", "--images", tmp_path / "images", "--masks", tmp_path / "masks", "--luts-per-pixel", 1,
        "--trials", 0, "--nested", "-o", tmp_path / "m.json",
    )  # fmt: skip
    figures = json.loads(run(*words, "--json").stdout)["training"]["in_light"]["1"]
    low, high = figures["other_images"]
    assert 0 <= low < figures["accuracy"] < high <= 1
    text = run(*words).stdout
    row = next(line for line in text.splitlines() if line.startswith("│ x1 "))
    shares = f"{figures['accuracy']:.2%}", f"{figures['worst_image']:.2%}", f"{low:.2%} to {high:.2%}"
    assert [cell.strip() for cell in row.strip("│").split("│")] == ["x1", *shares]
    assert "chosen inside the folds: bit selection, 1 LUT (3 of 3)" in text


def test_a_classifier_that_brighter_light_misleads_comes_with_advice(run: Run, tmp_path: Path) -> None:
    levels = ("train", "--bits", "R5,R4", "--address-bits", 2, "--rams", 1, "-o", tmp_path / "m.json")
    warning, advice = run(*levels).stdout.splitlines()[-2:]
    assert warning.startswith("brighter ground of the same kind may be answered differently: R7, R6 are not")
    assert advice.endswith("train with --luts-per-pixel 7")


def test_images_that_show_the_same_get_one_line(run: Run, folders: tuple[Path, Path], tmp_path: Path) -> None:
    images, masks = folders
    words = ("train", "--images", images, "--masks", masks, "-o", tmp_path / "m.json")
    assert "show the same" not in run(*words).stdout
    for folder in folders:
        shutil.copy(folder / "a.png", folder / "b.png")
    assert "images that show the same: a.png, b.png; accuracy" in run(*words).stdout


def test_only_a_choice_can_be_nested(run: Run, folders: tuple[Path, Path], tmp_path: Path) -> None:
    images, masks = folders
    words = ("train", "--images", images, "--masks", masks, "--nested", "-o", tmp_path / "m.json")
    assert "only a choice within --luts-per-pixel is nested: --nested" in run(*words).complaint()


def test_options_that_a_neighbourhood_has_no_use_for_are_refused(run: Run, tmp_path: Path) -> None:
    def train(*words: object) -> str:
        start = ("train", "--neighbourhood", 3, "-o", tmp_path / "m.json")
        return str(run(*start, *words).complaint())

    assert "--neighbourhood chooses the classifier itself: --rams" in train("--rams", "4")
    assert "leave --neighbourhood out" in train("--pareto")
    assert "mappings are tried within --luts-per-pixel and for --pareto only: --trials" in train(
        "--trials", 3
    )
    assert "takes 13 LUTs: 4 allowed" in train("--luts-per-pixel", "4")


def test_options_that_a_context_has_no_use_for_are_refused(run: Run, tmp_path: Path) -> None:
    def train(*words: object) -> str:
        return str(run("train", "--context", 7, "-o", tmp_path / "m.json", *words).complaint())

    assert "--context chooses the classifier itself: --bits" in train("--bits", "R7")
    assert "--context chooses the classifier itself: --luts-per-pixel" in train("--luts-per-pixel", "4")
    assert "--context chooses the classifier itself: --neighbourhood" in train("--neighbourhood", "3")
    assert "mappings are tried within --luts-per-pixel and for --pareto only: --trials" in train(
        "--trials", 3
    )


def test_pixels_left_out_are_reported_and_the_command_can_be_repeated(
    run: Run, folders: tuple[Path, Path], tmp_path: Path
) -> None:
    """A quarter is transparent, and a quarter of the rest has no label."""
    images, masks = folders
    with Image.open(images / "a.png") as picture:
        pixels = np.dstack([np.asarray(picture), np.full((8, 8), 255, dtype=np.uint8)])
    labels = np.where(pixels[..., 0] > 99, 1, 0).astype(np.uint8)
    pixels[6:, :, 3], labels[0] = 0, 7
    save(images / "a.png", pixels)
    save(masks / "a.png", labels)
    words = [
        "train",
        "--images",
        images,
        "--masks",
        masks,
        "--bits",
        "R7,G7",
        "--address-bits",
        2,
        "--rams",
        1,
    ]
    assert "holds 1, 7 besides 0" in run(*words, "-o", tmp_path / "m.json").stderr
    done = run(*words, "--ignore", "7,#ff00ff", "--scale", "0..255", "-o", tmp_path / "m.json")
    assert "37.50% of the pixels left out: not labelled, or no data" in done.stdout
    training = json.loads((tmp_path / "m.json").read_text())["training"]
    assert training["left_out"] == {"pixels": 24, "share": 0.375}
    assert "--ignore '7,#ff00ff' --scale 0.0..255.0 --bits R7,G7" in training["command"]
    again = run("evaluate", tmp_path / "m.json", *words[1:5], "--ignore", 7)
    assert "37.50% of the pixels left out" in again.stdout


@pytest.fixture
def table(tmp_path: Path) -> Path:
    """Sixty rows: "high" where both of two real features are."""
    rng = np.random.default_rng(0)
    rows = rng.random((60, 2)).round(3)
    names = np.where(rows.min(axis=1) > 0.4, "high", "low")
    path = tmp_path / "t.csv"
    path.write_text("a,b,class\n" + "".join(f"{a},{b},{name}\n" for (a, b), name in zip(rows, names)))  # noqa: B905
    return path


def test_a_table_of_features_is_learned(run: Run, table: Path, tmp_path: Path) -> None:
    model = tmp_path / "m.json"
    words = ("--table", table, "--label", "class", "--input", "UQ0.6", "--cross-validate", 2, "-o", model)
    data = json.loads(run("train", *words, "--json").stdout)
    assert (data["features"], data["rows"], data["input"]) == (2, 60, "UQ0.6")
    validation = data["cross_validation"]
    assert [one["seed"] for one in validation["seeds"]] == [0, 1]
    for one in validation["seeds"]:
        assert one["interval"][0] < one["accuracy"] < one["interval"][1]
    training = json.loads(model.read_text())["training"]
    assert training["cross_validation"] == validation
    assert training["command"] == (
        f"wnn2hdl train --table {table} --label class --input UQ0.6 --cross-validate 2"
    )
    measured = json.loads(run("evaluate", model, "--table", table, "--label", "class", "--json").stdout)
    assert measured["accuracy"] > validation["accuracy"]
    assert "seed 1: accuracy 0." in run("train", *words).stdout


def test_features_without_a_format_are_reported_as_real_numbers(
    run: Run, table: Path, tmp_path: Path
) -> None:
    words = ("--table", table, "--label", "class", "--thermometer", "gaussian", "--mapping", "per-class")
    done = run("train", *words, "--cross-validate", 0, "-o", tmp_path / "m.json")
    assert "as real numbers: state a format before compiling" in done.stdout
    assert "cross-validation" not in done.stdout


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (("--label", "class"), "only a table has feature vectors, and none is given with --table: --label"),
        (("--levels", "8"), "only a table has feature vectors"),
        (("--table", "t.csv", "--images", "."), "a table has no pictures: --images; leave these options out"),
        (("--table", "t.csv", "--pareto"), "a table has no pictures: --pareto"),
        (("--table", "t.csv", "--input", "16"), "'16' is not a format of words, as Q3.12 or UQ8.0"),
    ],
)
def test_options_of_tables_and_of_pictures_do_not_mix(
    run: Run, tmp_path: Path, words: tuple[str, ...], complaint: str
) -> None:
    assert complaint in run("train", *words, "-o", tmp_path / "m.json").complaint()
    assert not (tmp_path / "m.json").exists()
