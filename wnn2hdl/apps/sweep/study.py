"""A whole sweep: the grid, its finalists, the decision and everything that is written about them."""

from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import wnn2hdl
from wnn2hdl.apps.sweep import search as searching
from wnn2hdl.apps.sweep.grid import Plan, Recipe, Trial, parse_name
from wnn2hdl.apps.sweep.pixels import PixelSets
from wnn2hdl.apps.sweep.search import Runner
from wnn2hdl.apps.sweep.selection import (
    Decision,
    Surface,
    collect,
    decide,
    finalists,
    hypervolume,
    pareto_front,
    peaks,
    surface,
)
from wnn2hdl.apps.sweep.store import Results, write_table
from wnn2hdl.apps.sweep.trial import Record
from wnn2hdl.errors import InputError
from wnn2hdl.files import output_folder, read_json, write_json
from wnn2hdl.progress import Progress

FINALIST_TRIALS = 100
"""Trials of each finalist, as in the reference design."""

IDENTITY_FILE = "sweep.json"
RESULTS_FILE = "results.journal"
SUMMARY_FILE = "summary.json"


@dataclass(frozen=True, eq=False)
class Outcome:
    """What a sweep found.

    Attributes:
        plan: the grid.
        surface: its means.
        peaks: of the surface, the most accurate first.
        decision: over the finalists; None if no trial of theirs is valid.
        finalist_trials: records of the finalists together.
        front: Pareto front of the grid's circuits.
        searched: how many trials the search made; 0 without one.
        search_front: Pareto front of the search's circuits.
        hypervolumes: of the two fronts, comparable with each other.
    """

    plan: Plan
    surface: Surface
    peaks: tuple[tuple[int, int], ...]
    decision: Decision | None
    finalist_trials: int
    front: tuple[Record, ...]
    searched: int
    search_front: tuple[Record, ...]
    hypervolumes: tuple[float, float]

    def to_json(self) -> dict[str, Any]:
        """A JSON object, without anything that differs between equal sweeps."""
        return {
            "trials": len(self.plan),
            "valid": int(self.surface.valid.sum()),
            "saturated": int(self.surface.saturated.sum()),
            "failed": int(self.surface.failed.sum()),
            "peaks": [_cell_json(self.surface, cell) for cell in self.peaks],
            "finalist_trials": self.finalist_trials,
            **_decision_json(self.decision),
            "pareto": [record.to_json() for record in self.front],
            "search": {
                "trials": self.searched,
                "pareto": [record.to_json() for record in self.search_front],
                "hypervolume": self.hypervolumes[1],
                "grid_hypervolume": self.hypervolumes[0],
            }
            if self.searched
            else None,
        }


def run_sweep(
    sets: PixelSets,
    plan: Plan,
    folder: Path,
    run: Runner,
    progress: Progress,
    *,
    finalist_trials: int = FINALIST_TRIALS,
    search: bool = False,
) -> Outcome:
    """Run the missing part of a sweep and write its tables and its summary.

    A folder belongs to one choice of pixels, seed and recipe; the ranges of address bits, RAMs and trials may
    grow, and what is there is used again.

    Args:
        sets: the pixels.
        plan: the grid.
        folder: made if it does not exist.
        run: where trials run.
        progress: called with the trials that are done.
        finalist_trials: of each finalist.
        search: also search beyond the grid, with as many trials.

    Raises:
        InputError: the folder cannot be written, holds another sweep, or is in use.
        ExtraMissingError: the search is wanted and Optuna missing.
    """
    if search:
        searching.require_optuna()  # before the work, not after it
    with output_folder(folder, "sweep"):
        _check_identity(sets, plan.recipe, folder / IDENTITY_FILE)
        outcome = _run(sets, plan, folder, run, progress, finalist_trials, search=search)
        write_json(folder / SUMMARY_FILE, outcome.to_json())
        return outcome


def _run(
    sets: PixelSets,
    plan: Plan,
    folder: Path,
    run: Runner,
    progress: Progress,
    finalist_trials: int,
    *,
    search: bool,
) -> Outcome:
    """The sweep in a folder that is ours and holds no other."""
    with grid_results(plan, folder) as results:
        _fill(results, plan, sets, run, progress, "trials")
        found = surface(plan, results)
        front = pareto_front(results)
        write_table(results, folder / "trials.csv")
    final = Plan(plan.recipe, finalists(found, plan), finalist_trials)
    with grid_results(final, folder) as results:
        _fill(results, final, sets, run, progress, "finalists")
        decision = decide(collect(results))
        write_table(results, folder / "finalists.csv")
    searched: tuple[Record, ...] = ()
    if search:
        with search_results(plan, folder) as results:
            searching.search(sets, plan.recipe, _ranges(plan), results, run, progress)
            searched = pareto_front(results)
            write_table(results, folder / "search.csv")
    most = max((record.luts or 0 for record in (*front, *searched)), default=0)
    return Outcome(
        plan,
        found,
        peaks(found),
        decision,
        len(final),
        front,
        len(plan) if search else 0,
        searched,
        (hypervolume(front, most), hypervolume(searched, most)),
    )


