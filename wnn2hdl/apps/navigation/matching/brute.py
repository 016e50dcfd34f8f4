"""All positions one by one, on bits: what the hardware computes, and what faster searches must agree with."""

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.navigation.matching.peaks import Window
from wnn2hdl.apps.navigation.matching.scores import Score, Sums, Values, evaluate
from wnn2hdl.apps.navigation.matching.spectra import cut

Bits = NDArray[np.bool_]

WORD = 64


def brute_scores(
    image: Bits, valid: Bits, template: Bits, mask: Bits, score: Score, window: Window
) -> tuple[Values, Values]:
    """Scores of all positions of a window, by popcounts of words of 64 pixels.

    The match count is that of an XNOR under the mask, the correlation that of an AND; the normalised
    correlation follows from the four popcounts of f, w, f AND w and the mask.

    Args:
        image: bool ``[height, width]``.
        valid: bool of the image's shape, its pixels that count; outside none do.
        template: bool ``[h, w]``.
        mask: bool of the template's shape, its pixels that count.
        score: which.
        window: positions of the template's top left pixel, also outside the map.

    Returns:
        scores and numbers of common pixels, float64 of the window's shape.
    """
    rows, cols = window.shape
    size = rows + template.shape[0] - 1, cols + template.shape[1] + WORD
    inside = _words(cut(valid, window.top, window.left, size))
    ones = _words(cut(image & valid, window.top, window.left, size))
    counts = np.zeros((5, rows, cols))
    for phase in range(min(WORD, cols)):
        # The template's bits at this phase of a word: columns phase, phase + 64, … are scored at once.
        shifted = [_words(np.pad(bits, ((0, 0), (phase, 0)))) for bits in (mask, template & mask)]
        here = counts[:, :, phase::WORD]
        for row, (mask_words, template_words) in enumerate(zip(*shifted, strict=True)):
            reach = here.shape[2], len(mask_words)
            common = _sliding(inside[row : row + rows], reach) & mask_words
            f = _sliding(ones[row : row + rows], reach) & mask_words
            w = common & template_words
            for total, words in zip(here, (common, f, w, f & w, ~(f ^ w) & common), strict=True):
                total += np.bitwise_count(words).sum(axis=-1)
    count, f_sum, w_sum, fw, agreeing = counts
    if score == "match_count":
        return agreeing / np.maximum(count, 1), count
    return evaluate(score, Sums(count, f_sum, f_sum, w_sum, w_sum, fw)), count


def _words(bits: Bits) -> NDArray[np.uint64]:
    """Rows of bits as words of 64, the first bit the lowest, zeros behind the last."""
    padded = np.pad(bits, ((0, 0), (0, -bits.shape[1] % WORD)))
    return np.packbits(padded, axis=1, bitorder="little").view("<u8")


def _sliding(words: NDArray[np.uint64], reach: tuple[int, int]) -> NDArray[np.uint64]:
    """For each row and each of ``reach[0]`` first words, the ``reach[1]`` words from there on."""
    places, length = reach
    return np.lib.stride_tricks.sliding_window_view(words, length, axis=1)[:, :places]
