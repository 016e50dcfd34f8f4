"""Labelled images and how they are split."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.images import UNLABELLED, Picture, whole_windows

CLASSES = ("forest", "deforested")
"""The two classes of the reference design; the first is the background."""

NATURAL = ("river", "water")
"""Classes other than the background that are not deforestation: what they cover was never felled."""


def cleared_classes(names: Sequence[str]) -> tuple[int, ...]:
    """Indices of the classes that count as deforested: all but the first, the background, and `NATURAL`."""
    return tuple(index for index, name in enumerate(names) if index and name not in NATURAL)


@dataclass(frozen=True, eq=False)
class Scene:
    """A picture of which some pixels are not used.

    Attributes:
        picture: uint8 ``[height, width, 3]``: red, green, blue.
        valid: bool ``[height, width]``: which pixels are data.
        used: bool ``[height, width]``: which of these are labelled.
    """

    picture: NDArray[np.uint8]
    valid: NDArray[np.bool_]
    used: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class LabelledImage:
    """The labelled pixels of one image.

    Attributes:
        name: the image's file name, or the seed it was generated from.
        pixels: uint8 ``[n, 3]``: red, green, blue.
        labels: uint8 ``[n]``: class indices.
        shape: height and width of the image if its labelled pixels are all here, row by row; None if only
            some are.
        scene: the image, where some of it is not labelled or no data; None if all pixels are here.
    """

    name: str
    pixels: NDArray[np.uint8]
    labels: NDArray[np.uint8]
    shape: tuple[int, int] | None = None
    scene: Scene | None = None

    @classmethod
    def of(cls, name: str, picture: Picture, classes: NDArray[np.uint8]) -> Self:
        """Of a picture and its classes, uint8 ``[height, width]``, `UNLABELLED` where there is none."""
        shape = classes.shape[0], classes.shape[1]
        used = picture.valid & (classes != UNLABELLED)
        if used.all():
            return cls(name, picture.pixels.reshape(-1, 3), classes.ravel(), shape)
        scene = Scene(picture.pixels, picture.valid, used)
        return cls(name, picture.pixels[used], classes[used], shape, scene)

    @property
    def left_out(self) -> int:
        """Pixels of the image that are no data or not labelled."""
        return 0 if self.scene is None else int(self.scene.used.size - len(self.labels))

    @property
    def picture(self) -> NDArray[np.uint8]:
        """The image, uint8 ``[height, width, 3]``; raises InputError if only some pixels are here."""
        shape = self._whole()
        return self.pixels.reshape(*shape, 3) if self.scene is None else self.scene.picture

    @property
    def label_picture(self) -> NDArray[np.uint8]:
        """The labels in the place of their pixels, uint8 ``[height, width]``; raises as `picture` does.

        `UNLABELLED` where a pixel has none.
        """
        shape = self._whole()
        if self.scene is None:
            return self.labels.reshape(shape)
        classes = np.full(shape, UNLABELLED, dtype=np.uint8)
        classes[self.scene.used] = self.labels
        return classes

    def usable(self, halo: int) -> NDArray[np.bool_]:
        """Which pixels are labelled and see data alone within ``halo``, bool ``[height, width]``.

        Raises as `picture` does.
        """
        shape = self._whole()
        if self.scene is None:
            return np.ones(shape, dtype=np.bool_)
        return self.scene.used & whole_windows(self.scene.valid, halo)

    def _whole(self) -> tuple[int, int]:
        if self.shape is None:
            raise InputError(
                "only some pixels of the image are labelled, and neighbours are needed",
                value=self.name,
                hint="give pictures with masks",
            )
        return self.shape


@dataclass(frozen=True, eq=False)
class Dataset:
    """A set of labelled images, each read when it is asked for.

    Attributes:
        classes: class names, the background first.
        names: the images' names, all different, sorted.
        load: reads one of them.
    """

    classes: tuple[str, ...]
    names: tuple[str, ...]
    load: Callable[[str], LabelledImage]

    def __len__(self) -> int:
        return len(self.names)

    def __iter__(self) -> Iterator[LabelledImage]:
        return map(self.load, self.names)

    def subset(self, names: Iterable[str]) -> "Dataset":
        """The same set with only the images ``names``."""
        return replace(self, names=tuple(sorted(names)))


def folds(names: Iterable[str], count: int) -> tuple[tuple[tuple[str, ...], tuple[str, ...]], ...]:
    """Cross-validation by image: in fold ``f`` the images with sorted index ``i % count == f`` are tested.

    Returns:
        for each fold the names to train on and the names to test on.

    Raises:
        InputError: fewer than two folds, or more folds than images.
    """
    ordered = sorted(names)
    if not 2 <= count <= len(ordered):
        raise InputError(
            f"{len(ordered)} images cannot be split into {count} folds",
            hint=f"choose from 2 to {len(ordered)}",
        )
    return tuple(
        (
            tuple(name for i, name in enumerate(ordered) if i % count != fold),
            tuple(ordered[fold::count]),
        )
        for fold in range(count)
    )


def split(names: Iterable[str], test: int) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Hold images out: ``test`` of them, evenly spread over the sorted names.

    Returns:
        the names to train on and the names to test on.

    Raises:
        InputError: nothing would be left on one side.
    """
    ordered = sorted(names)
    if not 1 <= test < len(ordered):
        raise InputError(
            f"{test} of {len(ordered)} images cannot be held out for the test",
            hint="leave at least one image on each side",
        )
    held = {(2 * i + 1) * len(ordered) // (2 * test) for i in range(test)}
    return (
        tuple(name for i, name in enumerate(ordered) if i not in held),
        tuple(name for i, name in enumerate(ordered) if i in held),
    )