def circuits(plan: Plan, folder: Path, *, search: bool) -> tuple[list[int], list[float]]:
    """LUTs and accuracies of all valid circuits of a finished grid, or of its search, for a picture."""
    with search_results(plan, folder) if search else grid_results(plan, folder) as results:
        pairs = [(x.luts or 0, x.circuit_accuracy or 0.0) for x in results if x.status == "valid"]
    return [luts for luts, _ in pairs], [accuracy for _, accuracy in pairs]


def find_trial(plan: Plan, folder: Path, name: str) -> Trial:
    """A trial by its name: of the grid or a finalist from the name alone, of a search from its results.

    Raises:
        InputError: there is no such trial.
    """
    if searching.position(name) is None:
        return plan.recipe.trial(*parse_name(name))
    absent = InputError("no such trial", value=repr(name), hint="run the sweep with --beyond-grid first")
    if not (folder / IDENTITY_FILE).exists():
        raise absent
    with search_results(plan, folder) as results:
        if not results.has(name):
            raise absent
        record = results.get(name)
    return Trial(
        name,
        record.address_bits,
        record.rams,
        record.seed,
        record.bits,
        plan.recipe.bleaching,
        record.care_minimum,
    )


def grid_results(plan: Plan, folder: Path) -> Results:
    """The results of a grid, or of its finalists, in the folder of a sweep."""
    return Results(folder / RESULTS_FILE, _settings(folder), len(plan), plan.position)


def search_results(plan: Plan, folder: Path) -> Results:
    """The results of the search beside a grid."""

    def position(name: str) -> int | None:
        number = searching.position(name)
        return number if number is not None and number < len(plan) else None

    # The names of a search's trials mean something for its ranges only.
    (low_n, high_n), (low_k, high_k) = _ranges(plan)
    name = f"search-n{low_n}-{high_n}-k{low_k}-{high_k}.journal"
    return Results(folder / name, _settings(folder), len(plan), position)


def _settings(folder: Path) -> dict[str, Any]:
    return read_json(folder / IDENTITY_FILE, "the settings of a sweep")


def _fill(results: Results, plan: Plan, sets: PixelSets, run: Runner, progress: Progress, step: str) -> None:
    progress(step, len(results), len(plan))
    waiting: Iterable[Trial] = (plan.trial(position) for position in list(results.missing()))
    done: Iterator[list[Record]] = run(sets, waiting)
    for records in done:
        results.append(records)
        progress(step, len(results), len(plan))


def discard_another(sets: PixelSets, recipe: Recipe, folder: Path) -> None:
    """Remove the results in a folder if they are those of other pixels or of another recipe.

    Raises:
        ModelFileError: the settings of the sweep there are damaged.
    """
    if _differences(_identity(sets, recipe), folder / IDENTITY_FILE):
        for path in (folder / IDENTITY_FILE, *folder.glob("*.journal")):
            path.unlink()


def _check_identity(sets: PixelSets, recipe: Recipe, path: Path) -> None:
    identity = _identity(sets, recipe)
    different = _differences(identity, path)
    if different:
        raise InputError(
            f"the folder holds a sweep with a different {' and '.join(different)}",
            value=path.parent,
            hint="choose another folder, or give the same images and options to continue",
        )
    if not path.exists():
        write_json(path, identity)


def _identity(sets: PixelSets, recipe: Recipe) -> dict[str, Any]:
    """What must be the same for results to belong to one sweep."""
    return {
        "format": "wnn2hdl-sweep",
        "version": wnn2hdl.__version__,
        "pixels": sets.pixels,
        "pixel_sets": sets.digest,
        "training_images": list(sets.training_images),
        "held_out_images": list(sets.held_out_images),
        "recipe": recipe.to_json(),
    }


def _differences(identity: dict[str, Any], path: Path) -> list[str]:
    """What a sweep on disk has otherwise; nothing where there is none."""
    if not path.exists():
        return []
    known = read_json(path, "the settings of a sweep")
    return [key for key in identity if known.get(key) != identity[key]]


def _ranges(plan: Plan) -> tuple[tuple[int, int], tuple[int, int]]:
    address_bits, rams = zip(*plan.cells, strict=True)
    return (min(address_bits), max(address_bits)), (min(rams), max(rams))


def _cell_json(found: Surface, cell: tuple[int, int]) -> dict[str, Any]:
    accuracy, luts = found.at(cell)
    return {"address_bits": cell[0], "rams": cell[1], "accuracy": accuracy, "luts": luts}


def _decision_json(decision: Decision | None) -> dict[str, Any]:
    if decision is None:
        return {"finalists": [], "comparisons": [], "chosen": None, "reasons": "no valid trial", "best": None}
    return {
        "finalists": [
            {
                "address_bits": finalist.cell[0],
                "rams": finalist.cell[1],
                "valid": len(finalist.accuracies),
                "saturated": finalist.saturated,
                "accuracy": finalist.accuracy,
                "luts": sum(finalist.luts) / len(finalist.luts),
                "best": finalist.best.name,
                "best_accuracy": finalist.best.accuracy,
                "best_luts": finalist.best.luts,
            }
            for finalist in decision.finalists
        ],
        "comparisons": [
            {"first": list(one), "second": list(other), **asdict(comparison), "p_value_adjusted": p_value}
            for (one, other), (comparison, p_value) in decision.comparisons.items()
        ],
        "chosen": list(decision.chosen.cell),
        "reasons": decision.reasons,
        "best": decision.chosen.best.to_json(),
    }
