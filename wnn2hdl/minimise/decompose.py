"""Functional decomposition into LUTs under don't-cares: Ashenhurst, Curtis, Roth and Karp, and Shannon.

A *bound set* B of at most as many signals as a LUT has inputs is replaced by ``t`` wires, each one LUT over
B. Two assignments of B (columns of the decomposition chart) may share the wires' value if no assignment of
the other signals makes one ON and the other OFF: the fewest values are a colouring of the incompatible
columns (Roth and Karp 1962). A signal of B may be read by the rest as well (non-disjoint decomposition):
columns that it distinguishes need no other colour.
"""

import functools
import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import LUT_INPUTS
from wnn2hdl.minimise.draft import ONE, ZERO, Bits, Draft
from wnn2hdl.minimise.support import Flags, members, minimum_supports, restrict

# Wider functions have too many bound sets to look at all of them; this many are drawn.
_BOUND_SETS = 1000
# Bound sets with the best lower bound of colours that are then coloured.
_COLOURED = 40


@dataclass(frozen=True)
class _Choice:
    """One way to take a function apart, with the LUTs it is expected to cost."""

    cost: float
    bound: tuple[int, ...] = ()
    shared: tuple[int, ...] = ()
    colours: tuple[int, ...] = ()
    select: int = -1


def decompose(
    draft: Draft,
    signals: tuple[int, ...],
    on: Flags,
    off: Flags,
    rng: np.random.Generator,
    breadth: tuple[int, ...] = (),
) -> int:
    """Add cells for one incompletely specified function to a draft.

    Args:
        draft: receives the cells.
        signals: the function's variables; the first is the least significant bit of the code.
        on: bool ``[2**len(signals)]``, codes where the function is 1.
        off: bool ``[2**len(signals)]``, codes where it is 0; elsewhere it is free.
        rng: decides between equally good ways, so that repeated calls find different networks.
        breadth: how many ways are carried through to the end at each level, top first, before the cheapest is
            kept; beyond its length the way with the least expected cost is taken.

    Returns:
        The signal that carries the function.
    """
    if not on.any():
        return ZERO
    if not off.any():
        return ONE
    supports = minimum_supports(on, off)
    support = supports[rng.integers(len(supports))]
    signals = tuple(signals[position] for position in members(support))
    on, off = restrict(on, support), restrict(off, support)
    if len(signals) <= draft.lut_inputs:
        return draft.add(signals, _complete(on, off))
    choices = _choices(on, off, rng, draft.lut_inputs)[: breadth[0] if breadth else 1]
    if len(choices) == 1:
        return _apply(draft, signals, on, off, choices[0], rng, breadth[1:])
    best: tuple[tuple[int, int, int], Draft] | None = None
    for choice in choices:
        trial = draft.copy()
        trial.outputs = [_apply(trial, signals, on, off, choice, rng, breadth[1:])]
        cost = trial.cost()
        if best is None or cost < best[0]:
            best = cost, trial
    assert best is not None
    draft.adopt(best[1])
    return best[1].outputs[0]


def mux_tree(draft: Draft, signals: tuple[int, ...], on: Flags, off: Flags) -> int:
    """As `decompose`, at any width: full LUTs, selected by the other signals without a search."""
    if not on.any():
        return ZERO
    if not off.any():
        return ONE
    support = minimum_supports(on, off)[0]
    signals = tuple(signals[position] for position in members(support))
    on, off = restrict(on, support), restrict(off, support)
    if len(signals) <= draft.lut_inputs:
        return draft.add(signals, _complete(on, off))
    select = len(signals) - 1
    low, high = (mux_tree(draft, signals[:-1], *_cofactors(on, off, select, value)) for value in (0, 1))
    return draft.add_mux(low, high, signals[select])


def _apply(
    draft: Draft,
    signals: tuple[int, ...],
    on: Flags,
    off: Flags,
    choice: _Choice,
    rng: np.random.Generator,
    breadth: tuple[int, ...],
) -> int:
    if choice.select < 0:
        return _replace_bound_set(draft, signals, on, off, choice, rng, breadth)
    rest = tuple(x for position, x in enumerate(signals) if position != choice.select)
    low, high = (
        decompose(draft, rest, *_cofactors(on, off, choice.select, value), rng, breadth) for value in (0, 1)
    )
    return draft.add_mux(low, high, signals[choice.select])


