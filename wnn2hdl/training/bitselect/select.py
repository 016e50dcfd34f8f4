"""From colours counted by image and class to a plain look-up table over the chosen pixel bits."""

from collections.abc import Callable, Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.ir import BitSelect, Encoder, WisardModel, spread_codes
from wnn2hdl.training.bitselect.cascade import Cascade, find_cascade
from wnn2hdl.training.bitselect.drift import LEAST_SHARE, Colours, blurred, main_drift, merged, unpacked
from wnn2hdl.training.bitselect.mass import POOL, signed_mass
from wnn2hdl.training.bitselect.reference import fit_reference
from wnn2hdl.wisard import require_every_class, require_two_classes

MOST_LUTS = 3


class Histogram(Protocol):
    """The colours of one image, as `wnn2hdl.dataset.ColourHistogram`."""

    @property
    def colours(self) -> NDArray[np.uint32]:
        """uint32 ``[u]``, ``0xRRGGBB``."""

    @property
    def counts(self) -> NDArray[np.int64]:
        """int64 ``[classes, u]``, pixels of each colour in each class."""


def select_bits(
    images: Sequence[Histogram],
    classes: tuple[str, ...],
    *,
    luts: int,
    seed: int,
    progress: Callable[[int, int], None] | None = None,
) -> WisardModel:
    """Choose pixel bits and a table over them that map to ``luts`` LUTs.

    Args:
        images: each training image's colours; at least three, or drift between images is not seen.
        classes: two class names, the background first.
        luts: 1 to 3. One LUT is the best of all choices of six bits; two and three are found by search.
        seed: decides the search's starts.
        progress: called with (starts done, starts in all); not for one LUT, which takes no time.

    Returns:
        a model of one RAM per class that reads every chosen bit (see `look_up_table`); its `training` names
        the bits that each LUT of the cascade reads.

    Raises:
        InputError: not two classes, another number of LUTs, or a class without pixels.
    """
    require_two_classes(classes, "bit selection")
    if not 1 <= luts <= MOST_LUTS:
        raise InputError(
            "bit selection makes classifiers of 1 to 3 LUTs per pixel",
            value=luts,
            hint=f"ask for 1 to {MOST_LUTS}",
        )
    spread = _training_colours(images, classes)
    mass = signed_mass(spread, fit_reference(spread))
    cascade = find_cascade(mass, luts, seed, progress)
    bits = cascade.bits
    training = {"method": "bit selection", "luts": luts, "seed": seed, "images": len(images)}
    return look_up_table(
        BitSelect(tuple(POOL.bits[x] for x in bits)),
        classes,
        cascade.evaluate(spread_codes(bits)).astype(np.int64),
        training | {"cascade": _names(cascade)},
    )


def look_up_table(
    encoder: Encoder, classes: tuple[str, ...], answers: NDArray[np.int64], training: dict[str, Any]
) -> WisardModel:
    """A model of one RAM per class, of which exactly one fires for each code.

    Args:
        encoder: the bits that are read.
        classes: class names.
        answers: int64 ``[2**encoder.width]``, the class index of each code.
        training: what to record in the model.
    """
    counts = (answers == np.arange(len(classes))[:, np.newaxis]).astype(np.int64)
    mapping = np.arange(encoder.width, dtype=np.int64).reshape(1, 1, -1)
    return WisardModel(encoder, classes, mapping, counts[:, np.newaxis], 1, training)


def _training_colours(images: Sequence[Histogram], classes: tuple[str, ...]) -> Colours:
    """All images' colours together, blurred by the drift of the background between them."""
    require_every_class(
        classes, (any(image.counts[i].any() for image in images) for i in range(len(classes)))
    )
    means = [
        image.counts[0] @ unpacked(image.colours.astype(np.int64)) / image.counts[0].sum()
        for image in images
        if image.counts[0].sum() > LEAST_SHARE * image.counts.sum()
    ]
    together = merged(
        np.concatenate([image.colours for image in images]).astype(np.int64),
        np.concatenate([image.counts for image in images], axis=1).astype(np.float64),
    )
    return blurred(together, main_drift(np.array(means)))


def _names(cascade: Cascade) -> list[list[str]]:
    """For each LUT the pixel bits it reads, ``lut0`` … for those before it."""
    signals = (*POOL.bits, *(f"lut{i}" for i in range(len(cascade.tables))))
    return [[signals[x] for x in table.inputs] for table in cascade.tables]
