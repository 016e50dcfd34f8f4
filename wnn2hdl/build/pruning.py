"""Leaving out tables of a network that never, or on given rows hardly ever, change which class wins."""

from collections import Counter
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.ir import WisardModel
from wnn2hdl.ir.models import AnyModel, LutGroupModel, LutLayer, SparseWisardModel, VotingModel
from wnn2hdl.ir.models.base import winner
from wnn2hdl.progress import Progress
from wnn2hdl.wisard.rams import addresses


@dataclass(frozen=True, eq=False)
class Pruned:
    """A network with fewer tables.

    Attributes:
        model: without them.
        tables: how many of the tables that vote are left out.
        of: how many there were.
        rows: rows on which answers were compared; None if tables went that can change no answer.
        changed: rows with another answer.
    """

    model: VotingModel
    tables: int
    of: int
    rows: int | None = None
    changed: int | None = None


def prune_exactly(model: AnyModel) -> Pruned:
    """Leave out tables that change the winner on no input: silent ones, and those that every class has.

    What votes for every class at once adds the same to all responses.

    Raises:
        InputError: the model has no tables that vote, or no fixed bleaching threshold.
    """
    votes = _Votes(model)
    tables = [
        Counter(key for key, by in votes.keyed if by == owner and key.fires) for owner in range(votes.classes)
    ]
    common = tables[0].copy()
    for other in tables[1:]:
        common &= other
    if common and common in tables:
        common -= Counter([next(iter(common))])  # so that each class has a table left
    surplus = [common.copy() for _ in tables]
    kept = np.ones(len(votes.keyed), dtype=np.bool_)
    for place, (key, owner) in enumerate(votes.keyed):
        kept[place] = bool(key.fires) and surplus[owner][key] <= 0
        surplus[owner][key] -= 1
    for owner, table in enumerate(tables):
        if not table:
            kept[np.flatnonzero(votes.owners == owner)[0]] = True
    return votes.pruned(kept)


def prune_on_rows(model: AnyModel, bits: NDArray[np.bool_], most: int, progress: Progress) -> Pruned:
    """Leave out what `prune_exactly` does, and then tables one by one as long as few answers change.

    Next is always the one that changes the fewest, and among these the one whose loss narrows the margins of
    the winners least.

    Args:
        model: the network.
        bits: the rows as the network's input bits, bool ``[rows, width]``.
        most: rows that may get another answer.
        progress: reports each table.

    Raises:
        InputError: as `prune_exactly`.
    """
    exact = prune_exactly(model)
    votes = _Votes(exact.model)
    answers = votes.model.evaluate(bits)
    fires = votes.on(bits).astype(np.float32)
    responses = votes.model.responses(bits)
    kept = np.ones(len(fires), dtype=np.bool_)
    changed = 0
    while True:
        progress("pruning tables", int((~kept).sum()), len(kept))
        best = _least(votes, fires, kept, responses, answers)
        if best is None or best[1] > most:
            break
        place, changed = best
        kept[place] = False
        responses[:, votes.owners[place]] -= fires[place].astype(np.int64)
    progress("pruning tables", len(kept), len(kept))
    found = votes.pruned(kept)
    return replace(found, tables=exact.tables + found.tables, of=exact.of, rows=len(bits), changed=changed)


def _least(
    votes: "_Votes",
    fires: NDArray[np.float32],
    kept: NDArray[np.bool_],
    responses: NDArray[np.int64],
    answers: NDArray[np.int64],
) -> tuple[int, int] | None:
    """The table to leave out next, and how many answers are then changed; None if each class has one left."""
    ties = votes.model.ties
    rivals = responses.copy()
    rivals[np.arange(len(rivals)), answers] = -1
    rival = winner(rivals, ties)
    wrong = winner(responses, ties) != answers
    best: tuple[float, float, int] | None = None
    for owner in range(votes.classes):
        places = np.flatnonzero(kept & (votes.owners == owner))
        if len(places) < 2:
            continue
        # A table matters on the rows on which it fires, as if its class had one vote less there.
        less = responses.copy()
        less[:, owner] -= 1
        change = (winner(less, ties) != answers).astype(np.float32) - wrong
        margin = (answers == owner).astype(np.float32) - (rival == owner)
        effects = fires[places] @ np.stack([change, margin], axis=1)
        first = np.lexsort((effects[:, 1], effects[:, 0]))[0]
        candidate = (float(effects[first, 0]), float(effects[first, 1]), int(places[first]))
        best = candidate if best is None else min(best, candidate)
    return None if best is None else (best[2], int(np.count_nonzero(wrong) + round(best[0])))


