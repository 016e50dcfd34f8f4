"""Trials on many machines, by Dask distributed.

What a sweep of 10**6 trials on 100 workers costs, on paper, with trials of 50 ms:

- *Work*: 50,000 CPU seconds, 500 s on 100 workers. With a task a trial that would be 2,000 tasks a second;
  Dask's overhead is about 1 ms a task (its documentation), so its scheduler would manage half of that. So
  `BATCH` = 100 trials make a task of 5 s: 10**4 tasks, 20 a second, 2 % of the scheduler's time.
- *Bytes out*: the pixel sets of 30 scenes are 2.5 MB (measured). Inside every task they would be 25 GB by
  the scheduler; as the result of one task that all others depend on, each worker fetches them once, mostly
  from other workers: 250 MB. The text of 100 trials is 5 kB (measured); 50 MB in all.
- *Bytes back*: a record is about 360 bytes (measured), so 0.36 GB, 0.7 MB a second, into one file.
- *Scheduler's memory*: at most `AHEAD` tasks a core wait at a time, so it knows hundreds of tasks, not 10**4;
  about 1 kB and a task's text each.
- *Losing a worker* costs at most the batches it had: its running task and those queued there.
"""

from collections.abc import Iterable, Iterator
from itertools import islice
from typing import TYPE_CHECKING

from wnn2hdl.errors import ExtraMissingError, ToolError
from wnn2hdl.sweep.grid import Trial, batches
from wnn2hdl.sweep.pixels import PixelSets
from wnn2hdl.sweep.trial import Record, failed, run_trials

if TYPE_CHECKING:
    from distributed import Client, Future

BATCH = 100
"""Trials a task."""

AHEAD = 4
"""Tasks handed out for each core of the cluster: enough that none waits for the client."""

_CONNECT_SECONDS = 30


def run_distributed(
    scheduler: str, sets: PixelSets, trials: Iterable[Trial], *, batch: int = BATCH
) -> Iterator[list[Record]]:
    """Run trials on a Dask cluster whose workers have this package installed.

    A worker that dies loses nothing: its tasks, and the pixel sets if it held their only copy, are made
    again elsewhere. The trials of a task that keeps killing workers are run again one by one when all others
    are done, and one that still does so is recorded as failed.

    Args:
        scheduler: its address: ``tcp://host:8786``.
        sets: the pixels.
        trials: taken as they are needed, never all at once.
        batch: trials a task.

    Yields:
        Records of some trials each, in the order in which they get done.

    Raises:
        ExtraMissingError: Dask is not installed.
        ToolError: no scheduler answers, it has no workers, or one of them cannot run trials at all.
    """
    try:
        from distributed import Client
    except ImportError as error:
        raise ExtraMissingError(
            "running on a cluster needs Dask", mend="install it with: pip install 'wnn2hdl[cluster]'"
        ) from error
    try:
        client = Client(scheduler, timeout=_CONNECT_SECONDS)
    except (OSError, ValueError) as error:
        raise ToolError(
            "no Dask scheduler answers", value=scheduler, mend="start `dask scheduler` or correct the address"
        ) from error
    with client:
        cores = sum(client.nthreads().values())
        if not cores:
            raise ToolError("the cluster has no workers", value=scheduler, mend="start `dask worker`s")
        yield from _run(client, cores, sets, batches(trials, batch))


def _run(
    client: "Client", cores: int, sets: PixelSets, waiting: Iterator[tuple[Trial, ...]]
) -> Iterator[list[Record]]:
    from distributed import KilledWorker, as_completed

    # The sets are the result of a task, not scattered data: those are lost with the last worker that has
    # them, while the scheduler can have a task done again.
    shared = client.submit(_identity, sets, key=f"pixel-sets-{sets.digest}")
    running: dict[Future[list[Record]], tuple[Trial, ...]] = {}
    suspects: list[Trial] = []
    completed = as_completed()

    def submit(batch: tuple[Trial, ...]) -> None:
        future = client.submit(run_trials, shared, batch, pure=False)
        running[future] = batch
        completed.add(future)

    for batch in islice(waiting, AHEAD * cores):
        submit(batch)
    for future in completed:
        batch = running.pop(future)
        try:
            yield future.result()
        except KilledWorker:
            suspects += batch
        except Exception as error:
            raise ToolError(
                "a worker cannot run trials", value=error, mend="install the same wnn2hdl on every worker"
            ) from error
        for following in islice(waiting, 1):
            submit(following)
    # A dying worker takes along what is queued on it, so guilt shows only when a trial runs all alone.
    for trial in suspects:
        try:
            yield client.submit(run_trials, shared, (trial,), pure=False).result()
        except KilledWorker:
            yield [failed(trial, RuntimeError("every worker that ran this trial died"))]


def _identity(sets: PixelSets) -> PixelSets:
    return sets
