"""From a picture to its class raster, window by window, whatever the size."""

from collections.abc import Callable, Generator, Iterable
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from wnn2hdl.apps.deforestation.classify import WindowResult, unpack
from wnn2hdl.apps.deforestation.finished import FinishedWindows
from wnn2hdl.apps.deforestation.task import Task
from wnn2hdl.apps.deforestation.windows import Window, cut
from wnn2hdl.images import Palette, Source
from wnn2hdl.progress import Progress
from wnn2hdl.raster import ClassWriter

CLASSIFYING = "classifying windows"
"""The step that `write_classes` reports."""

Runner = Callable[[Task, Iterable[Window]], Generator[WindowResult, None, None]]
"""Classifies windows, in any order."""


@dataclass(frozen=True)
class Coverage:
    """How familiar a picture is to a classifier.

    Attributes:
        valid: pixels that were classified.
        covered: those among them whose colours the training or the care set knows.
    """

    valid: int
    covered: int

    @property
    def share(self) -> float | None:
        """Of the valid pixels, 0 to 1; None if there are none."""
        return self.covered / self.valid if self.valid else None


def write_classes(
    task: Task,
    source: Source,
    kept: FinishedWindows,
    run: Runner,
    output: Path,
    palette: Palette,
    progress: Progress,
) -> Coverage:
    """Classify a picture and write its class raster.

    Memory holds the windows being worked on and one row of windows, one byte per pixel. Finished windows are
    kept: an interrupted call that is repeated classifies the missing ones only.

    Args:
        task: the picture, the classifier and the method.
        source: the open picture.
        kept: where finished windows are kept.
        run: classifies windows.
        output: the class raster, see `ClassWriter`; without overviews.
        palette: the colour of each class.
        progress: called with each window.

    Raises:
        InputError: the picture cannot be read or the raster not written.
    """
    bands = cut(source.height, source.width, source.block, task.method.side)
    total = sum(map(len, bands))
    progress(CLASSIFYING, len(kept), total)
    with (
        ClassWriter(output, source.height, source.width, source.georeference, palette.colours) as raster,
        closing(run(task, _missing(bands, kept))) as done,
    ):
        for band in bands:
            while not all(window.index in kept for window in band):
                kept.append(next(done))
                progress(CLASSIFYING, len(kept), total)
            rows = np.empty((band[0].height, source.width), dtype=np.uint8)
            for window in band:
                columns = slice(window.column, window.column + window.width)
                rows[:, columns] = unpack(kept.packed(window.index), window)
            raster.write(rows)
        return Coverage(kept.valid, kept.covered)


def _missing(bands: Iterable[Iterable[Window]], kept: FinishedWindows) -> list[Window]:
    return [window for band in bands for window in band if window.index not in kept]
