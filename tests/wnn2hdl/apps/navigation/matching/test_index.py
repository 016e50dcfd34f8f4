"""Searches find what the brute-force reference finds, and templates where they were cut out."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from wnn2hdl.apps.navigation.matching import MapIndex, Score, Window
from wnn2hdl.apps.navigation.matching.scores import Sums, Values, evaluate
from wnn2hdl.apps.navigation.matching.spectra import cut
from wnn2hdl.errors import InputError

SCORES: tuple[Score, ...] = ("correlation", "ncc", "match_count")

Bits = NDArray[np.bool_]


def bits(rng: np.random.Generator, shape: tuple[int, int], share: float) -> Bits:
    return rng.random(shape) < share


def town(rng: np.random.Generator, side: int) -> Bits:
    """Edges with structure of several sizes: outlines of random rectangles."""
    edges = np.zeros((side, side), dtype=np.bool_)
    for _ in range(side * side // 400):
        top, left = rng.integers(0, side - 4, 2)
        height, width = rng.integers(3, 40, 2)
        edges[top : top + height, [left, min(left + width, side - 1)]] = True
        edges[[top, min(top + height, side - 1)], left : left + width] = True
    return edges


@st.composite
def cases(draw: st.DrawFn) -> tuple[Bits, Bits, Bits, Bits, Window, float]:
    """Map, valid pixels, template, mask, window (also beyond the map), least overlap."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    shape = draw(st.tuples(st.integers(1, 90), st.integers(1, 150)))
    size = draw(st.tuples(st.integers(1, 20), st.integers(1, 80)))
    density = draw(st.sampled_from((0.0, 0.05, 0.3, 1.0)))
    top, left = draw(st.tuples(st.integers(-15, 60), st.integers(-40, 120)))
    window = Window(top, left, top + draw(st.integers(1, 40)), left + draw(st.integers(1, 80)))
    return (
        bits(rng, shape, density),
        bits(rng, shape, draw(st.sampled_from((0.6, 1.0)))),
        bits(rng, size, density),
        bits(rng, size, draw(st.sampled_from((0.7, 1.0)))),
        window,
        draw(st.sampled_from((0.0, 0.5, 1.0))),
    )


def brute_scores(
    image: Bits, valid: Bits, template: Bits, mask: Bits, score: Score, window: Window
) -> tuple[Values, Values]:
    """Scores and numbers of common pixels of all positions of a window, pixel by pixel."""
    size = window.shape[0] + mask.shape[0] - 1, window.shape[1] + mask.shape[1] - 1
    under = [cut(layer, window.top, window.left, size) for layer in (valid, image & valid)]
    inside, f = (np.lib.stride_tricks.sliding_window_view(layer, mask.shape) for layer in under)
    common = inside & mask
    w = common & template
    f = f & mask
    count, *sums = (
        layer.sum(axis=(2, 3)).astype(np.float64) for layer in (common, f, w, f & w, ~(f ^ w) & common)
    )
    if score == "match_count":
        return sums[3] / np.maximum(count, 1), count
    return evaluate(score, Sums(count, sums[0], sums[0], sums[1], sums[1], sums[2])), count


@settings(max_examples=150, deadline=None)
@given(cases(), st.sampled_from(SCORES))
def test_winner_and_its_score_are_those_of_brute_force(
    case: tuple[Bits, Bits, Bits, Bits, Window, float], score: Score
) -> None:
    image, valid, template, mask, window, overlap = case
    match = MapIndex(image, valid).search(template, mask, score, window, min_overlap=overlap)
    touching = window.clip(Window(1 - template.shape[0], 1 - template.shape[1], *image.shape))
    if not touching.positions:
        assert match is None
        return
    scores, common = brute_scores(image, valid, template, mask, score, touching)
    scores[(common < overlap * np.count_nonzero(mask)) | (common == 0)] = -np.inf
    if scores.max() == -np.inf:
        assert match is None
        return
    assert match is not None
    row, col = (int(place) for place in np.unravel_index(scores.argmax(), scores.shape))
    assert (match.row, match.col) == (touching.top + row, touching.left + col)
    assert match.score == scores.max()


