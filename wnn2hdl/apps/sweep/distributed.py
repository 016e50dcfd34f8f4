"""Trials on many machines, by Dask distributed.

What a sweep of 10**6 trials on 100 workers costs, on paper, with trials of 50 ms:

- *Work*: 50,000 CPU seconds, 500 s on 100 workers. With one task per trial that would be 2,000 tasks per
  second; Dask's overhead is about 1 ms per task (its documentation), so its scheduler would manage half of
  that. So `BATCH` = 100 trials make a task of 5 s: 10**4 tasks, 20 per second, 2 % of the scheduler's time.
- *Bytes out*: the pixel sets of 30 scenes are 2.5 MB (measured). Inside every task they would be 25 GB by
  the scheduler; as the result of one task that all others depend on, each worker fetches them once, mostly
  from other workers: 250 MB. The text of 100 trials is 5 kB (measured); 50 MB in all.
- *Bytes back*: a record is about 360 bytes (measured), so 0.36 GB, 0.7 MB per second, into one file.
- *Scheduler's memory*: at most `AHEAD` tasks per core wait at a time, so it knows hundreds of tasks, not
  10**4; about 1 kB and a task's text each.
- *Losing a worker* costs at most the batches it had: its running task and those queued there.
"""

from collections.abc import Iterable, Iterator

from wnn2hdl.apps.sweep.grid import Trial, batches
from wnn2hdl.apps.sweep.pixels import PixelSets
from wnn2hdl.apps.sweep.trial import Record, failed, run_trials
from wnn2hdl.tools.cluster import run_on_cluster

BATCH = 100
"""Trials per task."""


def run_distributed(
    scheduler: str, sets: PixelSets, trials: Iterable[Trial], *, batch: int = BATCH
) -> Iterator[list[Record]]:
    """Run trials on a Dask cluster whose workers have this package installed.

    The trials of a task that keeps killing workers are run again one by one, and one that still does so is
    recorded as failed.

    Args:
        scheduler: its address: ``tcp://host:8786``.
        sets: the pixels.
        trials: taken as they are needed, never all at once.
        batch: trials per task.

    Yields:
        Records of some trials each, in the order in which they get done.

    Raises:
        ExtraMissingError: Dask is not installed.
        ToolError: no scheduler answers, it has no workers, or one of them cannot run trials at all.
    """
    done = run_on_cluster(
        scheduler, run_trials, sets, batches(trials, batch), alone=_single, install="wnn2hdl"
    )
    for trials_done, records in done:
        if records is None:
            (trial,) = trials_done
            yield [failed(trial, RuntimeError("every worker that ran this trial died"))]
        else:
            yield records


def _single(batch: tuple[Trial, ...]) -> Iterator[tuple[Trial, ...]]:
    return ((trial,) for trial in batch)