def _replace_bound_set(
    draft: Draft,
    signals: tuple[int, ...],
    on: Flags,
    off: Flags,
    choice: _Choice,
    rng: np.random.Generator,
    breadth: tuple[int, ...],
) -> int:
    width = len(signals)
    bound, shared = choice.bound, choice.shared
    free = tuple(x for x in range(width) if x not in bound)
    wires = max(max(choice.colours), 1).bit_length()
    codes = rng.permutation(1 << wires)[: max(choice.colours) + 1]
    values = np.array([codes[colour] for colour in choice.colours])
    names = [
        draft.add(tuple(signals[x] for x in bound), (values >> wire & 1).astype(np.uint8))
        for wire in range(wires)
    ]
    # The rest is a function of the free signals, then the shared ones, then the wires.
    position_of = {x: position for position, x in enumerate(bound)}
    columns = np.arange(1 << len(bound))
    rows = values << len(shared)
    for position, x in enumerate(shared):
        rows |= (columns >> position_of[x] & 1) << position
    chart_on, chart_off = (_chart(flags, bound, free) for flags in (on, off))
    shape = (1 << (len(shared) + wires), 1 << len(free))
    rest_on, rest_off = np.zeros(shape, dtype=np.bool_), np.zeros(shape, dtype=np.bool_)
    for column, row in enumerate(rows):
        rest_on[row] |= chart_on[column]
        rest_off[row] |= chart_off[column]
    rest = (*(signals[x] for x in free), *(signals[x] for x in shared), *names)
    return decompose(draft, rest, rest_on.reshape(-1), rest_off.reshape(-1), rng, breadth)


def _choices(on: Flags, off: Flags, rng: np.random.Generator, lut_inputs: int) -> list[_Choice]:
    """Ways to take the function apart, the least expected cost first."""
    shannon = _shannon_choices(on, off, lut_inputs)
    bound = _bound_set_choices(on, off, rng, min(choice.cost for choice in shannon), lut_inputs)
    # Equal bound sets are tried in random order; equal Shannon splits in a fixed one, since both halves
    # should select by the same signals for their multiplexers to merge.
    noise = [*rng.uniform(0.99, 1.0, len(bound)), *np.ones(len(shannon))]
    ranked = sorted(
        zip([*bound, *shannon], noise, strict=True), key=lambda pair: pair[0].cost * float(pair[1])
    )
    return [choice for choice, _ in ranked]


def _bound_set_choices(
    on: Flags, off: Flags, rng: np.random.Generator, limit: float, lut_inputs: int
) -> list[_Choice]:
    """Bound sets that may cost no more than ``limit`` and a little."""
    width = on.shape[0].bit_length() - 1
    choices: list[_Choice] = []
    for size in range(lut_inputs, lut_inputs - 3, -1):
        # One wire is the least a bound set leaves.
        if size >= width or 1 + expected_luts(width - size + 1, lut_inputs) > limit:
            continue
        bounds = _bound_sets(width, size)
        if len(bounds) << width > _BOUND_SETS << 12:
            keep = max((_BOUND_SETS << 12) >> width, 8)
            bounds = tuple(bounds[x] for x in rng.choice(len(bounds), min(keep, len(bounds)), replace=False))
        conflicts = _conflicts(on, off, bounds)
        choices += _coloured(conflicts, bounds, (), width, limit, lut_inputs)
        if size == lut_inputs:
            for position in range(size):
                columns = np.arange(1 << size) >> position & 1
                same = columns[:, np.newaxis] == columns
                choices += _coloured(conflicts & same, bounds, (position,), width, limit, lut_inputs)
    return choices


def _coloured(
    conflicts: NDArray[np.bool_],
    bounds: tuple[tuple[int, ...], ...],
    shared: tuple[int, ...],
    width: int,
    limit: float,
    lut_inputs: int,
) -> list[_Choice]:
    cliques = _clique_sizes(conflicts)
    removed = len(bounds[0]) - len(shared)
    promising = np.argsort(cliques, kind="stable")[:_COLOURED]
    bounded = np.array([_expected(int(clique), removed, width, lut_inputs) for clique in cliques[promising]])
    promising = promising[bounded <= limit]
    choices = []
    for index, colours in zip(promising, _colour(conflicts[promising]), strict=True):
        cost = _expected(int(colours.max()) + 1, removed, width, lut_inputs)
        if cost < np.inf:
            bound = bounds[index]
            choices.append(_Choice(cost, bound, tuple(bound[x] for x in shared), tuple(colours.tolist())))
    return choices


def _expected(colours: int, removed: int, width: int, lut_inputs: int) -> float:
    """LUTs that a bound set of this many colours is expected to cost; infinite if it gains nothing."""
    wires = max(colours - 1, 1).bit_length()
    return wires + expected_luts(width - removed + wires, lut_inputs) if wires < removed else np.inf


def _shannon_choices(on: Flags, off: Flags, lut_inputs: int) -> list[_Choice]:
    width = on.shape[0].bit_length() - 1
    choices = []
    for select in range(width):
        sizes = []
        for value in (0, 1):
            one, other = _cofactors(on, off, select, value)
            sizes.append(minimum_supports(one, other)[0].bit_count())
        # Two single LUTs of six inputs, and two functions of two such, meet in a dedicated multiplexer.
        free = sizes[0] == sizes[1] and lut_inputs == LUT_INPUTS <= sizes[0] <= LUT_INPUTS + 1
        halves = sum(expected_luts(size, lut_inputs) for size in sizes)
        choices.append(_Choice(halves + (not free), select=select))
    return choices


