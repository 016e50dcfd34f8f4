"""Windows on the cores of this machine."""

from collections import deque
from collections.abc import Generator, Iterable
from concurrent.futures import Future, ThreadPoolExecutor

from wnn2hdl.apps.deforestation.classify import WindowResult, classify_window
from wnn2hdl.apps.deforestation.task import Task
from wnn2hdl.apps.deforestation.windows import Window


def run_locally(jobs: int, task: Task, windows: Iterable[Window]) -> Generator[WindowResult, None, None]:
    """Classify windows in threads: NumPy, zlib and GDAL let others run while they work.

    Args:
        jobs: threads.
        task: what to do with each window.
        windows: taken as they are needed.

    Yields:
        Results in the windows' order; at most ``2 * jobs`` windows are being worked on or wait.

    Raises:
        InputError: the picture cannot be read.
    """
    pool = ThreadPoolExecutor(jobs)
    running: deque[Future[WindowResult]] = deque()
    try:
        for window in windows:
            running.append(pool.submit(classify_window, task.source, task.classifier, task.method, window))
            if len(running) >= 2 * jobs:
                yield running.popleft().result()
        while running:
            yield running.popleft().result()
    finally:
        pool.shutdown(cancel_futures=True)
