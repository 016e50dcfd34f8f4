"""Template matching of several binary images at once: their pixels count together in one score."""

from collections import OrderedDict
from dataclasses import dataclass
from threading import Lock

import numpy as np
import scipy.fft
from numpy.typing import NDArray

from wnn2hdl.apps.navigation.matching.peaks import Match, Window, find_peaks
from wnn2hdl.apps.navigation.matching.scores import Score, Sums, evaluate
from wnn2hdl.errors import InputError

Channels = NDArray[np.bool_]
"""Binary images of one scene: bool ``[channels, height, width]``."""

_GRAIN = 32
"""Templates are padded to multiples of this many pixels, so that templates of similar size share spectra."""

_KEPT = 2
"""Pieces of the map whose spectra are kept: the last window's and, as a rule, the whole map's."""


@dataclass(frozen=True, eq=False)
class _Piece:
    """Transforms of a piece of the map, complex128 ``[..., rows, columns // 2 + 1]``.

    Attributes:
        shape: rows and columns that were transformed.
        channels: of each channel.
        edges: of the channels' sum.
        inside: of the pixels that count.
    """

    shape: tuple[int, int]
    channels: NDArray[np.complex128]
    edges: NDArray[np.complex128]
    inside: NDArray[np.complex128]


class ChannelIndex:
    """A map of several binary images, to be searched as `wnn2hdl.apps.navigation.matching.MapIndex` is.

    The sums of each score run over all channels, as if they were one picture with the channels side by side;
    products of spectra are added before the one inverse transform, so that a search of c channels costs c
    forward and four inverse transforms. All positions are scored exactly: in double precision, rounded to the
    whole numbers that the sums are.

    Args:
        channels: bool ``[channels, height, width]``; kept, not copied.
        valid: bool ``[height, width]``, the pixels that hold the map in all channels; kept, not copied.

    Raises:
        InputError: types or shapes do not fit.
    """

    def __init__(self, channels: Channels, valid: NDArray[np.bool_]) -> None:
        _check(channels, valid)
        self._channels = channels
        self._valid = valid
        self._pieces: OrderedDict[tuple[int, int, int, int], _Piece] = OrderedDict()
        self._making = Lock()

    def search(
        self,
        template: Channels,
        mask: NDArray[np.bool_],
        score: Score = "ncc",
        window: Window | None = None,
        *,
        min_overlap: float = 0.75,
        exclusion: int = 20,
    ) -> Match | None:
        """Where the template fits best.

        Args:
            template: bool ``[channels, h, w]``.
            mask: bool ``[h, w]``, its pixels that count.
            score: how a position is judged.
            window: allowed positions of the template's top left pixel; by default all that touch the map.
            min_overlap: least share of the mask's pixels that must be common with the map's valid ones.
            exclusion: peaks are more than this many rows or columns apart.

        Returns:
            the match; None if no position has enough common pixels.

        Raises:
            InputError: types or shapes do not fit.
        """
        _check(template, mask)
        if len(template) != len(self._channels):
            raise InputError(
                "template and map have different channels", value=f"{len(template)}, {len(self._channels)}"
            )
        height, width = (-(-side // _GRAIN) * _GRAIN for side in mask.shape)
        rows, columns = self._valid.shape
        touching = Window(1 - height, 1 - width, rows, columns)
        window = touching if window is None else window.clip(touching)
        if not window.positions:
            return None
        sums = self._sums(template & mask, mask, window, (height, width))
        scores = evaluate(score, sums)
        # Half a pixel of slack, as in the index of one picture: shares are seldom whole numbers of pixels.
        least = max(min_overlap * float(mask.sum()), 1.0) - 0.5
        enough = sums.count > least * len(template)
        return find_peaks(np.where(enough, scores, -np.inf), window, exclusion)

    def _sums(
        self, template: Channels, mask: NDArray[np.bool_], window: Window, padded: tuple[int, int]
    ) -> Sums:
        piece = self._piece(window, padded)

        def transform(layers: NDArray[np.bool_]) -> NDArray[np.complex128]:
            return np.conj(scipy.fft.rfft2(layers.astype(np.float64), piece.shape))

        def product(spectrum: NDArray[np.complex128]) -> NDArray[np.float64]:
            full = scipy.fft.irfft2(spectrum, piece.shape)
            return np.asarray(np.rint(full[: window.shape[0], : window.shape[1]]))

        edges, inside = transform(template), transform(mask)
        count = product(piece.inside * inside) * len(template)
        f = product(piece.edges * inside)
        w = product(piece.inside * edges.sum(axis=0))
        fw = product(np.einsum("cij,cij->ij", piece.channels, edges))
        # The square of a bit is the bit.
        return Sums(count, f, f, w, w, fw)

    def _piece(self, window: Window, padded: tuple[int, int]) -> _Piece:
        """Spectra of what a template of a shape can cover from the positions of a window."""
        rows, columns = (span + side - 1 for span, side in zip(window.shape, padded, strict=True))
        key = (window.top, window.left, rows, columns)
        with self._making:
            piece = self._pieces.pop(key, None)
            if piece is None:
                shape = (
                    scipy.fft.next_fast_len(rows, real=True),
                    scipy.fft.next_fast_len(columns, real=True),
                )
                valid = _cut(self._valid[np.newaxis], window, (rows, columns))[0]
                channels = _cut(self._channels, window, (rows, columns)) & valid
                layers = (channels, channels.sum(axis=0), valid)
                piece = _Piece(shape, *(scipy.fft.rfft2(layer.astype(np.float64), shape) for layer in layers))
            self._pieces[key] = piece
            if len(self._pieces) > _KEPT:
                self._pieces.popitem(last=False)
        return piece


def _cut(layers: NDArray[np.bool_], window: Window, shape: tuple[int, int]) -> NDArray[np.bool_]:
    """A piece from the window's top left on, false where it reaches beyond the map."""
    _, height, width = layers.shape
    bottom, right = window.top + shape[0], window.left + shape[1]
    inside = layers[:, max(window.top, 0) : max(bottom, 0), max(window.left, 0) : max(right, 0)]
    before = max(-window.top, 0), max(-window.left, 0)
    after = max(bottom - height, 0), max(right - width, 0)
    return np.pad(inside, ((0, 0), (before[0], after[0]), (before[1], after[1])))


def _check(channels: Channels, inside: NDArray[np.bool_]) -> None:
    fitting = channels.ndim == 3 and channels.shape[1:] == inside.shape and channels.size > 0
    if not fitting or channels.dtype != np.bool_ or inside.dtype != np.bool_:
        raise InputError(
            "these are not binary images to match",
            value=f"{channels.dtype} {channels.shape} with {inside.dtype} {inside.shape}",
            hint="use bool of shape [channels, height, width] and of [height, width]",
        )