@pytest.mark.parametrize(
    ("score", "reduction"), [("correlation", 2), ("ncc", 1), ("ncc", 2), ("ncc", 4), ("match_count", 2)]
)
def test_a_coarse_search_finds_the_winner_of_the_exact_one(score: Score, reduction: int) -> None:
    rng = np.random.default_rng(3)
    image = town(rng, 500)
    valid = np.ones_like(image)
    valid[:, 470:] = False
    coarse = MapIndex(image, valid, reduction=reduction, direct=0)
    exact = MapIndex(image, valid)
    for row, col in rng.integers(0, 370, (4, 2)):
        template = image[row : row + 101, col : col + 97].copy()
        template ^= rng.random(template.shape) < 0.2 * template.mean()
        mask = np.ones_like(template)
        mask[:20, :30] = False
        found, expected = (index.search(template, mask, score) for index in (coarse, exact))
        assert found is not None
        assert expected is not None
        assert found.peaks[0] == expected.peaks[0]
        if score == "ncc":
            assert (found.row, found.col) == (row, col)


@pytest.mark.parametrize("direct", [0, 1 << 22])
@pytest.mark.parametrize("kind", [np.uint8, np.float32])
def test_grey_levels_are_found_whatever_their_light(kind: type[Any], direct: int) -> None:
    rng = np.random.default_rng(1)
    smooth = np.cumsum(rng.normal(0, 4, (300, 280)), axis=1) + 120
    image = np.clip(smooth, 0, 255).astype(kind)
    template = (image[100:180, 60:150] * 0.5 + 20).astype(kind)
    match = MapIndex(image, direct=direct).search(template)
    assert match is not None
    assert (match.row, match.col) == (100, 60)


def test_a_template_may_reach_beyond_the_map_as_far_as_the_overlap_allows() -> None:
    image = town(np.random.default_rng(5), 200)
    template = np.zeros((60, 60), dtype=np.bool_)
    template[12:, :] = image[:48, 100:160]
    inside = MapIndex(image).search(template, min_overlap=1)
    beyond = MapIndex(image).search(template, min_overlap=0.75)
    assert beyond is not None
    assert (beyond.row, beyond.col, beyond.score) == (-12, 100, 1.0)
    assert inside is not None
    assert inside.row >= 0


def test_without_enough_common_pixels_there_is_no_match() -> None:
    image = np.ones((50, 50), dtype=np.bool_)
    template = image[:20, :20]
    assert MapIndex(image, ~image).search(template) is None
    assert MapIndex(image).search(template, window=Window(60, 0, 70, 10)) is None
    assert MapIndex(image, direct=0).search(template, ~template) is None


def test_a_constant_picture_has_no_correlation() -> None:
    match = MapIndex(np.full((80, 80), 200, dtype=np.uint8)).search(np.full((20, 20), 7, dtype=np.uint8))
    assert match is not None
    assert match.score == 0


def test_normalised_correlation_is_pearsons_coefficient() -> None:
    rng = np.random.default_rng(2)
    image = rng.integers(0, 256, (40, 40), dtype=np.uint8)
    template = rng.integers(0, 256, (15, 12), dtype=np.uint8)
    mask = rng.random((15, 12)) < 0.8
    match = MapIndex(image).search(template, mask, window=Window(7, 9, 8, 10))
    assert match is not None
    expected = np.corrcoef(image[7:22, 9:21][mask], template[mask])[0, 1]
    assert match.score == pytest.approx(expected, rel=1e-12)


def test_memory_is_that_of_the_spectra_kept() -> None:
    index = MapIndex(town(np.random.default_rng(0), 600), direct=0)
    template = np.ones((50, 50), dtype=np.bool_)
    assert index.nbytes == 0
    index.search(template)
    # 2 x 2 tiles of 512 x 512 in single precision, each the picture and which of its pixels count.
    assert index.nbytes == 4 * 2 * 4 * 512**2
    held = index.nbytes
    index.search(template)
    assert index.nbytes == held


@pytest.mark.parametrize(
    ("template", "mask", "score", "message"),
    [
        (np.zeros((4, 4), np.uint8), None, "ncc", "different types"),
        (np.zeros((4, 4), np.int64), None, "ncc", "not a picture to match"),
        (np.zeros((4, 4), np.bool_), np.ones((4, 5), np.bool_), "ncc", "mask does not fit"),
    ],
)
def test_pictures_that_do_not_fit_are_refused(template: Any, mask: Any, score: Score, message: str) -> None:
    with pytest.raises(InputError, match=message):
        MapIndex(np.zeros((9, 9), np.bool_)).search(template, mask, score)


def test_grey_levels_have_no_match_count() -> None:
    with pytest.raises(InputError, match="compares bits"):
        MapIndex(np.zeros((9, 9), np.uint8)).search(np.zeros((3, 3), np.uint8), score="match_count")


def test_a_map_is_not_shrunk_by_any_number() -> None:
    with pytest.raises(InputError, match="cannot be shrunk"):
        MapIndex(np.zeros((9, 9), np.bool_), reduction=3)
