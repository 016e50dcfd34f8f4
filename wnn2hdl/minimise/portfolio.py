"""LUT mapping as a stage: many ways to map a table, and the best network that is proved right."""

import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from importlib.metadata import version

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import CheckError, InputError
from wnn2hdl.ir import LUT_INPUTS, LutNetwork, TruthTable, codes_to_bits
from wnn2hdl.minimise.check import require_equal, wrong_codes
from wnn2hdl.minimise.decompose import decompose, mux_tree
from wnn2hdl.minimise.draft import Bits, Draft
from wnn2hdl.minimise.improve import improve
from wnn2hdl.minimise.recipes import (
    care_candidates,
    network_candidates,
    truth_candidates,
    two_lut_candidates,
)
from wnn2hdl.minimise.support import minimum_supports
from wnn2hdl.tools import abc_version

EFFORTS = (0, 1, 2, 3)

# Inputs, after support reduction, up to which functions are decomposed: time doubles and more with each
# input. Wider ones are left to ABC, with a multiplexer tree for the case that it gives up.
_MAX_DECOMPOSED = (12, 13, 14, 14)
# Searches at each effort: how many ways are carried through at each level of the decomposition.
_BREADTHS: tuple[tuple[tuple[int, ...], ...], ...] = (
    ((),),
    ((), (4,)),
    ((), (4,), (4, 2, 2)),
    ((), (4,), (4, 2, 2), (8, 4, 2), (6, 3), (16,), (8, 4, 2)),
)
# Resubstitution moves at each effort, for each of the best networks found; a move takes time with the cells
# and the codes, so that large networks get fewer: the budget is codes times cells times moves.
_MOVES = (0, 100, 400, 3000)
_MOVE_BUDGET = (0, 10_000_000, 60_000_000, 1_000_000_000)
_IMPROVED = 3


@dataclass(frozen=True)
class Candidate:
    """One network that was tried.

    Attributes:
        method: how it was found.
        luts: its LUTs; None if it was wrong and therefore thrown away.
    """

    method: str
    luts: int | None


@dataclass(frozen=True)
class Mapping:
    """A mapped table.

    Attributes:
        network: equal to the table on every cared-for code.
        method: how the winner was found.
        seconds: wall-clock time of the whole search, which two equal mappings need not share.
        candidates: all networks tried, in order.
    """

    network: LutNetwork
    method: str
    seconds: float = field(compare=False)
    candidates: tuple[Candidate, ...]


def generators() -> dict[str, str]:
    """Everything outside of this package that decides what a table is mapped to, each with its version.

    NumPy draws the random numbers and PyEDA's espresso makes the covers. ABC and espresso also sort with
    the C library's ``qsort``, and one of ABC's commands draws from its ``rand``: another C library may settle
    ties another way.

    Raises:
        ToolError: ABC is missing.
    """
    return {"numpy": version("numpy"), "pyeda": version("pyeda"), "ABC": f"of {abc_version()}"}


def map_luts(
    table: TruthTable,
    *,
    effort: int = 1,
    lut_inputs: int = LUT_INPUTS,
    progress: Callable[[str, int], None] | None = None,
) -> Mapping:
    """Map a table to the fewest LUTs that the effort finds; then fewest levels, then fewest multiplexers.

    The result depends on the arguments only, and on the versions of `generators`.

    Args:
        table: 1 to 20 inputs, any number of outputs.
        effort: 0 for sweeps over thousands of tables, 1 for everyday use, 2 and 3 for final results.
        lut_inputs: of a LUT, 4 to 6; dedicated multiplexers are used behind LUTs of six only.
        progress: called with the method and the LUTs of the best network so far, each time it gets better.

    Raises:
        InputError: there is no such effort.
        CheckError: no way led to a right network.
        ToolError: ABC is needed and missing.
        ToolStoppedError: ABC was killed, or took an hour for one recipe.
    """
    if effort not in EFFORTS:
        raise InputError("no such effort", value=effort, hint="give 0, 1, 2 or 3")
    started = time.perf_counter()
    supports = [minimum_supports(x & table.care, ~x & table.care)[0].bit_count() for x in table.values.T]
    search = _Search(table, fewest_luts(supports, lut_inputs), progress)
    search.offer_all(_decomposed(table, max(supports, default=0), effort, lut_inputs))
    if not search.done and effort > 0 and search.best is not None and len(table.outputs) == 1:
        search.offer_all(two_lut_candidates(_filled(table, search.best)[:, 0], lut_inputs))
    if not search.done and (effort > 0 or search.method == "multiplexer tree"):
        care_values = table.values & table.care[:, np.newaxis]
        search.offer_all(truth_candidates(care_values, effort, lut_inputs))
        search.offer_all(care_candidates(table.values, table.care, effort, lut_inputs))
    if not search.done and effort > 1 and search.best is not None:
        if not table.care.all():
            search.offer_all(truth_candidates(_filled(table, search.best), effort - 1, lut_inputs))
        search.offer_all(network_candidates(search.best))
    if not search.done and _MOVES[effort]:
        search.offer_all(_improved(search.leaders(), table, effort))
    if search.best is None:
        raise CheckError("no way of mapping gave a right network", value=f"{len(table.inputs)} inputs")
    network = search.best.network(table.inputs, table.outputs)
    require_equal(table, network, "the LUT network")
    return Mapping(network, search.method, time.perf_counter() - started, tuple(search.candidates))


