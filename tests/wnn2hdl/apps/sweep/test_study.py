import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from wnn2hdl.apps.sweep.grid import Plan, Trial, grid
from wnn2hdl.apps.sweep.pixels import PixelSets
from wnn2hdl.apps.sweep.study import Outcome, circuits, discard_another, find_trial, run_sweep
from wnn2hdl.apps.sweep.trial import Record, answers_digest, rebuild, run_trials
from wnn2hdl.errors import InputError
from wnn2hdl.lower.table import pixel_table

TABLES = ("trials.csv", "finalists.csv", "search.csv", "summary.json")


def here(sets: PixelSets, trials: Iterable[Trial]) -> Iterator[list[Record]]:
    """Trials one by one in this process."""
    for trial in trials:
        yield run_trials(sets, [trial])


def swept(sets: PixelSets, plan: Plan, folder: Path, *, search: bool = False, run: Any = here) -> Outcome:
    return run_sweep(sets, plan, folder, run, lambda *_: None, finalist_trials=12, search=search)


def tables(folder: Path) -> dict[str, bytes]:
    return {name: (folder / name).read_bytes() for name in TABLES if (folder / name).exists()}


@pytest.fixture(scope="module")
def unbroken(sets: PixelSets, plan: Plan, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a sweep with a search that nothing disturbed."""
    pytest.importorskip("optuna")
    folder = tmp_path_factory.mktemp("unbroken")
    swept(sets, plan, folder, search=True)
    return folder


def test_the_outcome_sums_up_the_grid(sets: PixelSets, plan: Plan, unbroken: Path) -> None:
    outcome = swept(sets, plan, unbroken, search=True)
    data = outcome.to_json()
    assert data["trials"] == 18
    assert data["valid"] + data["saturated"] + data["failed"] == 18
    assert data["finalist_trials"] == 12 * len(data["finalists"])
    assert data["search"]["trials"] == 18
    assert [data["best"]["address_bits"], data["best"]["rams"]] == data["chosen"]
    luts, accuracies = circuits(plan, unbroken, search=False)
    assert len(luts) == len(accuracies) == data["valid"]
    assert max(accuracies) == outcome.front[-1].circuit_accuracy


def test_a_second_run_computes_nothing(sets: PixelSets, plan: Plan, unbroken: Path) -> None:
    def idle(sets: PixelSets, trials: Iterable[Trial]) -> Iterator[list[Record]]:
        assert not list(trials)
        return iter(())

    before = tables(unbroken)
    assert set(before) == set(TABLES)
    swept(sets, plan, unbroken, search=True, run=idle)
    assert tables(unbroken) == before


@pytest.mark.parametrize("after", [0, 7, 20, 35])
def test_a_sweep_stopped_anywhere_ends_with_the_same_tables(
    sets: PixelSets, plan: Plan, unbroken: Path, tmp_path: Path, after: int
) -> None:
    left = after

    def stopping(sets: PixelSets, trials: Iterable[Trial]) -> Iterator[list[Record]]:
        nonlocal left
        for trial in trials:
            if not left:
                raise KeyboardInterrupt
            left -= 1
            yield run_trials(sets, [trial])

    with pytest.raises(KeyboardInterrupt):
        swept(sets, plan, tmp_path, search=True, run=stopping)
    swept(sets, plan, tmp_path, search=True)
    assert tables(tmp_path) == tables(unbroken)


def test_trials_that_end_in_another_order_give_the_same_tables(
    sets: PixelSets, plan: Plan, unbroken: Path, tmp_path: Path
) -> None:
    def backwards(sets: PixelSets, trials: Iterable[Trial]) -> Iterator[list[Record]]:
        yield from here(sets, reversed(list(trials)))

    swept(sets, plan, tmp_path, search=True, run=backwards)
    assert tables(tmp_path) == tables(unbroken)


@pytest.mark.slow
def test_a_sweep_killed_by_force_goes_on_where_it_stopped(tmp_path: Path) -> None:
    program = "import sys; from wnn2hdl.cli import main, sweep; sys.exit(main())"
    options = ["sweep", "--address-bits", "2..3", "--rams", "2..9", "--trials", "6", "-o"]
    command = [sys.executable, "-c", program, *options]

    def run(folder: Path) -> "subprocess.Popen[bytes]":
        return subprocess.Popen([*command, str(folder)], stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)

    killed, unbroken = tmp_path / "killed", tmp_path / "unbroken"
    process = run(killed)
    results = killed / "results.journal"
    deadline = time.monotonic() + 120
    while not (results.exists() and results.stat().st_size > 8_000) and time.monotonic() < deadline:
        time.sleep(0.02)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    kept = results.read_bytes()
    assert len(kept) > 8_000
    assert not (killed / "trials.csv").exists()

    assert run(killed).wait() == 0
    assert results.read_bytes().startswith(kept[: kept.rindex(b"\n") + 1])
    assert run(unbroken).wait() == 0
    assert tables(killed) == tables(unbroken)


def test_a_wider_grid_goes_on_in_the_same_folder(sets: PixelSets, plan: Plan, tmp_path: Path) -> None:
    swept(sets, plan, tmp_path)
    computed: list[str] = []

    def noting(sets: PixelSets, trials: Iterable[Trial]) -> Iterator[list[Record]]:
        for records in here(sets, trials):
            computed.extend(record.name for record in records)
            yield records

    wider = grid(plan.recipe, (2, 3, 4), (3, 5, 6), trials=3)
    swept(sets, wider, tmp_path, run=noting)
    assert [name for name in computed if "-k5-" in name and int(name[-1]) < 3] != []
    assert not [name for name in computed if "-k5-" not in name and name[-3:] in ("-t0", "-t1", "-t2")]


def test_a_folder_of_another_sweep_is_refused(sets: PixelSets, plan: Plan, tmp_path: Path) -> None:
    swept(sets, plan, tmp_path)
    other = replace(plan, recipe=replace(plan.recipe, seed=6))
    with pytest.raises(InputError, match="the folder holds a sweep with a different recipe"):
        swept(sets, other, tmp_path)


def test_a_sweep_begins_anew_where_another_was_discarded(
    sets: PixelSets, plan: Plan, unbroken: Path, tmp_path: Path
) -> None:
    swept(sets, replace(plan, recipe=replace(plan.recipe, seed=6)), tmp_path, search=True)
    discard_another(sets, plan.recipe, tmp_path)
    swept(sets, plan, tmp_path, search=True)
    assert tables(tmp_path) == tables(unbroken)


def test_a_sweep_of_the_same_settings_is_kept(sets: PixelSets, plan: Plan, tmp_path: Path) -> None:
    discard_another(sets, plan.recipe, tmp_path / "none")
    swept(sets, plan, tmp_path)
    results = tmp_path / "results.journal"
    before = results.read_bytes()
    discard_another(sets, plan.recipe, tmp_path)
    assert results.read_bytes() == before


def test_a_sweep_of_failures_ends_without_a_decision(sets: PixelSets, plan: Plan, tmp_path: Path) -> None:
    recipe = replace(plan.recipe, bits=("R7",))
    outcome = swept(sets, grid(recipe, [2, 3], [2], trials=2), tmp_path)
    assert outcome.decision is None
    assert outcome.to_json()["failed"] == 4
    assert (tmp_path / "trials.csv").read_text().count("a RAM has more address bits") == 4


def test_any_trial_is_found_and_rebuilt_exactly(sets: PixelSets, plan: Plan, unbroken: Path) -> None:
    outcome = swept(sets, plan, unbroken, search=True)
    assert outcome.decision is not None
    for record in (*outcome.front, *outcome.search_front, outcome.decision.chosen.best):
        model = rebuild(sets, find_trial(plan, unbroken, record.name))
        assert answers_digest(pixel_table(model)) == record.answers
        assert model.bleaching == record.bleaching


@pytest.mark.parametrize("name", ["s18", "s999", "t3", "n4-k16"])
def test_a_trial_that_is_none_is_refused(plan: Plan, unbroken: Path, name: str) -> None:
    with pytest.raises(InputError, match="no such trial"):
        find_trial(plan, unbroken, name)
