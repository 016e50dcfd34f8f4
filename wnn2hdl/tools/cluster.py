"""Jobs on many machines, by Dask distributed: a few a core at a time, and a dying worker loses nothing."""

from collections.abc import Callable, Generator, Iterable
from itertools import islice
from typing import TYPE_CHECKING, TypeVar

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
    are done, since a dying worker takes along what is queued on it.

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
        ToolError: no scheduler answers, it has no workers, or one of them cannot run jobs at all.
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
    waiting = iter(jobs)
    running: dict[Future[Result], Job] = {}
    suspects: list[Job] = []
    completed = as_completed()

    def submit(job: Job) -> None:
        future = client.submit(function, sent, job, pure=False)
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
            yield job, result(client.submit(function, sent, job, pure=False))
        except KilledWorker:
            yield job, None


def _identity(shared: Shared) -> Shared:
    return shared
