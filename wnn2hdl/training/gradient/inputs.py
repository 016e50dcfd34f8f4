"""The bits that nodes may read: thresholds of features, and whether a block of pixels has a bright one."""

from bisect import bisect_left
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.ir import LUT_INPUTS, Thermometer
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.ir.models import LutGroupModel
from wnn2hdl.ir.models.luts import LutLayer
from wnn2hdl.training.gradient.layer import VotingLayer

RARE = 0.001
"""A bit that is set in a smaller share of the training samples, or unset in one, is left out."""

_BLOCK = 2
"""Rows and columns of a block of pixels."""


@dataclass(frozen=True, eq=False)
class InputBits:
    """What a layer can read: bits of a thermometer, then ORs of four of them.

    Attributes:
        encoder: thresholds of words of a stated format.
        blocks: int64 ``[blocks, 4]``, the bits of the encoder that each OR reads.
    """

    encoder: Thermometer
    blocks: NDArray[np.int64]

    @property
    def width(self) -> int:
        """How many bits there are."""
        return self.encoder.width + len(self.blocks)

    @property
    def luts(self) -> NDArray[np.float32]:
        """About what each bit costs in LUTs, float32 ``[width]``: 0 for a bit of a word as it is, else 1."""
        form = _format(self.encoder)
        levels = np.array([level for feature in self.encoder.levels for level in feature])
        return np.concatenate([levels != free_level(form), np.ones(len(self.blocks))]).astype(np.float32)

    def rows(self, features: ArrayLike) -> NDArray[np.uint8]:
        """Bits of feature vectors ``[samples, features]``: 0 or 1, uint8 ``[width, samples]``."""
        bits = np.ascontiguousarray(self.encoder.bits(features).T).view(np.uint8)
        return (
            np.concatenate([bits, np.bitwise_or.reduce(bits[self.blocks.T], axis=0)])
            if len(self.blocks)
            else bits
        )

    def model(self, layer: VotingLayer, classes: tuple[str, ...]) -> LutGroupModel:
        """A trained layer as the compiler reads it; of the bits it has those that are read.

        Args:
            layer: reads these bits.
            classes: names of its classes.
        """
        read = np.unique(layer.mapping)
        blocks = self._as_blocks(read)
        kept = np.unique(blocks)
        groups = np.repeat(np.arange(layer.classes, dtype=np.int32), layer.nodes_per_class)
        nodes = np.searchsorted(read, layer.mapping).T
        if (blocks == blocks[:, :1]).all():
            layers: tuple[LutLayer, ...] = (
                LutLayer(np.searchsorted(kept, blocks[:, 0])[nodes].astype(np.int32), layer.tables),
            )
        else:
            ors = np.tile(np.arange(1 << blocks.shape[1]) > 0, (len(read), 1))
            first = LutLayer(np.searchsorted(kept, blocks).astype(np.int32), ors)
            layers = (first, LutLayer(nodes.astype(np.int32), layer.tables))
        return LutGroupModel(self._encoder_of(kept), classes, layers, groups)

    def _as_blocks(self, read: NDArray[np.int64]) -> NDArray[np.int64]:
        """Four bits of the encoder whose OR each bit is; a bit of the encoder is the OR of itself."""
        single = np.repeat(np.arange(self.encoder.width)[:, np.newaxis], _BLOCK**2, axis=1)
        return np.concatenate([single, self.blocks])[read]

    def _encoder_of(self, kept: NDArray[np.int64]) -> Thermometer:
        wanted = set(kept.tolist())
        thresholds, position = [], 0
        for levels in self.encoder.thresholds:
            thresholds.append(tuple(t for i, t in enumerate(levels, position) if i in wanted))
            position += len(levels)
        return Thermometer(tuple(thresholds), input=self.encoder.input)


def choose_inputs(
    features: NDArray[np.float64], words: FixedPoint, levels: int, grid: tuple[int, int] | None
) -> InputBits:
    """The bits that may be worth reading.

    They are the most significant bit of each word, which costs nothing; quantiles of each feature, rounded to
    values that one LUT can compare with; and, where the features are the pixels of a picture, the ORs of
    the most significant bits of all blocks of 2x2 pixels. Bits that are nearly constant are left out.

    Args:
        features: of the training samples, ``[samples, features]``.
        words: what hardware reads.
        levels: thresholds for each feature, at least 1; the first is the most significant bit if that varies.
        grid: rows and columns of the picture, whose pixels are the features row by row; None for no picture.

    Raises:
        InputError: a grid of another size, or nothing but constant bits.
    """
    numbers = words.words(features)
    free = free_level(words)
    top = numbers >= free
    found = [
        sorted(_levels(column, words, levels, useful))
        for column, useful in zip(numbers.T, _varied(top), strict=True)
    ]
    blocks = np.zeros((0, _BLOCK**2), dtype=np.int64)
    if grid is not None:
        pixels = _block_pixels(grid, features.shape[1])
        pixels = pixels[_varied(np.bitwise_or.reduce(top[:, pixels], axis=2))]
        for pixel in np.unique(pixels):
            found[pixel] = sorted({*found[pixel], free})
        starts = np.cumsum([0, *map(len, found)])
        places = np.array([start + bisect_left(of, free) for start, of in zip(starts, found, strict=False)])
        blocks = places[pixels]
    if not any(found):
        raise InputError(
            "no feature tells samples apart in this format of words",
            value=str(words),
            hint="state the format in which the features come",
        )
    values = tuple(tuple(words.values(of).tolist()) for of in found)
    return InputBits(Thermometer(values, input=words), blocks)


def free_level(words: FixedPoint) -> int:
    """The lowest word whose most significant bit says that it is high; for signed words, 0."""
    return 0 if words.signed else 1 << (words.bits - 1)


def _levels(column: NDArray[np.int64], words: FixedPoint, count: int, free_varies: bool) -> set[int]:
    """Levels at quantiles, of which one LUT reads the bits that matter, and the free one if it varies."""
    free = {free_level(words)} if free_varies else set()
    wanted = count - len(free)
    if wanted == 0:
        return free
    step = 1 << max(0, int(np.ptp(column)).bit_length() - LUT_INPUTS)
    parts = np.arange(1, wanted + 1) / (wanted + 1)
    near = np.unique(np.round(np.quantile(column, parts) / step).astype(np.int64) * step)
    varied = _varied(column[:, np.newaxis] >= near)
    return free | set(near[varied].tolist())


def _varied(bits: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Whether bits are neither nearly always set nor nearly never: ``[samples, bits]`` gives ``[bits]``."""
    share = bits.mean(axis=0)
    return np.asarray((share > RARE) & (share < 1 - RARE))


def _block_pixels(grid: tuple[int, int], features: int) -> NDArray[np.int64]:
    """The pixels of all blocks of 2x2: int64 ``[blocks, 4]``."""
    rows, columns = grid
    if rows * columns != features:
        raise InputError(
            "the picture has another number of pixels than there are features",
            value=f"{rows}x{columns}, not {features}",
        )
    pixels = np.arange(features).reshape(grid)
    parts = [
        pixels[row : rows - _BLOCK + 1 + row, column : columns - _BLOCK + 1 + column].ravel()
        for row in range(_BLOCK)
        for column in range(_BLOCK)
    ]
    return np.stack(parts, axis=1)


def _format(encoder: Thermometer) -> FixedPoint:
    assert encoder.input is not None
    return encoder.input
