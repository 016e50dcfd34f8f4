"""Jobs on a real cluster; tests of scans and sweeps kill its workers."""

import os
import signal
import sys
from collections.abc import Iterable
from typing import Any

import pytest

from wnn2hdl.errors import ExtraMissingError, InputError, ToolError
from wnn2hdl.tools.cluster import _require_same, run_on_cluster

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


def pretend(version: str) -> None:
    """On a worker: be another version of this package."""
    import wnn2hdl

    wnn2hdl.__version__ = version


@pytest.mark.slow
def test_a_worker_of_another_version_is_refused_before_the_first_job(
    cluster: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    from distributed import Client

    with Client(cluster.scheduler_address) as client:
        other = next(iter(client.scheduler_info()["workers"]))
        client.run(pretend, "0.0.1", workers=[other])
    with pytest.raises(ToolError, match=f"another version: {other} has wnn2hdl 0.0.1 instead of") as caught:
        run(cluster.scheduler_address, [13])
    assert "install the same wnn2hdl[cluster] on every worker" in str(caught.value)
    # A worker that joins later is met by a job instead.
    monkeypatch.setattr("distributed.Client.run", lambda *_, **__: {})
    with pytest.raises(ToolError, match=r"has wnn2hdl 0\.0\.1 instead of"):
        run(cluster.scheduler_address, range(1, 40))


@pytest.mark.parametrize(
    ("theirs", "fault"),
    [
        (
            {"wnn2hdl": "1", "numpy": "2.0", "Python": "3.12"},
            "w has numpy 2.0 instead of 2.1, Python 3.12 instead",
        ),
        ({"wnn2hdl": "1", "numpy": "2.1"}, "w has Python unknown instead of 3.11"),
        (ModuleNotFoundError("No module named 'wnn2hdl'"), r"cannot run wnn2hdl: w \(No module named"),
    ],
)
def test_whatever_differs_is_named(theirs: object, fault: str) -> None:
    ours = {"wnn2hdl": "1", "numpy": "2.1", "Python": "3.11"}
    _require_same("w", ours, ours, "wnn2hdl")
    with pytest.raises(ToolError, match=fault):
        _require_same("w", theirs, ours, "wnn2hdl")


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
