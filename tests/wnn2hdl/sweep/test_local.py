import os
import signal

import pytest

from wnn2hdl.errors import ToolError
from wnn2hdl.sweep.grid import Plan
from wnn2hdl.sweep.local import run_locally
from wnn2hdl.sweep.pixels import PixelSets
from wnn2hdl.sweep.trial import run_trials


def test_processes_give_the_records_that_one_process_gives(sets: PixelSets, plan: Plan) -> None:
    trials = [plan.trial(position) for position in range(len(plan))]
    found = [record for records in run_locally(sets, trials) for record in records]
    assert sorted(found, key=lambda x: x.name) == sorted(run_trials(sets, trials), key=lambda x: x.name)


def test_a_killed_process_is_one_line(sets: PixelSets, plan: Plan, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("wnn2hdl.sweep.local.run_trials", _die)
    with pytest.raises(ToolError, match=r"a process of the sweep was killed: .*; run the same command again"):
        list(run_locally(sets, [plan.trial(0)]))


def _die(sets: PixelSets, trials: object) -> None:
    os.kill(os.getpid(), signal.SIGKILL)
