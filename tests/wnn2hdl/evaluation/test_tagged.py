"""Ranking pictures that are tagged as a whole."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from sklearn.metrics import roc_auc_score

from wnn2hdl.dataset import CLASSES
from wnn2hdl.encode import parse_bits
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.classifiers import PixelTable
from wnn2hdl.evaluation.tagged import NEITHER, NOT_CLEAR, evaluate_tagged, kind, read_tags

RED = PixelTable(CLASSES, parse_bits("R7"), np.array([0, 1], np.uint8), np.array([True, True]))


def silent(step: str, done: int, total: int) -> None:
    pass


def chips(folder: Path, shares: dict[str, float], tags: dict[str, str]) -> tuple[Path, Path]:
    """Chips of ten pixels, some of them red, and the file of their tags."""
    (folder / "chips").mkdir()
    for name, share in shares.items():
        pixels = np.zeros((1, 10, 3), dtype=np.uint8)
        pixels[0, : round(10 * share), 0] = 255
        Image.fromarray(pixels).save(folder / "chips" / f"{name}.png")
    table = folder / "labels.csv"
    table.write_text("image_name,tags\n" + "".join(f"{name},{words}\n" for name, words in tags.items()))
    return folder / "chips", table


@pytest.mark.parametrize(
    ("tags", "expected"),
    [
        ("clear primary", False),
        ("agriculture clear primary road", True),
        ("clear slash_burn", True),
        ("clear primary water", NEITHER),
        ("blow_down clear primary", NEITHER),
        ("cloudy", NOT_CLEAR),
        ("agriculture partly_cloudy primary", NOT_CLEAR),
        ("haze primary", NOT_CLEAR),
    ],
)
def test_only_untouched_forest_and_cleared_land_are_compared(tags: str, expected: bool | str) -> None:
    assert kind(frozenset(tags.split())) == expected


def test_the_area_is_the_chance_that_cleared_land_has_the_larger_share(tmp_path: Path) -> None:
    folder, tags = chips(
        tmp_path,
        {"a": 0.0, "b": 0.3, "c": 0.2, "d": 0.9, "e": 0.5},
        {
            "a": "clear primary",
            "b": "clear primary",
            "c": "clear road",
            "d": "clear habitation",
            "e": "cloudy",
        },
    )
    result = evaluate_tagged(RED, folder, tags, 0, silent)
    assert result.shares == {"a": 0.0, "b": 0.3, "c": 0.2, "d": 0.9}
    assert result.cleared == {"a": False, "b": False, "c": True, "d": True}
    assert result.left_out == {NOT_CLEAR: 1}
    # Of four pairs, only (b, c) is the wrong way round.
    assert result.auc == 0.75 == roc_auc_score(list(result.cleared.values()), list(result.shares.values()))
    assert result.interval is not None
    assert 0 <= result.interval[0] < 0.75 < result.interval[1] <= 1


def test_draws_count_half(tmp_path: Path) -> None:
    shares = {"a": 0.2, "b": 0.5, "c": 0.5, "d": 0.5}
    folder, tags = chips(
        tmp_path, shares, {"a": "clear primary", "b": "clear primary", "c": "clear road", "d": "clear road"}
    )
    result = evaluate_tagged(RED, folder, tags, 0, silent)
    assert result.auc == 0.75 == roc_auc_score([0, 0, 1, 1], list(shares.values()))


def test_water_was_never_felled(tmp_path: Path) -> None:
    folder, tags = chips(tmp_path, {"a": 0.4}, {"a": "clear road"})
    classes = ("forest", "river", "pasture")
    for answer, share in ((1, 0.0), (2, 0.4)):
        table = PixelTable(classes, parse_bits("R7"), np.array([0, answer], np.uint8), np.ones(2, np.bool_))
        assert evaluate_tagged(table, folder, tags, 0, silent).shares == {"a": share}


def test_without_both_kinds_there_is_no_area(tmp_path: Path) -> None:
    folder, tags = chips(tmp_path, {"a": 0.1}, {"a": "clear primary"})
    result = evaluate_tagged(RED, folder, tags, 0, silent)
    assert (result.auc, result.interval) == (None, None)


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("name,tags\n", "other columns"),
        ("image_name,tags\n", "no rows"),
        ("image_name,tags\na,clear\na,haze\n", "repeats a picture: a"),
        ('image_name,tags\na,"clear\n', "not CSV text"),
        ("image_name,tags\na,clear,road\n", "row 2 of .* more than two columns: a,clear,road"),
    ],
)
def test_a_bad_file_of_tags_is_refused(tmp_path: Path, text: str, complaint: str) -> None:
    (tmp_path / "labels.csv").write_text(text)
    with pytest.raises(InputError, match=complaint):
        read_tags(tmp_path / "labels.csv")


def test_missing_files_are_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot read the file of tags"):
        read_tags(tmp_path / "labels.csv")
    folder, tags = chips(tmp_path, {"a": 0.1}, {"b": "clear primary"})
    with pytest.raises(InputError, match=r"no picture of this name in .*: b"):
        evaluate_tagged(RED, folder, tags, 0, silent)
    Image.open(folder / "a.png").save(folder / "a.bmp")
    with pytest.raises(InputError, match="the same stem"):
        evaluate_tagged(RED, folder, tags, 0, silent)


@pytest.mark.realdata
def test_redness_tells_cleared_chips_from_forest(realdata: Path) -> None:
    planet = realdata / "planet_chips"
    result = evaluate_tagged(RED, planet / "chips", planet / "labels.csv", 0, silent)
    assert len(result.cleared) + sum(result.left_out.values()) == 250
    assert result.auc is not None
    assert result.auc > 0.9