@dataclass(frozen=True)
class _Key:
    """What tells tables of different functions apart.

    Attributes:
        reads: the inputs, packed.
        fires: the addresses at which it votes, packed; empty if it never does.
    """

    reads: bytes
    fires: bytes


class _Votes:
    """The tables of a network that vote.

    Args:
        model: the network.

    Attributes:
        model: the same.
        classes: how many there are.
        owners: int64 ``[tables]``, the class that each votes for.
        keyed: what each table is, and its class.
    """

    def __init__(self, model: AnyModel) -> None:
        threshold = 1 if isinstance(model, LutGroupModel) else getattr(model, "bleaching", None)
        if not isinstance(model, VotingModel) or not isinstance(threshold, int):
            raise InputError(
                "only tables that vote, with a fixed threshold, can be pruned",
                value=model.kind,
                hint="leave --prune out",
            )
        self.model, self.threshold = model, threshold
        self.classes = len(model.classes)
        if isinstance(model, LutGroupModel):
            self.owners = model.groups.astype(np.int64)
            mapping: NDArray[np.integer] = model.layers[-1].mapping
            fires = [np.flatnonzero(table) for table in model.layers[-1].tables]
        else:
            self.owners = np.repeat(np.arange(self.classes), model.rams)
            mapping = np.concatenate([model.mapping] * (self.classes // len(model.mapping))).reshape(
                -1, model.address_bits
            )
            fires = [self._firing(model, *divmod(place, model.rams)) for place in range(len(mapping))]
        self.keyed = [
            (_Key(inputs.tobytes(), on.tobytes()), owner)
            for inputs, on, owner in zip(mapping, fires, self.owners.tolist(), strict=True)
        ]

    def on(self, bits: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Which tables vote: bits ``[rows, width]`` give bool ``[tables, rows]``."""
        model = self.model
        if isinstance(model, LutGroupModel):
            return model.node_bits(bits).T
        if isinstance(model, SparseWisardModel):
            return (model.votes(bits) >= self.threshold).reshape(len(bits), -1).T
        where = addresses(bits, model.mapping)
        fires = [
            np.take_along_axis(counts >= self.threshold, where[owner % len(where)], axis=1)
            for owner, counts in enumerate(model.counts)
        ]
        return np.concatenate(fires)

    def pruned(self, kept: NDArray[np.bool_]) -> Pruned:
        """The network with these tables alone, bool ``[tables]``."""
        model, left_out = self.model, int(np.count_nonzero(~kept))
        if isinstance(model, LutGroupModel):
            last = model.layers[-1]
            layer = LutLayer(last.mapping[kept], last.tables[kept])
            smaller: VotingModel = replace(
                model, layers=(*model.layers[:-1], layer), groups=model.groups[kept]
            )
            return Pruned(smaller, left_out, len(kept))
        by_class = kept.reshape(self.classes, model.rams)
        places = np.asarray(by_class.any(axis=0))
        places[0] |= not places.any()
        if isinstance(model, WisardModel):
            counts = np.where(by_class[..., np.newaxis], model.counts, 0)[:, places]
            return Pruned(
                replace(model, mapping=model.mapping[:, places], counts=counts), left_out, len(kept)
            )
        used = np.repeat(kept, np.diff(model.offsets))
        sizes = np.where(kept, np.diff(model.offsets), 0).reshape(by_class.shape)[:, places]
        offsets = np.concatenate([[0], np.cumsum(sizes)])
        smaller = replace(
            model,
            mapping=model.mapping[:, places],
            offsets=offsets,
            addresses=model.addresses[used],
            counts=model.counts[used],
        )
        return Pruned(smaller, left_out, len(kept))

    def _firing(self, model: WisardModel | SparseWisardModel, owner: int, ram: int) -> NDArray[np.int64]:
        """The addresses at which a RAM fires, ascending."""
        if isinstance(model, WisardModel):
            return np.flatnonzero(model.counts[owner, ram] >= self.threshold)
        stored, counts = model.contents(owner, ram)
        return stored[counts >= self.threshold].view(np.int64)
