from pathlib import Path

import numpy as np

from wnn2hdl.apps.sweep.grid import Recipe
from wnn2hdl.apps.sweep.pictures import draw_all
from wnn2hdl.apps.sweep.selection import Finalist, Surface
from wnn2hdl.apps.sweep.trial import Record

RECIPE = Recipe(seed=0, bits=("R7",), bleaching=None, care_minimum=None)


def surface(rows: int, columns: int) -> Surface:
    shape = (rows, columns)
    accuracy = np.linspace(0.6, 0.9, rows * columns).reshape(shape)
    accuracy[0, 0] = np.nan
    count = np.ones(shape, dtype=np.int64)
    bits, rams = tuple(range(2, 2 + rows)), tuple(range(2, 2 + columns))
    return Surface(bits, rams, accuracy, 10 * accuracy, count, 0 * count, 0 * count)


def finalist(n: int, k: int) -> Finalist:
    record = Record("x", n, k, 0, ("R7",), None, "valid", accuracy=0.8, circuit_accuracy=0.8, luts=4)
    accuracies = dict(enumerate(np.linspace(0.7, 0.8, 30).tolist()))
    return Finalist((n, k), accuracies, (4,) * 30, 0, record)


def draw(folder: Path, *, rows: int = 4, columns: int = 5) -> tuple[str, ...]:
    folder.mkdir(exist_ok=True)
    finalists = [finalist(2, 3), finalist(3, 4)]
    front = [finalist(2, 3).best]
    clouds = [("grid", ([4, 9, 30], [0.8, 0.7, 0.6]), front), ("NSGA-II", ([4], [0.8]), front)]
    return draw_all(folder, surface(rows, columns), [(2, 3), (3, 4)], finalists, clouds)


def test_every_picture_is_written_twice_and_is_no_empty_sheet(tmp_path: Path) -> None:
    names = draw(tmp_path / "a")
    assert names == ("surface", "contour", "cost", "finalists", "pareto")
    for name in names:
        assert (tmp_path / "a" / f"{name}.png").read_bytes().startswith(b"\x89PNG")
        svg = (tmp_path / "a" / f"{name}.svg").read_text(encoding="utf-8")
        assert svg.count("<path") > 20
    # Letters are drawn as outlines, with the text beside them in a comment.
    assert "address bits/RAMs   1: 2/3" in (tmp_path / "a" / "contour.svg").read_text(encoding="utf-8")


def test_equal_results_give_equal_bytes(tmp_path: Path) -> None:
    names = draw(tmp_path / "a")
    assert draw(tmp_path / "b") == names
    for name in names:
        for suffix in ("png", "svg"):
            file = f"{name}.{suffix}"
            assert (tmp_path / "a" / file).read_bytes() == (tmp_path / "b" / file).read_bytes()


def test_a_single_row_has_no_surface(tmp_path: Path) -> None:
    assert draw(tmp_path / "a", rows=1) == ("finalists", "pareto")


def test_nothing_to_show_draws_nothing(tmp_path: Path) -> None:
    assert draw_all(tmp_path, surface(1, 1), [], [], [("grid", ([], []), [])]) == ()
