"""Weightless edges: directions, what is learned from frames of known place, and finding places with it."""

from collections.abc import Callable

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.apps.navigation.channels import ChannelIndex
from wnn2hdl.apps.navigation.geometry import Patch
from wnn2hdl.apps.navigation.weightless import GSD_M, Sighting, WeightlessEdges, by_rule, learn
from wnn2hdl.errors import InputError
from wnn2hdl.ir import window_codes

EAST, NORTH, WEST, SOUTH = range(4)


def window(rows: str) -> int:
    """The code of a window written as three rows, ``"..# ..# ..#"``."""
    image = np.array([[mark == "#" for mark in row] for row in rows.split()])
    return int(window_codes(image)[0, 0])


@pytest.mark.parametrize(
    ("rows", "sides"),
    [
        (".## .## .##", {EAST}),
        ("### ### ...", {NORTH}),
        ("#.. #.. #..", {WEST}),
        ("... ... ###", {SOUTH}),
        (".## ..# ...", {EAST, NORTH}),
        ("... #.. ##.", {WEST, SOUTH}),
        ("... .#. ...", set()),
        ("### ### ###", set()),
        ("#.# #.# #.#", set()),
    ],
)
def test_a_pattern_is_an_edge_of_the_side_that_is_brighter(rows: str, sides: set[int]) -> None:
    code = window(rows)
    assert {side for side, one in enumerate(by_rule().filters) if one.evaluate(code)} == sides


def test_turning_a_picture_turns_its_edges_and_their_directions() -> None:
    rng = np.random.default_rng(1)
    picture = rng.integers(0, 256, (40, 40, 3), dtype=np.uint8)
    valid = np.ones((40, 40), dtype=np.bool_)
    edges, inside = by_rule().extract(picture, valid)
    turned, _ = by_rule().extract(np.rot90(picture).copy(), valid)
    by_image = turned.reshape(3, 4, 40, 40)
    # What was brighter in the east is brighter in the north after a quarter turn counter-clockwise.
    expected = np.rot90(np.roll(edges.reshape(3, 4, 40, 40), 1, axis=1), axes=(2, 3))
    assert (by_image == expected).all()
    assert inside.sum() == 38 * 38


def test_edges_are_kept_away_from_invalid_pixels() -> None:
    rng = np.random.default_rng(2)
    picture = rng.integers(0, 256, (30, 30, 3), dtype=np.uint8)
    valid = np.ones((30, 30), dtype=np.bool_)
    valid[10:12, 20] = False
    edges, inside = by_rule().extract(picture, valid)
    assert not inside[9:13, 19:22].any()
    assert inside.sum() == 28 * 28 - 4 * 3
    assert not edges[:, ~inside].any()
    assert edges[:, inside].any(axis=1).all()


def test_the_threshold_covers_the_same_ground_at_any_sample_distance() -> None:
    assert by_rule(2.0).side == 15
    assert by_rule(1.0).side in (29, 31)
    assert by_rule(0.5).side in (59, 61)


def country(seed: int) -> NDArray[np.uint8]:
    """Fields and roofs: blots of two sizes, each in its own colour."""
    rng = np.random.default_rng(seed)
    picture = np.empty((160, 160, 3))
    for band in range(3):
        coarse, fine = (cv2.GaussianBlur(rng.normal(size=(160, 160)), (0, 0), sigma) for sigma in (9, 2.5))
        picture[..., band] = 120 + 30 * np.sign(coarse) + 25 * np.sign(fine)
    return picture.astype(np.uint8)


def another_date(picture: NDArray[np.uint8], seed: int) -> NDArray[np.uint8]:
    """Other light and noise."""
    rng = np.random.default_rng(seed)
    noisy = picture * rng.uniform(0.6, 1.1, 3) + rng.normal(scale=14, size=picture.shape)
    return np.clip(noisy + 10, 0, 255).astype(np.uint8)


def sighting(ground: NDArray[np.uint8], row: int, column: int, seed: int, off: tuple[int, int]) -> Sighting:
    """A frame of 50 x 60 pixels whose logged place is off by some pixels; a false heading comes first."""
    image = another_date(ground[row : row + 50, column : column + 60], seed)
    valid = np.ones((50, 60), dtype=np.bool_)
    right = Patch(image, valid, 24.5, 29.5, GSD_M)
    wrong = Patch(image[::-1, ::-1].copy(), valid, 24.5, 29.5, GSD_M)
    return Sighting((wrong, right), row + 24.5 + off[0], column + 29.5 + off[1])


