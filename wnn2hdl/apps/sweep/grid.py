"""Trials and their order: which architectures are tried, how often, and with which seeds."""

import re
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from functools import cached_property
from itertools import islice, product
from typing import Any

import numpy as np

from wnn2hdl.errors import InputError

Cell = tuple[int, int]
"""An architecture: the address bits of a RAM, and the RAMs of a discriminator."""

_NAME = re.compile(r"n([1-9]\d*)-k([1-9]\d*)-t(0|[1-9]\d*)")


@dataclass(frozen=True)
class Trial:
    """One classifier to train and to cost; with the pixel sets this decides its outcome.

    Attributes:
        name: unique in a sweep: ``n4-k16-t3``.
        address_bits: of a RAM.
        rams: of a discriminator.
        seed: of the tuple mapping.
        bits: pixel bits that are read, as in `BitSelect`.
        bleaching: the threshold; None chooses it by cross-validation by image.
        care_minimum: how often a code must occur in the training imagery to be cared for; None for all codes
            (exact mode).
    """

    name: str
    address_bits: int
    rams: int
    seed: int
    bits: tuple[str, ...]
    bleaching: int | None
    care_minimum: int | None


@dataclass(frozen=True)
class Recipe:
    """What all trials of a sweep have in common.

    Attributes:
        seed: of the whole sweep.
        bits: as in `Trial`, like ``bleaching`` and ``care_minimum``.
    """

    seed: int
    bits: tuple[str, ...]
    bleaching: int | None
    care_minimum: int | None

    def mapping_seed(self, number: int) -> int:
        """Seed of the mapping of trial ``number``; architectures share it, so their trials pair up."""
        return int(np.random.SeedSequence([self.seed, 1 + number]).generate_state(1)[0])

    def trial(self, cell: Cell, number: int) -> Trial:
        """Trial ``number`` of an architecture."""
        n, k = cell
        return Trial(
            f"n{n}-k{k}-t{number}",
            n,
            k,
            self.mapping_seed(number),
            self.bits,
            self.bleaching,
            self.care_minimum,
        )

    def to_json(self) -> dict[str, Any]:
        """A JSON object."""
        return asdict(self) | {"bits": list(self.bits)}


@dataclass(frozen=True)
class Plan:
    """The trials of several architectures, each made when it is asked for, so their number takes no memory.

    Attributes:
        recipe: what they have in common.
        cells: the architectures, all different.
        trials: how many of each.
    """

    recipe: Recipe
    cells: tuple[Cell, ...]
    trials: int

    def __len__(self) -> int:
        return len(self.cells) * self.trials

    def trial(self, position: int) -> Trial:
        """The trial at a position from 0 to ``len(self) - 1``: architecture by architecture."""
        return self.recipe.trial(self.cells[position // self.trials], position % self.trials)

    def position(self, name: str) -> int | None:
        """Where the trial of this name stands; None if it is not of this plan."""
        try:
            cell, number = parse_name(name)
        except InputError:
            return None
        if cell not in self._places or number >= self.trials:
            return None
        return self._places[cell] * self.trials + number

    @cached_property
    def _places(self) -> dict[Cell, int]:
        return {cell: place for place, cell in enumerate(self.cells)}


def parse_name(name: str) -> tuple[Cell, int]:
    """The architecture and the number in a trial's name.

    Raises:
        InputError: it is not the name of a grid's trial.
    """
    match = _NAME.fullmatch(name)
    if match is None:
        raise InputError("no such trial", value=repr(name), hint="name one of the table, as n4-k16-t3")
    n, k, number = map(int, match.groups())
    return (n, k), number


def grid(recipe: Recipe, address_bits: Iterable[int], rams: Iterable[int], trials: int) -> Plan:
    """Every combination of address bits and RAMs."""
    return Plan(recipe, tuple(product(sorted(set(address_bits)), sorted(set(rams)))), trials)


def batches(trials: Iterable[Trial], size: int) -> Iterator[tuple[Trial, ...]]:
    """The trials in runs of ``size``; the last may be shorter."""
    remaining = iter(trials)
    while batch := tuple(islice(remaining, size)):
        yield batch
