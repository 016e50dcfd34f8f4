"""Windows on many machines, by Dask distributed.

Only the picture's path goes out; every worker reads its windows itself, so the picture must lie on storage
that all of them see under that path. What comes back is compressed: of a window of 2,048 x 2,048 pixels of
forest with clearings some 10 kB with squares of 20 and 400 kB without. At most
`wnn2hdl.tools.cluster.AHEAD` windows per core are handed out at a time.
"""

from collections.abc import Generator, Iterable
from functools import lru_cache
from pathlib import Path

from wnn2hdl.apps.deforestation.classify import WindowResult, classify_window
from wnn2hdl.apps.deforestation.task import Task
from wnn2hdl.apps.deforestation.windows import Window
from wnn2hdl.errors import ToolError
from wnn2hdl.images import Source, open_picture
from wnn2hdl.raster import Reading
from wnn2hdl.tools.cluster import run_on_cluster


def run_distributed(
    scheduler: str, task: Task, windows: Iterable[Window]
) -> Generator[WindowResult, None, None]:
    """Classify windows on a Dask cluster whose workers have this package installed.

    Args:
        scheduler: its address: ``tcp://host:8786``.
        task: what to do with each window.
        windows: taken as they are needed.

    Yields:
        Results in the order in which they get done.

    Raises:
        ExtraMissingError: Dask is not installed.
        ToolError: as `run_on_cluster`, or a window killed every worker that was given it.
        InputError: a worker cannot read the picture.
    """
    done = run_on_cluster(
        scheduler, _classify, task, windows, alone=lambda window: (window,), install="wnn2hdl[geo]"
    )
    for window, result in done:
        if result is None:
            raise ToolError(
                "every worker died that was given one window",
                value=f"{task.path}, from row {window.row} and column {window.column} on",
                hint="see the workers' logs; run the same command again, finished windows are kept",
            )
        yield result


def _classify(task: Task, window: Window) -> WindowResult:
    return classify_window(_open(task.path, task.reading, task.token), task.classifier, task.method, window)


@lru_cache(maxsize=1)
def _open(path: Path, reading: Reading, token: str) -> Source:  # noqa: ARG001  # part of the key
    """A worker keeps a scan's picture open from window to window."""
    return open_picture(path, reading)
