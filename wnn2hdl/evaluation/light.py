"""How often a classifier of pictures is right in other light and air, and by other cameras."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.dataset import Dataset, LabelledImage
from wnn2hdl.evaluation.accuracy import labelled_answers, require_same_classes
from wnn2hdl.evaluation.classifiers import PictureClassifier
from wnn2hdl.evaluation.measures import accuracy, confusion_of, interval
from wnn2hdl.images import balanced, curved, exposed, hazed
from wnn2hdl.ir import BitSelect, Comparison, Context, Neighbourhood, PictureEncoder
from wnn2hdl.ir.pixel_bits import CHANNEL_BITS, CHANNELS, PIXEL_BIT_NAMES
from wnn2hdl.progress import Progress, reported

CHANGES: Mapping[str, Callable[[NDArray[np.uint8], float], NDArray[np.uint8]]] = {
    "exposure": exposed,
    "haze": hazed,
    "white_balance": balanced,
    "gamma": curved,
}
"""What light, air and camera do to pixels, by the name of the quantity that it takes."""

AS_TAKEN: Mapping[str, float] = {"exposure": 1.0, "haze": 0.0, "white_balance": 1.0, "gamma": 1.0}
"""The value of each quantity that leaves pixels as they are."""

BRIGHTER = (1.0, 1.1, 1.2, 1.3, 1.4, 1.5)
"""Exposures at which a classifier of the same ground should be as accurate as at the first. A bit that is not
read misleads at some of them and not at others."""

MOST_LOST = 0.02
"""The accuracy that it may lose before it is said to answer differently."""

REPORTED: Mapping[str, tuple[float, ...]] = {
    "exposure": (0.8, 0.9, *BRIGHTER),
    "haze": (0.0, 0.02, 0.04, 0.06, 0.08, 0.1),
}
"""The values at which the circuit of a build is measured."""

_MOST_STEPS = 10
_STEPS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0)


@dataclass(frozen=True, eq=False)
class LightCurve:
    """Answers for the same images in several lights.

    Attributes:
        quantity: what varies, of `CHANGES`.
        values: of the quantity, ascending.
        names: the images.
        confusion: int64 ``[values, images, classes, classes]``, pixels by true class and answer.
    """

    quantity: str
    values: tuple[float, ...]
    names: tuple[str, ...]
    confusion: NDArray[np.int64]

    @property
    def shares(self) -> dict[float, float]:
        """The accuracy at each value, over all measured pixels."""
        return dict(zip(self.values, accuracy(self.confusion.sum(axis=1)).tolist(), strict=True))

    def figures(self, seed: int) -> list[dict[str, Any]]:
        """For each value the accuracy, its interval as of `interval`, and the image with the lowest.

        Args:
            seed: of the bootstrap.
        """
        return [
            {
                "value": value,
                "accuracy": self.shares[value],
                "interval": interval(confusion, accuracy, seed),
                "worst_image": worst_image(self.names, confusion),
            }
            for value, confusion in zip(self.values, self.confusion, strict=True)
        ]


def worst_image(names: Sequence[str], confusion: NDArray[np.int64]) -> dict[str, Any]:
    """The image with the lowest share of right pixels: its name, and that share.

    Args:
        names: the images.
        confusion: ``[images, classes, classes]``; an image of which nothing was measured counts for nothing.
    """
    shares = accuracy(confusion)
    worst = int(np.nanargmin(shares))
    return {"name": names[worst], "accuracy": float(shares[worst])}


def light_curve(
    classifier: PictureClassifier,
    dataset: Dataset,
    quantity: str,
    values: Sequence[float],
    progress: Progress,
) -> LightCurve:
    """Compare a classifier's answers with the labels of images whose light is changed.

    Args:
        classifier: what answers.
        dataset: the images; one is in memory at a time.
        quantity: of `CHANGES`.
        values: of the quantity, ascending.
        progress: called with each image read.

    Raises:
        InputError: as `wnn2hdl.evaluation.accuracy.evaluate`.
    """
    require_same_classes(classifier.classes, dataset)
    classes = len(dataset.classes)
    confusion = np.zeros((len(values), len(dataset), classes, classes), dtype=np.int64)
    for position, image in enumerate(reported(dataset, f"varying {quantity}", len(dataset), progress)):
        for index, value in enumerate(values):
            answers, _, labels = labelled_answers(classifier, _lit(image, quantity, value), None)
            confusion[index, position] = confusion_of(labels, answers, classes)
    return LightCurve(quantity, tuple(values), dataset.names, confusion)


def steps(low: float, high: float, quantity: str) -> tuple[float, ...]:
    """Values from ``low`` to ``high``: both, round numbers between them, and the one of `AS_TAKEN`.

    Args:
        low: the least.
        high: the greatest.
        quantity: of `CHANGES`.
    """
    step = next((step for step in _STEPS if high - low <= _MOST_STEPS * step), (high - low) / _MOST_STEPS)
    inside = step * np.arange(np.ceil(low / step), np.floor(high / step) + 1)
    found = {round(float(value), 6) for value in inside} | {AS_TAKEN[quantity]}
    return tuple(sorted({low, high} | {value for value in found if low <= value <= high}))


def _lit(image: LabelledImage, quantity: str, value: float) -> LabelledImage:
    change = CHANGES[quantity]
    scene = image.scene and replace(image.scene, picture=change(image.scene.picture, value))
    return replace(image, pixels=change(image.pixels, value), scene=scene)


def unread_high_bits(encoder: PictureEncoder) -> tuple[str, ...]:
    """The high bits of channels that an encoder does not read, though it reads lower ones of the channel.

    Where such a bit is set, the channel counts as darker than one in which it is not: brighter ground of the
    same kind may get the answer of dark ground. Of a neighbourhood each table is taken by itself.
    """
    if isinstance(encoder, Neighbourhood):
        return tuple(sorted({bit for tap in encoder.taps for bit in unread_high_bits(tap.pixel)}))
    names = encoder.planes if isinstance(encoder, Context) else encoder.bits
    read = set(names)
    if not isinstance(encoder, BitSelect):
        read = {
            bit
            for name in names
            for bit in ((name,) if name in PIXEL_BIT_NAMES else Comparison.parse(name).bits)
        }
    unread = []
    for channel in CHANNELS:
        highest = max((int(bit[1]) for bit in read if bit[0] == channel), default=CHANNEL_BITS - 1)
        unread += [f"{channel}{bit}" for bit in range(CHANNEL_BITS - 1, highest, -1)]
    return tuple(unread)


def brighter_figures(shares: Mapping[float, float], encoder: PictureEncoder) -> dict[str, Any]:
    """What a classifier loses in more light.

    Args:
        shares: the accuracy at exposures, 1 among them; empty if it is not known.
        encoder: the classifier's.

    Returns:
        Of the exposures from 1 up, the one at which the accuracy is lowest, that accuracy, and by how much it
        is below that at 1; and the bits of `unread_high_bits`.
    """
    figures: dict[str, Any] = {"unread_high_bits": list(unread_high_bits(encoder))}
    if shares:
        worst = min((value for value in shares if value >= 1), key=lambda value: shares[value])
        lost = shares[1.0] - shares[worst]
        figures |= {"exposure": worst, "accuracy": shares[worst], "lost": lost}
    return figures


def brighter_warning(figures: Mapping[str, Any]) -> str:
    """One line that says that brighter ground may be answered differently; empty if nothing speaks for it.

    Args:
        figures: as of `brighter_figures`.
    """
    reasons = []
    if figures.get("lost", 0) > MOST_LOST:
        reasons.append(
            f"at x{figures['exposure']:g} the light {figures['accuracy']:.2%} of the pixels are right, "
            f"{100 * figures['lost']:.1f} points fewer than at x1"
        )
    unread = figures["unread_high_bits"]
    if unread:
        verb = "are" if len(unread) > 1 else "is"
        reasons.append(f"{', '.join(unread)} {verb} not read, so levels wrap around")
    if not reasons:
        return ""
    return f"brighter ground of the same kind may be answered differently: {'; '.join(reasons)}"
