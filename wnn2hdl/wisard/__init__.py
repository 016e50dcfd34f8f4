"""WiSARD: RAM discriminators trained one against all, bleaching, winner-takes-all."""

from typing import TYPE_CHECKING, Any

from wnn2hdl.wisard.bleaching import choose_bleaching
from wnn2hdl.wisard.mapping import draw_mapping
from wnn2hdl.wisard.pixels import (
    PixelClassifier,
    require_every_class,
    require_two_classes,
    train_histogram,
)

if TYPE_CHECKING:
    from wnn2hdl.wisard.classifier import WisardClassifier

__all__ = [
    "PixelClassifier",
    "WisardClassifier",
    "choose_bleaching",
    "draw_mapping",
    "require_every_class",
    "require_two_classes",
    "train_histogram",
]


def __getattr__(name: str) -> Any:
    # scikit-learn takes a second to import, which no command should wait for that does not use it.
    if name == "WisardClassifier":
        from wnn2hdl.wisard.classifier import WisardClassifier

        return WisardClassifier
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
