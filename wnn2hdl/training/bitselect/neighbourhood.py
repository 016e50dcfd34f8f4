"""Tables over a pixel and its neighbours: six cascades, each at its own pixel, and one LUT over their bits.

A smooth reference looks at the mean colour of the window. A table of few LUTs follows such a reference in
coarse steps; neighbours have nearly the same colour, so tables that step at different colours, one at each of
several pixels, follow it in fine ones together. They are chosen in turn: with all others fixed, the windows
whose answer depends on one table give a signed mass over the codes of its pixel, and `find_cascade` gives
the best table for that.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.ir import BitSelect, Neighbourhood, Tap, WisardModel, bits_to_codes, codes_to_bits, spread_codes
from wnn2hdl.training.bitselect.cascade import find_cascade
from wnn2hdl.training.bitselect.drift import WIDTH
from wnn2hdl.training.bitselect.mass import CUBE_SHARE, POOL, WHOLE
from wnn2hdl.training.bitselect.reference import fit_window_reference
from wnn2hdl.training.bitselect.select import look_up_table
from wnn2hdl.wisard import require_every_class, require_two_classes

SIZES = (3, 5)

TAP_LUTS = 2
"""LUTs of each table. In cross-validation by image over 30 Sentinel-2 scenes, one LUT each gave 93.1 %, two
gave 94.7 %, and three no more.
"""

STEPS = (0.5, 0.38, 0.62, 0.46, 0.54, 0.42)
"""The probabilities at which the tables step before they are improved, in the order of the taps."""

LUTS = len(STEPS) * TAP_LUTS + 1
"""LUTs of the whole."""

COPIES = 3
"""How often each window is used, each time with another drift."""

ROUNDS = 2
"""How often each table is chosen again."""

CUBE_STEP = 8


@dataclass(frozen=True, eq=False)
class _Evidence:
    """Windows and what the reference says of them.

    Attributes:
        codes: for each tap the code in `POOL` of its pixel, uint32 ``[windows]``.
        target: signed weight of each window, float64 ``[windows]``; the magnitudes sum to at most 1.
        margin: for each tap the signed weight at its step of `STEPS`, float64 ``[windows]``.
    """

    codes: list[NDArray[np.uint32]]
    target: NDArray[np.float64]
    margin: list[NDArray[np.float64]]


def select_neighbourhood(
    windows: NDArray[np.uint8],
    labels: NDArray[np.uint8],
    drift: NDArray[np.float64],
    classes: tuple[str, ...],
    *,
    seed: int,
    progress: Callable[[int, int], None],
) -> WisardModel:
    """Choose six tables, at the middle pixel (two) and four neighbours, and the LUT that reads their bits.

    Args:
        windows: uint8 ``[samples, size, size, 3]``, drawn from all training images; size is 3 or 5.
        labels: class of the middle pixel, uint8 ``[samples]``.
        drift: how the background's colour moves between images, as `main_drift` gives it.
        classes: two class names, the background first.
        seed: of the drift of each window and of the searches.
        progress: called with (tables chosen, tables in all).

    Returns:
        a model whose encoder is a `Neighbourhood`, with one RAM per class that reads all taps; `LUTS` LUTs.

    Raises:
        InputError: not two classes, another size, or a class without windows.
    """
    _check(windows, labels, classes)
    size = windows.shape[1]
    places = _places(size)
    rng = np.random.default_rng(seed)
    evidence = _evidence(windows, labels, drift, places, rng)
    width = len(places)
    tables = [
        _table(codes, margin, seed) for codes, margin in zip(evidence.codes, evidence.margin, strict=True)
    ]
    answers = np.stack([table[codes] for table, codes in zip(tables, evidence.codes, strict=True)], axis=1)
    last = _best_lut(answers, evidence.target)
    progress(0, ROUNDS * width)
    for turn in range(ROUNDS * width):
        tap = turn % width
        codes = bits_to_codes(answers) & ~(1 << tap)
        matters = last[codes | 1 << tap].astype(np.float64) - last[codes]
        mass = evidence.target * matters
        if mass.any():
            tables[tap] = _table(evidence.codes[tap], mass, seed + turn)
            answers[:, tap] = tables[tap][evidence.codes[tap]]
            last = _best_lut(answers, evidence.target)
        progress(turn + 1, ROUNDS * width)
    taps = tuple(_tap(*place, table) for place, table in zip(places, tables, strict=True))
    training = {"method": "neighbourhood", "luts": LUTS, "seed": seed, "windows": len(windows)}
    return look_up_table(Neighbourhood(size, taps), classes, last.astype(np.int64), training)


def _check(windows: NDArray[np.uint8], labels: NDArray[np.uint8], classes: tuple[str, ...]) -> None:
    require_two_classes(classes, "a neighbourhood")
    if windows.shape[1] not in SIZES:
        raise InputError(
            "a neighbourhood has 3x3 or 5x5 pixels", value=windows.shape[1], hint="ask for 3 or 5"
        )
    require_every_class(classes, ((labels == index).any() for index in range(len(classes))))


def _places(size: int) -> tuple[tuple[int, int], ...]:
    """Row and column of each tap: the middle twice, and at the rim those above, below, left and right."""
    middle, end = size // 2, size - 1
    return ((middle, middle), (middle, middle), (0, middle), (end, middle), (middle, 0), (middle, end))


def _evidence(
    windows: NDArray[np.uint8],
    labels: NDArray[np.uint8],
    drift: NDArray[np.float64],
    places: tuple[tuple[int, int], ...],
    rng: np.random.Generator,
) -> _Evidence:
    moved = np.concatenate([_drifted(windows, drift, rng) for _ in range(COPIES)])
    means = moved.mean(axis=(1, 2))
    probability = fit_window_reference(means, np.tile(labels, COPIES))
    # Windows of one colour each, all over the cube: of colours never seen the tables get to know the answer.
    levels = np.arange(CUBE_STEP // 2, 256, CUBE_STEP, dtype=np.uint8)
    cube = np.stack(np.meshgrid(levels, levels, levels, indexing="ij"), axis=-1).reshape(-1, 3)
    p = np.concatenate([probability(means), probability(cube.astype(np.float64))])
    weight = np.repeat([1 / len(moved), CUBE_SHARE / len(cube)], [len(moved), len(cube)])
    return _Evidence(
        [np.concatenate([POOL.codes(moved[:, row, column]), POOL.codes(cube)]) for row, column in places],
        weight * (2 * p - 1),
        [weight * (p - step) for step in STEPS],
    )


def _drifted(
    windows: NDArray[np.uint8], drift: NDArray[np.float64], rng: np.random.Generator
) -> NDArray[np.uint8]:
    """Each window moved along the drift as a whole, `WIDTH` times as far as images differ."""
    offsets = np.rint(WIDTH * rng.normal(size=(len(windows), 1)) * drift).astype(np.int16)
    moved = windows + offsets[:, np.newaxis, np.newaxis]
    return np.asarray(np.clip(moved, 0, 255), dtype=np.uint8)


def _table(codes: NDArray[np.uint32], mass: NDArray[np.float64], seed: int) -> NDArray[np.bool_]:
    """The best table of `TAP_LUTS` LUTs for signed masses of windows, over all codes of `POOL`."""
    cells = np.bincount(codes, mass, 1 << POOL.width)
    cascade = find_cascade(np.rint(cells * WHOLE).astype(np.int64), TAP_LUTS, seed)
    return cascade.evaluate(np.arange(1 << POOL.width))


def _best_lut(answers: NDArray[np.bool_], target: NDArray[np.float64]) -> NDArray[np.bool_]:
    """The contents with the most mass right; bits of a code that never occurs decide by majority."""
    width = answers.shape[1]
    mass = np.bincount(bits_to_codes(answers), target, 1 << width)
    votes = codes_to_bits(np.arange(1 << width), width).sum(axis=1)
    return np.where(mass == 0, 2 * votes > width, mass > 0)


def _tap(row: int, column: int, table: NDArray[np.bool_]) -> Tap:
    """A tap that reads only the bits of `POOL` on which a table depends."""
    codes = np.arange(1 << POOL.width)
    used = [bit for bit in range(POOL.width) if (table[codes] != table[codes ^ 1 << bit]).any()] or [0]
    return Tap.of(row, column, BitSelect(tuple(POOL.bits[bit] for bit in used)), table[spread_codes(used)])
