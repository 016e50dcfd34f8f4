"""Which bands are read: what the file states or the user says."""

from pathlib import Path

import pytest

from wnn2hdl.errors import InputError
from wnn2hdl.raster.channels import choose_channels

PATH = Path("scene.tif")


def bands(*interpretations: str, chosen: tuple[int, ...] | None = None) -> tuple[int, ...]:
    return choose_channels(PATH, interpretations, bands=chosen).indexes


def test_what_the_file_states_is_followed_whatever_the_order() -> None:
    assert bands("red", "green", "blue") == (1, 2, 3)
    assert bands("blue", "green", "red", "undefined") == (3, 2, 1)
    assert bands("red", "green", "blue", "alpha") == (1, 2, 3)


def test_one_band_stands_for_all_three() -> None:
    assert bands("gray") == (1,)
    assert bands("undefined") == (1,)
    assert bands("gray", "alpha") == (1,)
    assert not choose_channels(PATH, ("gray",)).palette
    assert choose_channels(PATH, ("palette",)).palette


def test_three_unnamed_bands_are_taken_in_order_and_it_is_said() -> None:
    found = choose_channels(PATH, ("gray", "undefined", "undefined"))
    assert found.indexes == (1, 2, 3)
    assert "does not name" in found.note
    assert choose_channels(PATH, ("red", "green", "blue")).note == ""


@pytest.mark.parametrize(
    "interpretations",
    [
        ("gray", "undefined", "undefined", "undefined"),
        ("undefined",) * 13,
        ("gray", "undefined"),
        ("red", "red", "blue"),
        ("cyan", "magenta", "yellow", "black"),
    ],
)
def test_what_nobody_states_is_refused(interpretations: tuple[str, ...]) -> None:
    with pytest.raises(InputError, match=r"scene\.tif.*give --bands"):
        choose_channels(PATH, interpretations)


def test_the_user_chooses() -> None:
    many = ("gray", *["undefined"] * 12)
    assert bands(*many, chosen=(4, 3, 2)) == (4, 3, 2)
    assert bands(*many, chosen=(8,)) == (8,)
    note = choose_channels(PATH, ("gray", "undefined", "undefined"), bands=(3, 2, 1)).note
    assert note == ""


def test_bands_that_do_not_exist_are_refused() -> None:
    with pytest.raises(InputError, match="bands 1 to 3"):
        bands("red", "green", "blue", chosen=(1, 2, 4))
    with pytest.raises(InputError, match="one band or three"):
        bands("red", "green", "blue", chosen=(1, 2))
