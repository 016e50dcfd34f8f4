import os
import signal

import pytest

from wnn2hdl.apps.sweep.grid import Plan
from wnn2hdl.apps.sweep.local import run_locally
from wnn2hdl.apps.sweep.pixels import PixelSets
from wnn2hdl.apps.sweep.trial import run_trials
from wnn2hdl.errors import ToolError


def test_processes_give_the_records_that_one_process_gives(sets: PixelSets, plan: Plan) -> None:
    trials = [plan.trial(position) for position in range(len(plan))]
    found = [record for records in run_locally(sets, trials) for record in records]
    assert sorted(found, key=lambda x: x.name) == sorted(run_trials(sets, trials), key=lambda x: x.name)


def test_a_killed_process_is_one_line(sets: PixelSets, plan: Plan, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("wnn2hdl.apps.sweep.local.run_trials", _die)
    with pytest.raises(ToolError, match=r"a process of the sweep was killed: .*; run the same command again"):
        list(run_locally(sets, [plan.trial(0)]))


def _die(sets: PixelSets, trials: object) -> None:
    os.kill(os.getpid(), signal.SIGKILL)
