"""Narrower words for a network: thresholds that need fewer bits, as long as hardly any answer changes.

A threshold at a multiple of ``2**-f`` is compared without the bits behind ``f``. So narrowing is two things:
a format with fewer bits for all features, and thresholds moved to coarser multiples, feature by feature. What
counts is how many answers on given rows differ from those of the model as it is.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.rows import VectorClassifier
from wnn2hdl.ir import Thermometer, WisardModel
from wnn2hdl.ir.fixed_point import MAX_WORD_BITS, FixedPoint
from wnn2hdl.ir.models import AnyModel, LutGroupModel, SparseWisardModel, VotingModel
from wnn2hdl.ir.models.base import ZERO
from wnn2hdl.ir.nodes import Table
from wnn2hdl.ir.packing import Gate, pairs
from wnn2hdl.ir.wires import Slice
from wnn2hdl.lower.structural import network
from wnn2hdl.progress import Progress

FINEST = 12
"""Fraction bits from which the search starts if the model reads real numbers."""

_ROUNDS = 4
"""How often all thresholds are tried one place higher and lower; two rounds seldom find more."""


@dataclass(frozen=True, eq=False)
class Narrowed:
    """A format that was tried.

    Attributes:
        model: with thresholds that are words, and the format.
        fractions: how many fraction bits the thresholds of each feature need; negative where these are
            multiples of 2, 4 and so on, None where the model reads none.
        changed: rows with another answer than the wide model's.
        unmoved: the same with thresholds where they were; None where only moved ones were tried.
    """

    model: VectorClassifier
    fractions: tuple[int | None, ...]
    changed: int
    unmoved: int | None

    @property
    def words(self) -> FixedPoint:
        """The format of all features."""
        encoder = self.model.encoder
        assert isinstance(encoder, Thermometer)
        assert encoder.input is not None
        return encoder.input


def narrow_formats(model: VectorClassifier, features: NDArray[np.float64]) -> Iterator[Narrowed]:
    """Formats of fewer and fewer fraction bits, the same for all features, the finest first.

    Args:
        model: what is narrowed, with a thermometer.
        features: rows as the model reads them, float64 ``[rows, features]``.

    Raises:
        InputError: the model has no thermometer.
    """
    search = _Search(model, features)
    for fraction in range(search.finest, -1, -1):
        fractions = [fraction] * search.features
        unmoved = search.changed(fractions, search.upwards(fractions))
        levels, changed = search.tuned(fractions, search.best_start(fractions))
        yield search.narrowed(fractions, levels, changed, unmoved)


def narrow_features(
    model: VectorClassifier,
    features: NDArray[np.float64],
    most: int,
    progress: Progress,
) -> Narrowed:
    """Thresholds as coarse as they can be, feature by feature.

    One fraction bit after the other is taken from each feature in turn, those with the most thresholds first,
    and kept if at most ``most`` answers change after the thresholds are moved.

    Args:
        model: what is narrowed, with a thermometer.
        features: rows as the model reads them, float64 ``[rows, features]``.
        most: rows that may get another answer.
        progress: reports every bit that is tried.

    Raises:
        InputError: the model has no thermometer, or the finest words change more answers already.
    """
    search = _Search(model, features)
    fractions = [search.finest] * search.features
    levels, changed = search.tuned(fractions, search.best_start(fractions))
    if changed > most:
        raise InputError(
            "the finest words change more answers than allowed",
            value=f"{changed} of {len(features)} with {search.finest} fraction bits",
            hint="allow more with --most-changed",
        )
    counts = np.bincount(search.owner, minlength=search.features)
    total = int(np.count_nonzero(counts))
    unfinished = np.argsort(-counts, kind="stable")[:total].tolist()
    while unfinished:
        progress("narrowing features", total - len(unfinished), total)
        for feature in list(unfinished):
            coarser = [*fractions]
            coarser[feature] -= 1
            moved, result = levels, most + 1
            if coarser[feature] >= search.coarsest:
                start = np.where(search.owner == feature, search.nearest(coarser), levels)
                moved, result = search.tuned(coarser, start)
            if result <= most:
                fractions, levels, changed = coarser, moved, result
            else:
                unfinished.remove(feature)
    progress("narrowing features", total, total)
    return search.narrowed(fractions, levels, changed, None)


def encoder_luts(model: VectorClassifier) -> int | None:
    """LUTs of a model's encoder before synthesis, two small tables in one where they fit; None if not made.

    Raises:
        InputError: the model votes by tables that cannot be enumerated.
    """
    if not isinstance(model, VotingModel):
        return None
    nodes = network(model).definitions()["encoder"].nodes
    gates = [
        Gate(frozenset(node.word), (Slice(node.name),), True) for node in nodes if isinstance(node, Table)
    ]
    return len(gates) - len(pairs(gates))


class _Search:
    """A model, rows, and the thresholds that the model reads.

    Args:
        model: with a thermometer.
        features: float64 ``[rows, features]``.

    Attributes:
        features: how many there are.
        owner: int64 ``[thresholds]``, the feature of each threshold that is read.
        finest: fraction bits to start with.
        coarsest: fraction bits that leave two words on either side of zero.
    """

    def __init__(self, model: VectorClassifier, features: NDArray[np.float64]) -> None:
        encoder = model.encoder
        if not isinstance(encoder, Thermometer):
            raise InputError("the model has no thresholds that could be moved", value=encoder.kind)
        self.model, self.encoder, self.rows = model, encoder, features
        self.features = encoder.features
        self.read = _read_bits(model)
        owners = np.repeat(np.arange(encoder.features), [len(levels) for levels in encoder.thresholds])
        self.owner = owners[self.read]
        self.thresholds = np.concatenate([np.array(levels) for levels in encoder.thresholds])[self.read]
        self.signed = bool((self.thresholds <= 0).any())
        largest = float(np.abs(self.thresholds).max())
        self.whole = max(0, int(np.floor(largest)).bit_length())
        self.finest = FINEST if encoder.input is None else encoder.input.fraction
        self.finest = min(self.finest, MAX_WORD_BITS - self.whole - 1)
        self.coarsest = 1 - self.whole
        self.answers = model.evaluate(encoder.bits(features))

    def words(self, fractions: list[int]) -> NDArray[np.int64]:
        """Words of the rows for each feature's fraction bits, int64 ``[rows, features]``, saturated."""
        bounds = np.array([self._bounds(fraction) for fraction in fractions]).T
        scaled = np.floor(np.ldexp(self.rows, np.array(fractions)))
        return np.asarray(np.clip(scaled, *bounds).astype(np.int64))

    def _bounds(self, fraction: int) -> tuple[int, int]:
        size = 1 << max(self.whole + fraction, 0)
        return (-size if self.signed else 0), size - 1

    def best_start(self, fractions: list[int]) -> NDArray[np.int64]:
        """Levels to start moving from: the nearest, or those of hardware if these change fewer answers."""
        starts = (self.upwards(fractions), self.nearest(fractions))
        return min(starts, key=lambda levels: self.changed(fractions, levels))

    def nearest(self, fractions: list[int]) -> NDArray[np.int64]:
        """Each threshold as the nearest level: the lowest word that sets its bit."""
        return self._levels(fractions, np.rint)

    def upwards(self, fractions: list[int]) -> NDArray[np.int64]:
        """Each threshold as the level that hardware compares with if nothing is moved."""
        above = (lambda x: np.floor(x) + 1) if self.encoder.strict else np.ceil
        return self._levels(fractions, above)

    def _levels(
        self, fractions: list[int], rounded: Callable[[NDArray[np.float64]], NDArray[np.float64]]
    ) -> NDArray[np.int64]:
        exact = np.ldexp(self.thresholds, np.array(fractions)[self.owner])
        return np.asarray(rounded(exact).astype(np.int64))

    def bits(self, words: NDArray[np.int64], levels: NDArray[np.int64]) -> NDArray[np.bool_]:
        """The model's input bits, bool ``[rows, width]``; those that it does not read are not set."""
        result = np.zeros((len(words), self.encoder.width), dtype=np.bool_)
        result[:, self.read] = words[:, self.owner] >= levels
        return result

    def changed(self, fractions: list[int], levels: NDArray[np.int64]) -> int:
        """Rows with another answer."""
        answers = self.model.evaluate(self.bits(self.words(fractions), levels))
        return int(np.count_nonzero(answers != self.answers))

    def tuned(self, fractions: list[int], levels: NDArray[np.int64]) -> tuple[NDArray[np.int64], int]:
        """Levels moved one by one by one word, as long as fewer answers change; and how many do.

        Only the rows whose word lies between the old and the new level have to be asked again.
        """
        words, levels = self.words(fractions), levels.copy()
        bits = self.bits(words, levels)
        wrong = self.model.evaluate(bits) != self.answers
        for _ in range(_ROUNDS):
            before = np.count_nonzero(wrong)
            for place in range(len(levels)):
                for step in (-1, 1):
                    if not self._ordered(levels, place, step):
                        continue
                    between = levels[place] - (step < 0)
                    rows = np.flatnonzero(words[:, self.owner[place]] == between)
                    moved = bits[rows]
                    moved[:, self.read[place]] ^= True
                    found = self.model.evaluate(moved) != self.answers[rows]
                    if np.count_nonzero(found) < np.count_nonzero(wrong[rows]):
                        levels[place] += step
                        bits[rows], wrong[rows] = moved, found
                        break
            if np.count_nonzero(wrong) in (0, before):
                break
        return levels, int(np.count_nonzero(wrong))

    def _ordered(self, levels: NDArray[np.int64], place: int, step: int) -> bool:
        """Whether thresholds of a feature still do not fall if one moves by a step."""
        other = place + step
        return (
            not 0 <= other < len(levels)
            or self.owner[other] != self.owner[place]
            or levels[other] != levels[place]
        )

    def narrowed(
        self, fractions: list[int], levels: NDArray[np.int64], changed: int, unmoved: int | None
    ) -> Narrowed:
        """The model with thresholds at levels, and the format that they need."""
        used = sorted(set(self.owner.tolist()))
        fraction = max(0, *(fractions[feature] for feature in used))
        form = FixedPoint(max(self.whole + fraction + self.signed, 1), fraction, self.signed)
        values = np.ldexp(levels.astype(np.float64), -np.array(fractions)[self.owner])
        thresholds = []
        for feature, before in enumerate(self.encoder.thresholds):
            mine = self.owner == feature
            first = self.read[mine] - sum(len(x) for x in self.encoder.thresholds[:feature])
            # A threshold that is not read takes the value of the one before, so that they still rise.
            place = np.searchsorted(first, np.arange(len(before)), side="right") - 1
            known = values[mine] if mine.any() else np.zeros(1)
            thresholds.append(tuple(known[np.maximum(place, 0)].tolist()))
        encoder = Thermometer(tuple(thresholds), input=form)
        needed = tuple(bits if feature in used else None for feature, bits in enumerate(fractions))
        assert isinstance(self.model, AnyModel)
        return Narrowed(replace(self.model, encoder=encoder), needed, changed, unmoved)


def _read_bits(model: VectorClassifier) -> NDArray[np.int64]:
    """The input bits that a model reads, ascending."""
    if isinstance(model, LutGroupModel):
        mapping: NDArray[np.integer] = model.layers[0].mapping
    elif isinstance(model, WisardModel | SparseWisardModel):
        mapping = model.mapping
    else:
        return np.arange(model.encoder.width)
    read = np.unique(mapping)
    return np.asarray(read[read != ZERO], dtype=np.int64)
