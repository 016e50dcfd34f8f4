"""`train --max-luts` as a user meets it."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

Run = Callable[..., Any]


@pytest.fixture
def pictures(tmp_path: Path) -> Path:
    """Pictures of 5x5 pixels, bright on one side; half to train on, half to judge by."""
    rng = np.random.default_rng(0)
    labels = rng.integers(0, 2, 600)
    levels = rng.integers(0, 150, (600, 5, 5))
    levels[labels == 0, :, :2] += 100
    levels[labels == 1, :, 3:] += 100
    path = tmp_path / "pictures.npz"
    x, y = levels.astype(np.uint8), np.array(["left", "right"])[labels]
    np.savez(path, x_train=x[:300], y_train=y[:300], x_test=x[300:], y_test=y[300:])
    return path


@pytest.mark.slow
def test_a_network_fits_its_budget_and_is_measured_and_can_be_made_again(
    run: Run, pictures: Path, tmp_path: Path
) -> None:
    words = ("--levels", 1, "--max-luts", 16, "--epochs", 60, "--distort", 1, "--seed", 3)
    data = json.loads(run("train", "--table", pictures, *words, "-o", tmp_path / "m.json", "--json").stdout)
    assert (data["kind"], data["features"], data["input"]) == ("lut-groups", 25, "UQ8.0")
    assert 8 <= data["luts"] <= 16
    assert data["nodes"] == 2 * data["nodes_per_class"]
    assert data["validation"] > 0.8
    measured = json.loads(run("evaluate", tmp_path / "m.json", "--table", pictures, "--json").stdout)
    assert measured["accuracy"] > 0.8
    training = json.loads((tmp_path / "m.json").read_text())["origin"]["training"]
    assert training["luts"] == data["luts"]
    assert training["command"] == (
        f"wnn2hdl train --table {pictures} --levels 1 --max-luts 16 --epochs 60 --distort 1 --seed 3"
    )
    done = run("train", "--table", pictures, *words, "-o", tmp_path / "again.json")
    assert f"2 classes, {data['luts']} LUTs in all" in done.stdout
    assert f"with the best {data['nodes_per_class']}, {data['validation']:.4f} when these" in done.stdout
    assert (tmp_path / "again.json").read_bytes() == (tmp_path / "m.json").read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["again.json", "m.json", "pictures.npz"]


@pytest.mark.slow
def test_a_front_has_the_networks_that_no_smaller_one_equals(
    run: Run, pictures: Path, tmp_path: Path
) -> None:
    words = ("train", "--table", pictures, "--levels", 1, "--max-luts", 20, "--epochs", 40, "--pareto")
    data = json.loads(run(*words, "-o", tmp_path / "m.json", "--json").stdout)
    front = data["front"]
    assert 1 <= len(front) <= 3
    luts, shares = [point["luts"] for point in front], [point["accuracy"] for point in front]
    assert luts == sorted(set(luts))
    assert shares == sorted(set(shares))
    assert (data["luts"], data["validation"]) == (luts[-1], shares[-1])
    assert luts[0] <= 10
    names = {f"m-{count}luts.json" for count in luts} | {"m.json", "m-pareto.png", "m-pareto.svg"}
    assert {path.name for path in tmp_path.iterdir()} == names | {"pictures.npz"}
    assert (tmp_path / f"m-{luts[-1]}luts.json").read_bytes() == (tmp_path / "m.json").read_bytes()
    assert "accuracy in validation" in (tmp_path / "m-pareto.svg").read_text()


def test_networks_without_rows_for_validation_have_no_front(run: Run, tmp_path: Path) -> None:
    few = np.arange(12 * 25).reshape(12, 5, 5).astype(np.uint8)
    np.savez(tmp_path / "few.npz", x_train=few, y_train=np.arange(12) % 2)
    words = ("--table", tmp_path / "few.npz", "--max-luts", "30", "--epochs", "2", "--pareto")
    done = run("train", *words, "-o", tmp_path / "m.json")
    assert done.status == 2
    assert "no row is kept for validation, by which networks could be compared" in done.stderr
    assert not (tmp_path / "m.json").exists()


@pytest.mark.slow
def test_few_rows_are_taught_and_the_teacher_is_named(run: Run, tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    rows = rng.integers(0, 256, (80, 3))
    lines = [f"{a},{b},{c},{'yes' if a + b > 255 else 'no'}\n" for a, b, c in rows]
    (tmp_path / "t.csv").write_text("a,b,c,answer\n" + "".join(lines))
    words = ("train", "--table", tmp_path / "t.csv", "--label", "answer", "--max-luts", 20, "--epochs", 4)
    said = run(*words, "-o", tmp_path / "m.json").stdout
    assert "4 epochs on 80 rows, 20000 made up" in said
    assert "\ntaught by " in said
    training = json.loads((tmp_path / "m.json").read_text())["origin"]["training"]
    assert training["teacher"] in said
    assert training["teacher_accuracy"] > 0.9
    assert training["validation"] > 0.8


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (("--max-luts", "9"), "networks of look-up tables are trained with both --table and --max-luts"),
        (("--table", "t.csv", "--epochs", "9"), "with both --table and --max-luts: --epochs"),
        (
            ("--table", "t.csv", "--max-luts", "9", "--rams", "4"),
            "--max-luts trains no discriminators: --rams",
        ),
        (("--table", "t.csv", "--max-luts", "9", "--mapping", "shared"), "no discriminators: --mapping"),
        (("--table", "t.csv", "--max-luts", "9", "--label", "c"), "no whole numbers: t.csv; state a format"),
        (
            ("--table", "t.csv", "--max-luts", "9", "--label", "c", "--distort", "2"),
            "only pictures can be distorted: t.csv; give arrays [samples, rows, columns] in an .npz file",
        ),
        (
            ("--table", "t.csv", "--max-luts", "9", "--label", "c", "--input", "UQ1.0"),
            "no feature tells samples apart in this format of words: UQ1.0",
        ),
        (
            ("--table", "t.csv", "--max-luts", "1", "--label", "c", "--input", "Q2.5"),
            "no network of 2 classes fits: 1 LUTs; allow at least",
        ),
    ],
)
def test_what_cannot_be_trained_gets_one_line(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...], complaint: str
) -> None:
    monkeypatch.chdir(tmp_path)
    rows = "".join(f"{value / 50 - 1.5},{'ab'[value % 2]}\n" for value in range(100))
    Path("t.csv").write_text("x,c\n" + rows)
    assert complaint in run("train", *words, "-o", "m.json").complaint()
    assert not Path("m.json").exists()
