"""Maps of what a classifier sees."""

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.api.builds import Build
from wnn2hdl.api.measuring import classifier
from wnn2hdl.api.models import Model
from wnn2hdl.api.progress import watched
from wnn2hdl.api.showing import Shown
from wnn2hdl.apps.deforestation.classify import classify_window, unpack
from wnn2hdl.apps.deforestation.local import run_locally
from wnn2hdl.apps.deforestation.options import ScanOptions
from wnn2hdl.apps.deforestation.output import OVERLAY_FILE
from wnn2hdl.apps.deforestation.overlay import overlay, overlay_palette
from wnn2hdl.apps.deforestation.scanning import Scanner
from wnn2hdl.apps.deforestation.windows import Window
from wnn2hdl.dataset import cleared_classes
from wnn2hdl.errors import InputError
from wnn2hdl.images import read_rgb
from wnn2hdl.images.sources import PlainPicture
from wnn2hdl.progress import Progress
from wnn2hdl.raster import Reading
from wnn2hdl.tools import cores


@dataclass(frozen=True, eq=False, repr=False)
class Map(Shown):
    """The classes of a picture.

    Attributes:
        names: class names, the background first.
        classes: uint8 ``[height, width]``, class indices; None of a picture in a file, where they are in
            ``classes.tif`` in `folder`.
        deforested: share of the classified pixels, 0 to 1; None if there are none.
        hectares: of these on the ground; None if the picture does not say where it lies.
        known: share of the pixels whose colours the classifier knows; None if there are none.
        overlay: uint8 ``[height, width, 3]``, the picture tinted by class.
        folder: the files of the scan; None of a picture in memory.
    """

    names: tuple[str, ...]
    classes: NDArray[np.uint8] | None
    deforested: float | None
    hectares: float | None
    known: float | None
    overlay: NDArray[np.uint8]
    folder: Path | None

    @property
    def title(self) -> str:
        """See `Shown.title`."""
        return f"Map of {', '.join(self.names)}"

    @property
    def facts(self) -> Mapping[str, str]:
        """See `Shown.facts`."""
        found = {
            "deforested": _percent(self.deforested),
            "pixels with known colours": _percent(self.known),
        }
        if self.hectares is not None:
            found["hectares deforested"] = f"{self.hectares:,.2f}"
        return found | ({"folder": str(self.folder)} if self.folder else {})

    @property
    def picture(self) -> NDArray[np.uint8]:
        """See `Shown.picture`."""
        return self.overlay


def scan(
    subject: Model | Build | Path | str,
    picture: NDArray[np.uint8] | Path | str,
    folder: Path | str | None = None,
    options: ScanOptions = ScanOptions(),  # noqa: B008  # frozen
    *,
    progress: Progress | None = None,
) -> Map:
    """Map a picture.

    Args:
        subject: a model; or a build, whose circuit answers; or the file or folder of one.
        picture: uint8 ``[height, width, 3]``; or a file of any size.
        folder: where raster, polygons, overlay and summary of a file go.
        options: squares, smoothing and, of a file, how it is read and what is written.
        progress: called with each window; by default a line is shown where somebody watches.

    Raises:
        InputError: the subject reads no pixels, the picture cannot be used, or a file has no folder.
        ExtraMissingError: a file needs the extra ``geo``, and it is not installed.
    """
    if isinstance(picture, Path | str):
        if folder is None:
            raise InputError("the map of a file is written as files", value=picture, hint="name a folder")
        with watched(progress) as report:
            return _of_file(subject, Path(picture), Path(folder), options, report)
    if folder is not None or options.minimum is not None or options.reading != Reading():
        raise InputError(
            "folder, reading and minimum areas are for pictures from files", hint="leave them out"
        )
    return _of_array(subject, picture, options)


def _of_array(subject: Model | Build | Path | str, picture: NDArray[np.uint8], options: ScanOptions) -> Map:
    if picture.ndim != 3 or picture.shape[2] != 3 or picture.dtype != np.uint8 or not picture.size:
        raise InputError("a picture is uint8 [height, width, 3]", value=f"{picture.dtype} {picture.shape}")
    looks = classifier(subject)
    window = Window(0, 0, 0, *picture.shape[:2])
    result = classify_window(PlainPicture(picture), looks, options.method, window)
    classes = unpack(result.packed, window)
    cleared = np.isin(classes, cleared_classes(looks.classes))
    tinted = overlay(picture, classes, np.ones(classes.shape, dtype=np.bool_), overlay_palette(looks.classes))
    share = result.covered / result.valid
    return Map(looks.classes, classes, float(cleared.mean()), None, share, tinted, None)


def _of_file(
    subject: Model | Build | Path | str, picture: Path, folder: Path, options: ScanOptions, progress: Progress
) -> Map:
    with tempfile.TemporaryDirectory(prefix="wnn2hdl-") as temporary:
        if isinstance(subject, Model):
            place = Path(temporary, "model.json")
            subject.save(place)
        else:
            place = subject.folder if isinstance(subject, Build) else Path(subject)
        scanner = Scanner.open(place, options, partial(run_locally, cores()), progress)
        summary: dict[str, Any] = scanner.scan(picture, folder)
    deforested = summary["deforested"]
    return Map(
        scanner.classifier.classes,
        None,
        deforested["share"],
        deforested["hectares"],
        summary["coverage"]["share"],
        read_rgb(folder / OVERLAY_FILE),
        folder,
    )


def _percent(share: float | None) -> str:
    return "none" if share is None else f"{share:.2%}"
