"""Boolean resubstitution with complete don't-cares on a mapped network.

The inputs are few, so every signal is a column of its values on all cared-for codes, and the freedom of a
cell is exact: the codes on which flipping it changes no output. A cell is expressed by other signals of
the network within that freedom, so that some cell loses its last reader (Mishchenko et al., "Scalable
don't-care-based logic optimization and resynthesis", 2011, here with don't-cares of the environment).
"""

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.minimise.draft import Bits, Cell, Draft, evaluate_cell

# Signals tried first at each place of a new fanin set.
_BEAM = 4
# New fanins that one rewriting may bring in; more of them make the search slow and find little.
_MAX_ADDED = 2


def improve(draft: Draft, bits: Bits, rng: np.random.Generator, *, moves: int) -> Draft:
    """Walk through equivalent networks, never to a costlier one, and return the cheapest met.

    Args:
        draft: a network that is right on all the codes.
        bits: the cared-for codes' input bits, uint8 ``[width, codes]``.
        rng: draws the moves.
        moves: how many rewritings of a cell are tried.
    """
    current = draft.copy()
    current.sweep()
    best, best_cost = current, current.cost()
    values = current.evaluate(bits)
    luts = best_cost[0]
    for _ in range(moves):
        if luts <= len(set(current.outputs)):
            break
        trial = _rewritten(current, values, rng)
        if trial is None:
            continue
        trial.sweep()
        cost = trial.cost()
        if cost[0] > luts:
            continue
        current, luts = trial, cost[0]
        values = current.evaluate(bits)
        if cost < best_cost:
            best, best_cost = current, cost
    return best


def _rewritten(draft: Draft, values: dict[int, Bits], rng: np.random.Generator) -> Draft | None:
    """A copy in which a random cell has no reader, or is new if it is an output; None if not found."""
    cells = draft.order()
    victim = cells[rng.integers(len(cells))]
    readers = draft.readers().get(victim, [])
    if victim in draft.outputs or not readers:
        readers = [victim]
    trial, known = draft.copy(), dict(values)
    order = {name: place for place, name in enumerate(cells)}
    for reader in sorted(readers, key=order.__getitem__):
        if not _express(trial, known, reader, victim, rng):
            return None
    return trial


def _express(draft: Draft, values: dict[int, Bits], name: int, banned: int, rng: np.random.Generator) -> bool:
    """Give a cell new fanins without ``banned``, which may be the cell itself; False if none are found."""
    order = draft.order()
    above = _above(draft, order, name)
    rows = np.flatnonzero(_observable(draft, order, values, name))
    candidates = [x for x in (*range(draft.width), *order) if x not in above and x not in (name, banned)]
    candidates = [candidates[x] for x in rng.permutation(len(candidates))]
    base = [x for x in draft.cells[name].fanins if x != banned]
    if len(base) == len(draft.cells[name].fanins) or (len(base) > 1 and rng.random() < 0.5):
        del base[rng.integers(len(base))]
    columns = np.stack([values[x][rows] for x in (*base, *candidates)]) if rows.size else None
    if columns is None:
        return False
    wanted = values[name][rows].astype(np.bool_)
    added = separators(columns, wanted, len(base), min(draft.lut_inputs - len(base), _MAX_ADDED))
    if added is None:
        return False
    fanins = (*base, *(candidates[x - len(base)] for x in added))
    if set(fanins) == set(draft.cells[name].fanins):
        return False
    chosen = columns[[*range(len(base)), *added]]
    draft.cells[name] = Cell(fanins, _contents(chosen, wanted))
    for other in [x for x in order if x == name or x in above]:
        values[other] = evaluate_cell(draft.cells[other], values)
    return True


def separators(columns: Bits, wanted: NDArray[np.bool_], base: int, limit: int) -> list[int] | None:
    """Signals that, with the base, tell the rows where the function is 1 from those where it is 0.

    Args:
        columns: uint8 ``[signals, rows]``; the first ``base`` signals are given.
        wanted: bool ``[rows]``, the function.
        base: how many signals are given.
        limit: how many may be added.

    Returns:
        Indices of the added signals, possibly none; None if the search finds no set. It looks at all single
        signals and at the `_BEAM` best continuations of each.
    """
    groups = np.zeros(columns.shape[1], dtype=np.int64)
    for column in columns[:base]:
        groups = groups * 2 + column
    if base == 0 and limit <= 0:
        return None
    return _extend(columns, wanted, groups, base, limit)


def _extend(
    columns: Bits, wanted: NDArray[np.bool_], groups: NDArray[np.int64], first: int, limit: int
) -> list[int] | None:
    count = int(groups.max()) + 1
    mixed = (np.bincount(groups[wanted], minlength=count) > 0) & (
        np.bincount(groups[~wanted], minlength=count) > 0
    )
    if not mixed.any():
        return []
    if limit == 0:
        return None
    rows = np.flatnonzero(mixed[groups])
    # Rows of one group with one wanted value are neighbours, so that segment sums count them.
    keys = groups[rows] * 2 + wanted[rows]
    rows = rows[np.argsort(keys, kind="stable")]
    keys = np.sort(keys)
    starts = np.flatnonzero(np.r_[True, keys[1:] != keys[:-1]])
    sizes = np.diff(np.r_[starts, len(keys)])
    ones = np.add.reduceat(columns[first:, rows], starts, axis=1, dtype=np.int64)
    zeros = sizes - ones
    # Mixed groups have both values, so segments alternate: OFF, ON.
    clashes = (ones[:, ::2] * ones[:, 1::2] + zeros[:, ::2] * zeros[:, 1::2]).sum(axis=1)
    ranking = np.argsort(clashes, kind="stable")
    total = (sizes[::2] * sizes[1::2]).sum()
    if limit == 1:
        ranking = ranking[:1] if clashes[ranking[0]] == 0 else ranking[:0]
    for index in ranking[:_BEAM]:
        if clashes[index] == total:
            break
        signal = first + int(index)
        dense = np.unique(groups[rows], return_inverse=True)[1] * 2 + columns[signal, rows]
        rest = _extend(columns[:, rows], wanted[rows], dense, first, limit - 1)
        if rest is not None:
            return [signal, *rest]
    return None


def _contents(columns: Bits, wanted: NDArray[np.bool_]) -> Bits:
    """Contents of the LUT over the columns, uint8 ``[2**signals]``; unused addresses take the majority."""
    address = np.zeros(columns.shape[1], dtype=np.int64)
    for position, column in enumerate(columns):
        address |= column.astype(np.int64) << position
    contents = np.full(1 << len(columns), wanted.mean() > 0.5, dtype=np.uint8)
    contents[address] = wanted
    return contents


def _above(draft: Draft, order: list[int], name: int) -> set[int]:
    """The cells that depend on a cell."""
    above: set[int] = set()
    for other in order:
        if any(x == name or x in above for x in draft.cells[other].fanins):
            above.add(other)
    return above


def _observable(draft: Draft, order: list[int], values: dict[int, Bits], name: int) -> NDArray[np.bool_]:
    """The codes on which flipping a cell changes an output."""
    flipped = {name: 1 - values[name]}
    for other in order:
        cell = draft.cells[other]
        if other != name and any(x in flipped for x in cell.fanins):
            seen = {x: flipped.get(x, values[x]) for x in cell.fanins}
            changed = evaluate_cell(cell, seen)
            if not np.array_equal(changed, values[other]):
                flipped[other] = changed
    result = np.zeros(values[name].shape, dtype=np.bool_)
    for signal in draft.outputs:
        if signal in flipped:
            result |= flipped[signal] != values[signal]
    return result
