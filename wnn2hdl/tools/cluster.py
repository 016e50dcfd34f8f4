"""Jobs on many machines, by Dask distributed: a few per core at a time, and a dying worker loses nothing."""

import platform
from collections.abc import Callable, Generator, Iterable, Mapping
from itertools import islice
from typing import TYPE_CHECKING, TypeVar

import numpy as np

import wnn2hdl
from wnn2hdl.errors import ToolError, Wnn2hdlError, extra_needed

if TYPE_CHECKING:
    from distributed import Client, Future

Shared = TypeVar("Shared")
Job = TypeVar("Job")
Result = TypeVar("Result")

AHEAD = 4
"""Jobs handed out for each core of the cluster: enough that none waits for the client."""

_CONNECT_SECONDS = 30


def run_on_cluster(
    scheduler: str,
    function: Callable[[Shared, Job], Result],
    shared: Shared,
    jobs: Iterable[Job],
    *,
    alone: Callable[[Job], Iterable[Job]],
    install: str,
) -> Generator[tuple[Job, Result | None], None, None]:
    """Run jobs on a Dask cluster whose workers have this package installed.

    A worker that dies loses nothing: its jobs, and the shared value if it held the only copy, are made again
    elsewhere. A job that was under way on several workers as they died is run again all alone when all others
    are done, since a dying worker loses what is queued on it.

    Args:
        scheduler: its address: ``tcp://host:8786``.
        function: of the shared value and a job; the workers import it by its name.
        shared: sent once, and passed on among the workers.
        jobs: taken as they are needed, never all at once.
        alone: what of a suspected job is run by itself: the job, or its parts.
        install: what every worker needs, for the error: ``wnn2hdl[geo]``.

    Yields:
        jobs and their results, in the order in which they get done; None in place of the result of a job that
        kills every worker that is given it alone.

    Raises:
        ExtraMissingError: Dask is not installed.
        ToolError: no scheduler answers, it has no workers, one of them has another version of wnn2hdl, NumPy
            or Python than this process, or cannot run jobs at all.
        Wnn2hdlError: what ``function`` raises of this kind.
    """
    with extra_needed("cluster", "running on a cluster needs Dask"):
        from distributed import Client
    try:
        client = Client(scheduler, timeout=_CONNECT_SECONDS)
    except (OSError, ValueError) as error:
        raise ToolError(
            "no Dask scheduler answers", value=scheduler, hint="start `dask scheduler` or correct the address"
        ) from error
    with client:
        cores = sum(client.nthreads().values())
        if not cores:
            raise ToolError("the cluster has no workers", value=scheduler, hint="start `dask worker`s")
        for worker, theirs in client.run(_versions, on_error="return").items():
            _require_same(worker, theirs, _versions(), install)
        yield from _run(client, AHEAD * cores, function, shared, jobs, alone, install)


def _run(
    client: "Client",
    ahead: int,
    function: Callable[[Shared, Job], Result],
    shared: Shared,
    jobs: Iterable[Job],
    alone: Callable[[Job], Iterable[Job]],
    install: str,
) -> Generator[tuple[Job, Result | None], None, None]:
    from distributed import KilledWorker, as_completed

    # The result of a task, not scattered data: those are lost with the last worker that has them, while the
    # scheduler can have a task done again.
    sent = client.submit(_identity, shared, pure=False)
    ours = _versions()
    waiting = iter(jobs)
    running: dict[Future[Result], Job] = {}
    suspects: list[Job] = []
    completed = as_completed()

    def submit(job: Job) -> None:
        future = client.submit(_call, function, sent, job, ours, install, pure=False)
        running[future] = job
        completed.add(future)

    def result(future: "Future[Result]") -> Result:
        try:
            done: Result = future.result()
        except (KilledWorker, Wnn2hdlError):
            raise
        except Exception as error:
            raise ToolError(
                "a worker cannot do its work", value=error, hint=f"install the same {install} on every worker"
            ) from error
        return done

    for job in islice(waiting, ahead):
        submit(job)
    for future in completed:
        job = running.pop(future)
        try:
            yield job, result(future)
        except KilledWorker:
            suspects.append(job)
        for following in islice(waiting, 1):
            submit(following)
    for job in (part for suspect in suspects for part in alone(suspect)):
        try:
            yield job, result(client.submit(_call, function, sent, job, ours, install, pure=False))
        except KilledWorker:
            yield job, None


def _versions() -> dict[str, str]:
    """What must be the same on all machines for the same results."""
    python = ".".join(platform.python_version_tuple()[:2])
    return {"wnn2hdl": wnn2hdl.__version__, "numpy": np.__version__, "Python": python}


def _require_same(worker: str, theirs: object, ours: Mapping[str, str], install: str) -> None:
    """Refuse a worker that is not like this process, or that cannot say what it is like."""
    hint = f"install the same {install} on every worker"
    if not isinstance(theirs, Mapping):
        raise ToolError("a worker cannot run wnn2hdl", value=f"{worker} ({theirs})", hint=hint)
    others = [
        f"{name} {theirs.get(name, 'unknown')} instead of {here}"
        for name, here in ours.items()
        if theirs.get(name) != here
    ]
    if others:
        raise ToolError("a worker has another version", value=f"{worker} has {', '.join(others)}", hint=hint)


def _call(
    function: Callable[[Shared, Job], Result],
    shared: Shared,
    job: Job,
    ours: Mapping[str, str],
    install: str,
) -> Result:
    """One job on a worker, which may have joined the cluster after the others were looked at."""
    _require_same(platform.node(), _versions(), ours, install)
    return function(shared, job)


def _identity(shared: Shared) -> Shared:
    return shared
