"""Trials on the cores of this machine."""

from collections.abc import Iterable, Iterator

import joblib
from joblib.externals.loky.process_executor import TerminatedWorkerError

from wnn2hdl.apps.sweep.grid import Trial, batches
from wnn2hdl.apps.sweep.pixels import PixelSets
from wnn2hdl.apps.sweep.trial import Record, run_trials
from wnn2hdl.errors import ToolError
from wnn2hdl.muted import muted

BATCH = 10
"""Trials per task: about half a second of work, so handing it over costs nothing and a kill loses little."""


def run_locally(sets: PixelSets, trials: Iterable[Trial]) -> Iterator[list[Record]]:
    """Run trials in as many processes as this one may use cores.

    Args:
        sets: the pixels.
        trials: taken as they are needed, never all at once.

    Yields:
        Records of some trials each, in the order in which they get done.

    Raises:
        ToolError: a process was killed from outside, as by a system short of memory.
    """
    pool = joblib.Parallel(n_jobs=joblib.cpu_count(), batch_size=1, return_as="generator_unordered")
    done = pool(joblib.delayed(run_trials)(sets, batch) for batch in batches(trials, BATCH))
    try:
        # Not by `yield from`, which would close the pool before the last clause.
        for records in done:  # noqa: UP028
            yield records
    except TerminatedWorkerError as error:
        raise ToolError(
            "a process of the sweep was killed",
            value=f"{pool.n_jobs} ran",
            hint="run the same command again: finished trials are kept",
        ) from error
    finally:
        # Whoever stops taking results knows that tasks are cancelled.
        with muted(UserWarning):
            done.close()
