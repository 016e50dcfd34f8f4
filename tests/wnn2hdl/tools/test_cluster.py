"""Jobs on a real cluster; tests of scans and sweeps kill its workers."""

import os
import signal
import sys
from collections.abc import Iterable
from typing import Any

import pytest

from wnn2hdl.errors import ExtraMissingError, InputError, ToolError
from wnn2hdl.tools.cluster import run_on_cluster

NOWHERE = "tcp://127.0.0.1:9"


def divide(shared: int, job: int) -> float:
    """The workers' function: each kind of failure has a job."""
    if job == 13:
        os.kill(os.getpid(), signal.SIGKILL)
    if job == 1000:
        raise InputError("too many", value=job, hint="give fewer")
    return shared / job


def alone(job: int) -> Iterable[int]:
    return (job,)


def run(scheduler: str, jobs: Iterable[int]) -> dict[int, float | None]:
    return dict(run_on_cluster(scheduler, divide, 60, jobs, alone=alone, install="wnn2hdl[cluster]"))


@pytest.mark.slow
def test_every_job_is_done_once_and_a_deadly_one_has_no_result(cluster: Any) -> None:
    jobs = range(1, 40)
    assert run(cluster.scheduler_address, jobs) == {job: None if job == 13 else 60 / job for job in jobs}


@pytest.mark.slow
def test_an_error_of_ours_comes_back_as_it_is_and_any_other_as_the_workers(cluster: Any) -> None:
    with pytest.raises(InputError, match="too many: 1000; give fewer"):
        run(cluster.scheduler_address, [1, 1000])
    with pytest.raises(ToolError, match=r"cannot do its work: division by zero; .*wnn2hdl.cluster. on every"):
        run(cluster.scheduler_address, [1, 0])


@pytest.mark.slow
def test_a_cluster_without_workers_is_one_line(cluster: Any) -> None:
    cluster.scale(0)
    cluster.sync(cluster._correct_state)  # there is no public way to wait for it
    with pytest.raises(ToolError, match="the cluster has no workers"):
        run(cluster.scheduler_address, [1])


def test_an_address_where_nothing_listens_is_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("wnn2hdl.tools.cluster._CONNECT_SECONDS", 1)
    with pytest.raises(ToolError, match=f"no Dask scheduler answers: {NOWHERE};"):
        run(NOWHERE, [1])


def test_the_extra_is_named_where_it_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(ExtraMissingError, match=r"wnn2hdl\[cluster\]"):
        run(NOWHERE, [1])
