"""What is done with every window of a picture: small enough to be sent to another machine."""

from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any
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

    @cached_property
    def source(self) -> Source:
        """The picture, opened once: a plain one is decoded whole."""
        return open_picture(self.path, self.reading)

    def __getstate__(self) -> dict[str, Any]:
        # An open picture cannot be sent; whoever receives the task opens its own.
        return {name: value for name, value in vars(self).items() if name != "source"}