class _Search:
    """Keeps the right networks and the best of them."""

    def __init__(self, table: TruthTable, bound: int, progress: Callable[[str, int], None] | None) -> None:
        self.table = table
        self.progress = progress
        self.candidates: list[Candidate] = []
        self.method = ""
        self.right: list[tuple[tuple[int, int, int], Draft]] = []
        self.bound = bound

    @property
    def best(self) -> Draft | None:
        return self.right[0][1] if self.right else None

    @property
    def done(self) -> bool:
        """Whether no network can have fewer LUTs than the best."""
        return bool(self.right) and self.right[0][0][0] <= self.bound

    def leaders(self) -> list[Draft]:
        return [draft for _, draft in self.right[:_IMPROVED]]

    def offer_all(self, found: Iterable[tuple[str, Draft]]) -> None:
        for method, draft in found:
            self.offer(method, draft)
            if self.done:
                return

    def offer(self, method: str, draft: Draft) -> None:
        draft.sweep()
        if wrong_codes(self.table, draft.network(self.table.inputs, self.table.outputs)).size:
            self.candidates.append(Candidate(method, None))
            return
        cost = draft.cost()
        self.candidates.append(Candidate(method, cost[0]))
        is_best = not self.right or cost < self.right[0][0]
        self.right.append((cost, draft))
        self.right.sort(key=lambda pair: pair[0])
        if is_best:
            self.method = method
            if self.progress is not None:
                self.progress(method, cost[0])


def fewest_luts(supports: Sequence[int], lut_inputs: int = LUT_INPUTS) -> int:
    """A lower bound: one LUT for an output of two inputs or more, two for one of more than a LUT has.

    Outputs may share cells, so only the one that needs most is counted.

    Args:
        supports: how many inputs each output needs.
        lut_inputs: of a LUT.
    """
    return max((0 if size < 2 else 1 if size <= lut_inputs else 2 for size in supports), default=0)


def _decomposed(table: TruthTable, widest: int, effort: int, lut_inputs: int) -> Iterator[tuple[str, Draft]]:
    functions = [(column & table.care, ~column & table.care) for column in table.values.T]
    everything = tuple(range(len(table.inputs)))
    if widest > _MAX_DECOMPOSED[effort]:
        draft = Draft(len(table.inputs), lut_inputs=lut_inputs)
        draft.outputs = [mux_tree(draft, everything, on, off) for on, off in functions]
        yield "multiplexer tree", draft
        return
    for seed, breadth in enumerate(_BREADTHS[effort]):
        rng = np.random.default_rng(seed)
        draft = Draft(len(table.inputs), lut_inputs=lut_inputs)
        draft.outputs = [decompose(draft, everything, on, off, rng, breadth) for on, off in functions]
        yield "decomposition" + "".join(f" {x}" for x in breadth), draft


def _filled(table: TruthTable, draft: Draft) -> NDArray[np.bool_]:
    """The values that the draft gives all codes, don't-cares as well."""
    return draft.network(table.inputs, table.outputs).evaluate(np.arange(len(table.care)))


def _improved(drafts: list[Draft], table: TruthTable, effort: int) -> Iterator[tuple[str, Draft]]:
    bits = _bits(table, np.flatnonzero(table.care))
    for draft in drafts:
        size = max(len(draft.cells), 1) * bits.shape[1]
        moves = min(_MOVES[effort], _MOVE_BUDGET[effort] // size)
        if moves:
            yield "resubstitution", improve(draft, bits, np.random.default_rng(0), moves=moves)


def _bits(table: TruthTable, codes: NDArray[np.int64]) -> Bits:
    return np.ascontiguousarray(codes_to_bits(codes, len(table.inputs)).T).astype(np.uint8)
