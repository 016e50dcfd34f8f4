"""Beyond the grid: a search for accurate and small circuits that also chooses pixel bits and the care set."""

from collections.abc import Callable, Iterable, Iterator
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING

from wnn2hdl.apps.sweep.grid import Recipe, Trial
from wnn2hdl.apps.sweep.pixels import PixelSets
from wnn2hdl.apps.sweep.store import Results
from wnn2hdl.apps.sweep.trial import Record
from wnn2hdl.errors import extra_needed
from wnn2hdl.progress import Progress

if TYPE_CHECKING:
    import optuna

Runner = Callable[[PixelSets, Iterable[Trial]], Iterator[list[Record]]]
"""Runs trials somewhere and yields their records as they get done."""

POPULATION = 50

SEARCHED_BITS = tuple(f"{channel}{bit}" for bit in range(7, 2, -1) for channel in "RGB")
"""Pixel bits that may be chosen, the most significant first; those below are mostly noise."""

MAX_BITS = 12
"""Bits of a code, as in the grid; of more the most significant are kept."""

CARE_MINIMUM = (1, 10_000)


def position(name: str) -> int | None:
    """The number in the name of a search's trial: 17 of ``s17``; None of any other name."""
    number = name.removeprefix("s")
    return int(number) if name.startswith("s") and number.isdecimal() else None


def require_optuna() -> ModuleType:
    """Optuna, the library that searches.

    Raises:
        ExtraMissingError: it is not installed.
    """
    with extra_needed("search", "the search needs Optuna"):
        return import_module("optuna")


def search(
    sets: PixelSets,
    recipe: Recipe,
    cells: tuple[tuple[int, int], tuple[int, int]],
    results: Results,
    run: Runner,
    progress: Progress,
) -> None:
    """NSGA-II over address bits, RAMs, pixel bits and the care threshold, for circuit accuracy and LUTs.

    Generations depend on the seed and on the outcomes before them only, so a search that was interrupted goes
    on as if it had not been: known outcomes are reported to it again, not computed.

    Args:
        sets: the pixels.
        recipe: seed and bleaching; in exact mode no care threshold is searched.
        cells: lowest and highest number of address bits, and of RAMs.
        results: filled up to its size.
        run: where trials run.
        progress: called with each generation.

    Raises:
        ExtraMissingError: Optuna is not installed.
    """
    optuna = require_optuna()
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    sampler = optuna.samplers.NSGAIISampler(population_size=POPULATION, seed=recipe.seed)
    study = optuna.create_study(directions=["maximize", "minimize"], sampler=sampler)
    progress("searching", 0, results.size)
    for start in range(0, results.size, POPULATION):
        asked = [study.ask() for _ in range(min(POPULATION, results.size - start))]
        trials = [_trial(suggestion, recipe, cells) for suggestion in asked]
        for records in run(sets, [trial for trial in trials if not results.has(trial.name)]):
            results.append(records)
        for suggestion, trial in zip(asked, trials, strict=True):
            record = results.get(trial.name)
            if record.status == "valid":
                assert record.circuit_accuracy is not None
                assert record.luts is not None
                study.tell(suggestion, (record.circuit_accuracy, record.luts))
            else:
                study.tell(suggestion, state=optuna.trial.TrialState.FAIL)
        progress("searching", start + len(asked), results.size)


def _trial(
    suggestion: "optuna.Trial", recipe: Recipe, cells: tuple[tuple[int, int], tuple[int, int]]
) -> Trial:
    chosen = [name for name in SEARCHED_BITS if suggestion.suggest_int(name, 0, 1)] or [SEARCHED_BITS[0]]
    bits = tuple(sorted(chosen[:MAX_BITS], key=lambda name: ("RGB".index(name[0]), -int(name[1]))))
    (low_n, high_n), (low_k, high_k) = cells
    care = None
    if recipe.care_minimum is not None:
        care = suggestion.suggest_int("care_minimum", *CARE_MINIMUM, log=True)
    return Trial(
        f"s{suggestion.number}",
        min(suggestion.suggest_int("n", low_n, high_n), len(bits)),
        suggestion.suggest_int("k", low_k, high_k),
        recipe.mapping_seed(suggestion.number),
        bits,
        recipe.bleaching,
        care,
    )