def expected_luts(inputs: int, lut_inputs: int = LUT_INPUTS) -> float:
    """LUTs of a Shannon tree for an arbitrary function.

    With LUTs of six inputs 1, 2, 4, 8.5, 17, 34, 68 for 6 to 12 inputs; otherwise each multiplexer is a LUT.
    """
    if inputs <= lut_inputs:
        return 1.0 if inputs > 1 else 0.0
    leaves = 1 << (inputs - lut_inputs)
    if lut_inputs != LUT_INPUTS:
        return 2.0 * leaves - 1
    return leaves + leaves // 8 * 0.5 if leaves > 4 else float(leaves)


def _complete(on: Flags, off: Flags) -> Bits:
    """LUT contents; a free entry copies its nearest specified neighbour, which keeps the function simple."""
    values = np.where(on, 1, np.where(off, -1, 0)).astype(np.int64)
    width = on.shape[0].bit_length() - 1
    while not values.all():
        votes = np.zeros_like(values)
        for position in range(width):
            votes += values[np.arange(len(values)) ^ 1 << position]
        reached = (values == 0) & (votes != 0)
        values[reached] = np.sign(votes[reached])
        if not reached.any():
            values[values == 0] = -1
    return (values > 0).astype(np.uint8)


def _cofactors(on: Flags, off: Flags, select: int, value: int) -> tuple[Flags, Flags]:
    one = on.reshape(-1, 2, 1 << select)[:, value].reshape(-1)
    other = off.reshape(-1, 2, 1 << select)[:, value].reshape(-1)
    return one, other


def _chart(flags: Flags, bound: tuple[int, ...], free: tuple[int, ...]) -> Flags:
    """The decomposition chart, bool ``[2**len(bound), 2**len(free)]``."""
    width = len(bound) + len(free)
    axes = [width - 1 - x for x in (*reversed(bound), *reversed(free))]
    return flags.reshape((2,) * width).transpose(axes).reshape(1 << len(bound), -1)


def _conflicts(on: Flags, off: Flags, bounds: tuple[tuple[int, ...], ...]) -> NDArray[np.bool_]:
    """Incompatible columns for each bound set, bool ``[sets, 2**size, 2**size]``."""
    width = on.shape[0].bit_length() - 1
    size = len(bounds[0])
    result = np.empty((len(bounds), 1 << size, 1 << size), dtype=np.bool_)
    for index, bound in enumerate(bounds):
        free = tuple(x for x in range(width) if x not in bound)
        one = _chart(on, bound, free).astype(np.float32)
        other = _chart(off, bound, free).astype(np.float32)
        # Counts of common codes, at most 2**14: exact in any order of summation, so on any machine.
        meets = one @ other.T > 0
        result[index] = meets | meets.T
    return result


def _clique_sizes(conflicts: NDArray[np.bool_]) -> NDArray[np.int64]:
    """A lower bound of the colours of each graph: the clique that greedy choice by degree finds."""
    allowed = np.ones(conflicts.shape[:2], dtype=np.bool_)
    degrees = conflicts.sum(axis=2) + 1
    sizes = np.zeros(len(conflicts), dtype=np.int64)
    every = np.arange(len(conflicts))
    while allowed.any():
        picked = np.argmax(np.where(allowed, degrees, 0), axis=1)
        sizes += allowed.any(axis=1)
        allowed &= conflicts[every, picked]
    return sizes


def _colour(conflicts: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Colours of the vertices of each graph, int64 ``[graphs, vertices]``, by DSATUR (Brelaz 1979).

    DSATUR is exact for bipartite graphs, so a decomposition with one wire is never missed.
    """
    graphs, count = conflicts.shape[:2]
    every = np.arange(graphs)
    forbidden = np.zeros((graphs, count, count), dtype=np.bool_)  # [graph, colour, vertex]
    priority = conflicts.sum(axis=2)
    colours = np.zeros((graphs, count), dtype=np.int64)
    for _ in range(count):
        vertex = priority.argmax(axis=1)
        colour = forbidden[every, :, vertex].argmin(axis=1)
        colours[every, vertex] = colour
        newly = conflicts[every, vertex] & ~forbidden[every, colour]
        forbidden[every, colour] |= newly
        priority += newly * count
        priority[every, vertex] = -(count**3)
    return colours


@functools.cache
def _bound_sets(width: int, size: int) -> tuple[tuple[int, ...], ...]:
    return tuple(itertools.combinations(range(width), size))
