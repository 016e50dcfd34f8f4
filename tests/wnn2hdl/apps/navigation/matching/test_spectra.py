"""Sums by Fourier transforms are those of a plain loop."""

import numpy as np
import pytest

from wnn2hdl.apps.navigation.matching.spectra import Layers, Spectra, TemplateSpectra, cut, slide

RNG = np.random.default_rng(5)
PIECE, MASKED = RNG.integers(0, 256, (20, 24)).astype(np.uint8), RNG.random((20, 24)) < 0.8
TEMPLATE, MASK = RNG.integers(0, 256, (6, 7)).astype(np.uint8), RNG.random((6, 7)) < 0.8


@pytest.mark.parametrize("whole", [False, True])
def test_sums_of_a_slid_template(whole: bool) -> None:
    inside = np.ones_like(MASKED) if whole else MASKED
    patch = Layers.of(PIECE, inside, np.float64)
    template = Layers.of(TEMPLATE, MASK, np.float64)
    positions = 15, 18
    found = slide(
        Spectra.of(patch, (20, 24), whole=whole), TemplateSpectra.of(template, (20, 24)), "ncc", positions
    )
    for row, col in np.ndindex(*positions):
        common = inside[row : row + 6, col : col + 7] & MASK
        f = PIECE[row : row + 6, col : col + 7][common].astype(float)
        w = TEMPLATE[common].astype(float)
        expected = (len(f), f.sum(), (f * f).sum(), w.sum(), (w * w).sum(), (f * w).sum())
        sums = (found.count, found.f, found.ff, found.w, found.ww, found.fw)
        at = [float(np.broadcast_to(one, positions)[row, col]) for one in sums]
        assert at == pytest.approx(expected, abs=1e-6)


def test_a_piece_that_reaches_beyond_is_filled_with_nothing() -> None:
    layer = np.arange(6).reshape(2, 3)
    assert cut(layer, -1, 1, (3, 3)).tolist() == [[0, 0, 0], [1, 2, 0], [4, 5, 0]]
    assert not cut(layer, 5, 5, (2, 2)).any()


def test_shrunk_pixels_are_means_and_count_by_their_share() -> None:
    inside = np.array([[True, True, True], [True, False, True]])
    shrunk = Layers.of(np.full((2, 3), 8, dtype=np.uint8), inside, np.float32).shrink(2)
    assert shrunk.inside.tolist() == [[0.75, 0.5]]
    assert shrunk.value.tolist() == [[6.0, 4.0]]
    assert shrunk.square.tolist() == [[48.0, 32.0]]


def test_a_binary_picture_is_its_own_square() -> None:
    layers = Layers.of(PIECE > 99, MASKED, np.float32)
    assert layers.square is layers.value
    spectra = Spectra.of(layers, (32, 32))
    assert spectra.nbytes == 2 * 32 * 32 * 4
