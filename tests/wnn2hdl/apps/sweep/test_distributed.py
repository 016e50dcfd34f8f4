import os
import signal
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import pytest

from wnn2hdl.apps.sweep.distributed import run_distributed
from wnn2hdl.apps.sweep.grid import Plan, Trial
from wnn2hdl.apps.sweep.pixels import PixelSets
from wnn2hdl.apps.sweep.store import Results, write_table
from wnn2hdl.apps.sweep.trial import Record, run_trials


def table(path: Path, plan: Plan, records: Iterable[list[Record]]) -> bytes:
    """The table of all records, after checking that each trial is there once."""
    with Results(path.with_suffix(".journal"), {}, len(plan), plan.position) as results:
        for some in records:
            results.append(some)
        assert len(results) == len(plan)
        write_table(results, path)
    assert len(path.with_suffix(".journal").read_bytes().splitlines()) == 1 + 2 * len(plan)
    return path.read_bytes()


def trials(plan: Plan) -> Iterator[Trial]:
    return (plan.trial(position) for position in range(len(plan)))


@pytest.mark.slow
def test_a_killed_worker_changes_nothing(cluster: Any, sets: PixelSets, plan: Plan, tmp_path: Path) -> None:
    first = next(iter(cluster.workers.values())).pid

    def with_a_murder() -> Iterator[list[Record]]:
        for number, records in enumerate(
            run_distributed(cluster.scheduler_address, sets, trials(plan), batch=2)
        ):
            if number == 2:
                os.kill(first, signal.SIGKILL)
            yield records

    ours = table(tmp_path / "cluster.csv", plan, with_a_murder())
    with pytest.raises(ProcessLookupError):
        os.kill(first, 0)
    assert ours == table(tmp_path / "alone.csv", plan, [run_trials(sets, trials(plan))])


@pytest.mark.slow
def test_a_trial_that_kills_its_worker_is_recorded_and_does_not_stop_the_others(
    cluster: Any, sets: PixelSets, plan: Plan, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("wnn2hdl.apps.sweep.distributed.run_trials", _die_of_the_second)
    chosen = [plan.trial(position) for position in range(4)]
    found = [
        record
        for records in run_distributed(cluster.scheduler_address, sets, chosen, batch=2)
        for record in records
    ]
    outcomes = {record.name: record for record in found}
    assert sorted(outcomes) == sorted(trial.name for trial in chosen)
    assert outcomes[chosen[1].name].status == "failed"
    assert outcomes[chosen[1].name].error == "RuntimeError: every worker that ran this trial died"
    others = [outcomes[x.name] for x in (chosen[0], chosen[2], chosen[3])]
    assert others == run_trials(sets, [chosen[0], chosen[2], chosen[3]])


def _die_of_the_second(sets: PixelSets, batch: tuple[Trial, ...]) -> list[Record]:
    if any(trial.name.endswith("-t1") for trial in batch):
        os.kill(os.getpid(), signal.SIGKILL)
    return run_trials(sets, batch)