@pytest.fixture(scope="module")
def trained() -> tuple[NDArray[np.uint8], WeightlessEdges]:
    ground = country(3)
    places = [(5, 8, (3, -6)), (60, 20, (-8, 4)), (30, 90, (0, 9)), (100, 70, (5, 5))]
    seen = [sighting(ground, row, column, row, off) for row, column, off in places]
    return ground, learn(ground, np.ones((160, 160), dtype=np.bool_), seen)


def test_straight_edges_are_learned_and_flat_or_lonely_windows_are_not(
    trained: tuple[NDArray[np.uint8], WeightlessEdges],
) -> None:
    east = trained[1].east
    assert east.evaluate([window(".## .## .##"), window("..# ..# ..#")]).all()
    never = ("... ... ...", "### ### ###", "##. ##. ##.", "### ### ...", "#.. #.. #..")
    assert not east.evaluate([window(rows) for rows in never]).any()


def test_learned_patterns_know_no_up_and_down(trained: tuple[NDArray[np.uint8], WeightlessEdges]) -> None:
    patterns = trained[1].east.patterns.reshape((2,) * 9)
    # Axis 0 is bit 8, axis 8 is bit 0; reversing the rows swaps bits 0-2 with bits 6-8.
    assert (patterns == patterns.transpose(6, 7, 8, 3, 4, 5, 0, 1, 2)).all()


def test_learning_is_deterministic(trained: tuple[NDArray[np.uint8], WeightlessEdges]) -> None:
    ground, _ = trained
    valid = np.ones((160, 160), dtype=np.bool_)
    first, second = (learn(ground, valid, [sighting(ground, 5, 8, 5, (3, -6))]) for _ in range(2))
    assert first.to_json() == second.to_json()


def test_frames_are_registered_before_anything_is_learned_of_them() -> None:
    ground, valid = country(3), np.ones((160, 160), dtype=np.bool_)
    exact, off = (
        learn(ground, valid, [sighting(ground, 60, 20, 5, by)]).to_json() for by in ((0, 0), (9, -7))
    )
    assert exact == off


def test_of_several_headings_the_one_that_fits_is_learned_from() -> None:
    ground, valid = country(3), np.ones((160, 160), dtype=np.bool_)
    both = sighting(ground, 60, 20, 5, (0, 0))
    alone = Sighting(both.patches[1:], both.row, both.column)
    assert learn(ground, valid, [both]).to_json() == learn(ground, valid, [alone]).to_json()


def test_frame_and_map_teach_the_same_when_they_change_places() -> None:
    ground, valid = country(3), np.ones((160, 160), dtype=np.bool_)
    later = another_date(ground, 7)
    there, back = (
        learn(one, valid, [Sighting((Patch(other, valid, 79.5, 79.5, GSD_M),), 79.5, 79.5)])
        for one, other in ((ground, later), (later, ground))
    )
    assert there.to_json() == back.to_json()


@pytest.mark.parametrize("make", [lambda edges: edges, lambda edges: by_rule()], ids=["learned", "rule"])
def test_frames_of_another_date_are_found(
    trained: tuple[NDArray[np.uint8], WeightlessEdges],
    make: Callable[[WeightlessEdges], WeightlessEdges],
) -> None:
    ground, learned = trained
    edges = make(learned)
    index = ChannelIndex(*edges.extract(ground, np.ones((160, 160), dtype=np.bool_)))
    for row, column in ((80, 40), (17, 55), (105, 95)):
        frame = another_date(ground[row : row + 50, column : column + 60], row)
        match = index.search(*edges.extract(frame, np.ones((50, 60), dtype=np.bool_)))
        assert match is not None
        assert (match.row, match.col) == (row, column)


def test_frames_that_show_nothing_of_the_map_teach_nothing() -> None:
    ground = country(3)
    with pytest.raises(InputError, match="no training frame shows anything"):
        learn(ground, np.zeros((160, 160), dtype=np.bool_), [sighting(ground, 5, 8, 5, (0, 0))])
    with pytest.raises(InputError, match="no training frame shows anything"):
        learn(ground, np.ones((160, 160), dtype=np.bool_), [])


def test_a_frame_at_the_edge_of_the_map_teaches_what_is_common() -> None:
    ground = country(3)
    cut_off = np.ascontiguousarray(ground[4:, 5:])
    seen = sighting(ground, 0, 0, 5, (0, 0))
    shifted = Sighting(seen.patches, seen.row - 4, seen.column - 5)
    learned = learn(cut_off, np.ones(cut_off.shape[:2], dtype=np.bool_), [shifted])
    assert learned.east.evaluate(window(".## .## .##"))
