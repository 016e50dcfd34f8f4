"""What is done with every window of a picture: small enough to be sent to another machine."""

from dataclasses import dataclass, field
from pathlib import Path
from uuid import uuid4

from wnn2hdl.apps.deforestation.classify import Method
from wnn2hdl.evaluation.classifiers import PictureClassifier
from wnn2hdl.images import Source, open_picture
from wnn2hdl.raster import Reading


@dataclass(frozen=True, eq=False)
class Task:
    """The same for all windows.

    Attributes:
        path: the picture, absolute.
        reading: how it is read.
        classifier: what classifies it.
        method: squares and smoothing.
        token: distinguishes this scan from another of the same path, whose file may have changed.
    """

    path: Path
    reading: Reading
    classifier: PictureClassifier
    method: Method
    token: str = field(default_factory=lambda: uuid4().hex)

    def open(self) -> Source:
        """Open the picture."""
        return open_picture(self.path, self.reading)
