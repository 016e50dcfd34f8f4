"""Training that knows the cost: each method with its LUTs per pixel and its accuracy on unseen images."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.dataset import ColourHistogram, Dataset, colour_histogram
from wnn2hdl.encode import high_bits
from wnn2hdl.errors import InputError
from wnn2hdl.ir import BitSelect, LutNetwork, TruthTable, WisardModel, bits_to_codes, spread_codes
from wnn2hdl.ir.care import Everything
from wnn2hdl.lower import deforestation
from wnn2hdl.lower.table import care_set, pixel_table
from wnn2hdl.minimise import map_luts
from wnn2hdl.progress import Progress, reported
from wnn2hdl.training.bitselect import MOST_LUTS, look_up_table, select_bits
from wnn2hdl.training.comparisons import select_comparisons
from wnn2hdl.training.crossval import EXPOSURES, Trainer, cross_validate, shares_right
from wnn2hdl.training.folds import fold_count
from wnn2hdl.training.promise import light_figures
from wnn2hdl.wisard import choose_bleaching, draw_mapping, train_histogram

ADDRESS_BITS = 4
RAMS = 16
BITS_PER_CHANNEL = 4
"""The reference design's discriminators and pixel bits."""

FINALISTS = 3
"""The most accurate random mappings, whose circuits are made."""

SATURATION = 0.9

WITHIN = (7, 14)
"""LUTs per pixel that comparisons are looked for within: of one pair of channels, and of two. More than that
gained nothing on unseen images."""

LIGHT = "in_light"
"""Key in `WisardModel.training` of how accurate the classifier was in cross-validation, by exposure."""

NESTED = "nested"
"""Key in `WisardModel.training` of the methods that nested cross-validation chose in its folds."""

CARE_SHARES = (0.0, 1e-5, 1e-4, 1e-3)
"""Share of the training pixels that a code must make up to be cared for; 0 for every code that occurs."""


@dataclass(frozen=True, eq=False)
class Point:
    """A classifier, what it costs and what it is worth.

    Attributes:
        luts: LUTs per pixel of its exact circuit, as mapped.
        accuracy: share of the pixels right in cross-validation by image, 0 to 1.
        method: how it was trained.
        model: the same trained on all images.
        light: the same share for each image and each of `EXPOSURES`, float64 ``[images, exposures]``; None
            if it is not known.
    """

    luts: int
    accuracy: float
    method: str
    model: WisardModel
    light: NDArray[np.float64] | None = None

    @property
    def steady(self) -> float:
        """Mean share right over images and light."""
        return self.accuracy if self.light is None else float(self.light.mean())


def train_under_budget(
    dataset: Dataset,
    luts_per_pixel: int,
    *,
    trials: int,
    seed: int,
    progress: Progress,
    nested: bool = False,
) -> WisardModel:
    """The most accurate classifier whose exact circuit takes at most ``luts_per_pixel`` LUTs per pixel.

    It is the most accurate one on the mean over `EXPOSURES`, that is, in more and in less light. Among those
    that are equally accurate it is the one with the fewest LUTs; it is trained on all images.

    Args:
        dataset: at least two images; three if nested.
        luts_per_pixel: the budget, at least 1.
        trials: random mappings of the discriminators that are tried; 0 leaves them out.
        seed: of all that is random.
        progress: called with each image read and each candidate measured.
        nested: state the accuracy of the whole choice: it is made once more inside each fold, without the
            images that then judge it. Otherwise the images that choose the classifier also judge it.

    Raises:
        InputError: the images cannot be used, or nothing fits.
    """
    if luts_per_pixel < 1:
        raise InputError(
            "a classifier takes at least one LUT per pixel", value=luts_per_pixel, hint="allow 1 or more"
        )
    if nested and len(dataset) < 3:
        raise InputError("nested cross-validation needs three images", value=len(dataset), hint="give more")
    images = _read(dataset, progress)
    search = partial(
        _measure, classes=dataset.classes, luts_per_pixel=luts_per_pixel, trials=trials, seed=seed
    )
    best = _best(search(images, progress=progress), luts_per_pixel)
    assert best.light is not None
    light = best.light
    figures: dict[str, Any] = {"luts": best.luts, "cross_validated_accuracy": best.accuracy}
    if nested:
        inside: list[Point] = []

        def choose(chosen: Sequence[int]) -> WisardModel:
            progress("choosing in each fold", len(inside), fold_count(len(images)))
            points = search([images[i] for i in chosen], progress=_silent)
            inside.append(_best(points, luts_per_pixel))
            return inside[-1].model

        light = shares_right(images, choose)
        figures[NESTED] = [point.method for point in inside]
    figures |= {LIGHT: light_figures(light), "images": list(dataset.names)}
    return replace(best.model, training={**best.model.training, **figures})


def measure(
    dataset: Dataset, *, trials: int, seed: int, progress: Progress, luts_per_pixel: int | None = None
) -> tuple[Point, ...]:
    """All candidates with their costs and accuracies, for `pareto_front` and the plot.

    Candidates are bit selection at 1, 2 and 3 LUTs and comparisons of channels within each of `WITHIN`, that
    aim at the labels or at a smooth classifier (for two classes), and of the `trials` random mappings of
    the discriminators that do not saturate the `FINALISTS` most accurate: as exact circuits, and as circuits
    that are free outside of a care set taken from the training images. What such a circuit answers outside is
    part of the candidate, in cross-validation too: it becomes a plain look-up table.

    Args:
        dataset: at least two images; one is in memory at a time, and the colours of all.
        trials: random mappings that are tried.
        seed: of all that is random.
        progress: called with each image read and each candidate measured.
        luts_per_pixel: leaves out what is sure to cost more.

    Raises:
        InputError: the images cannot be used.
    """
    images = _read(dataset, progress)
    return _measure(
        images,
        classes=dataset.classes,
        luts_per_pixel=luts_per_pixel,
        trials=trials,
        seed=seed,
        progress=progress,
    )


def _read(dataset: Dataset, progress: Progress) -> list[ColourHistogram]:
    read = reported(dataset, "reading images", len(dataset), progress)
    return [colour_histogram(image, len(dataset.classes)) for image in read]


def _measure(
    images: Sequence[ColourHistogram],
    *,
    classes: tuple[str, ...],
    luts_per_pixel: int | None,
    trials: int,
    seed: int,
    progress: Progress,
) -> tuple[Point, ...]:
    methods = [*_bit_selections(images, classes, seed, luts_per_pixel)]
    methods += _comparisons(images, classes, seed, luts_per_pixel)
    methods += _discriminators(images, classes, trials, seed, progress)
    points = []
    for name, train in reported(methods, "measuring candidates", len(methods), progress):
        light = shares_right(images, train)
        pixels = np.array([image.counts.sum() for image in images])
        accuracy = float((light[:, EXPOSURES.index(1.0)] * pixels).sum() / pixels.sum())
        model = train(range(len(images)))
        points.append(Point(pixel_luts(model), accuracy, name, model, light))
    return tuple(points)


def _silent(step: str, done: int, total: int) -> None:
    """A choice inside a fold is one step of the whole."""


def _best(points: Sequence[Point], luts_per_pixel: int) -> Point:
    """The most accurate point of at most so many LUTs; raises InputError if there is none."""
    fitting = [point for point in points if point.luts <= luts_per_pixel]
    if not fitting:
        raise InputError(
            f"no classifier of at most {luts_per_pixel} LUTs per pixel was found",
            value=f"{len(points)} candidates",
            hint="allow more, or try more mappings",
        )
    return max(fitting, key=lambda point: (point.steady, -point.luts))


def pixel_luts(model: WisardModel) -> int:
    """LUTs of a pixel model's exact circuit, its comparisons included."""
    circuit = deforestation.pixel(model, Everything(model.encoder.width))
    tables = circuit.tables().values()
    return sum(
        len(map_luts(table.function).network.luts)
        for table in tables
        if isinstance(table.function, TruthTable)
    )


class Costed(Protocol):
    """What has a cost and an accuracy, as a `Point` has."""

    @property
    def luts(self) -> int:
        """What its circuit takes."""

    @property
    def accuracy(self) -> float:
        """Share right, 0 to 1."""


C = TypeVar("C", bound=Costed)


def pareto_front(points: Iterable[C]) -> tuple[C, ...]:
    """The points that no other equals or beats in both LUTs and accuracy, by rising LUTs."""
    front: list[C] = []
    for point in sorted(points, key=lambda point: (point.luts, -point.accuracy)):
        if not front or point.accuracy > front[-1].accuracy:
            front.append(point)
    return tuple(front)


def _bit_selections(
    images: Sequence[ColourHistogram], classes: tuple[str, ...], seed: int, luts_per_pixel: int | None
) -> Iterator[tuple[str, Trainer]]:
    if len(classes) != 2:
        return
    for luts in range(1, min(MOST_LUTS, luts_per_pixel or MOST_LUTS) + 1):

        def train(chosen: Sequence[int], luts: int = luts) -> WisardModel:
            return select_bits([images[i] for i in chosen], classes, luts=luts, seed=seed)

        yield f"bit selection, {luts} LUT", train


def _comparisons(
    images: Sequence[ColourHistogram], classes: tuple[str, ...], seed: int, luts_per_pixel: int | None
) -> Iterator[tuple[str, Trainer]]:
    if len(classes) != 2:
        return
    for luts, smooth in product(WITHIN, (False, True)):

        def train(chosen: Sequence[int], luts: int = luts, smooth: bool = smooth) -> WisardModel:
            return select_comparisons(
                [images[i] for i in chosen], classes, luts=luts, seed=seed, smooth=smooth
            )

        if luts_per_pixel is None or luts <= luts_per_pixel:
            yield f"comparisons{' of a smooth aim' if smooth else ''}, {luts} LUTs at most", train


def _discriminators(
    images: Sequence[ColourHistogram], classes: tuple[str, ...], trials: int, seed: int, progress: Progress
) -> list[tuple[str, Trainer]]:
    encoder = high_bits(BITS_PER_CHANNEL)
    histograms = np.stack([code_histogram(image, encoder) for image in images])
    ranked = []
    for trial in reported(range(trials), "drawing mappings", trials, progress):
        train = partial(train_discriminators, histograms, encoder, classes, seed + trial)
        if not saturates(train(range(len(images)))):
            ranked.append((-cross_validate(images, train), trial, train))
    ranked.sort(key=lambda entry: entry[:2])
    methods: list[tuple[str, Trainer]] = []
    for _, trial, train in ranked[:FINALISTS]:
        methods.append((f"WiSARD, seed {seed + trial}", train))
        methods += [
            (
                f"WiSARD, seed {seed + trial}, codes of {share:g} of the pixels",
                partial(train_circuit, histograms, train, share),
            )
            for share in CARE_SHARES
        ]
    return methods


def code_histogram(image: ColourHistogram, encoder: BitSelect) -> NDArray[np.int64]:
    """How often each code occurs in each class: int64 ``[classes, 2**width]``."""
    codes = encoder.codes(image.pixels)
    counts = [np.bincount(codes, row, 1 << encoder.width) for row in image.counts]
    return np.stack(counts).astype(np.int64)


def train_discriminators(
    histograms: NDArray[np.int64],
    encoder: BitSelect,
    classes: tuple[str, ...],
    seed: int,
    chosen: Sequence[int],
) -> WisardModel:
    """Discriminators of the reference design's size with a random mapping.

    Args:
        histograms: int64 ``[images, classes, 2**width]``.
        encoder: what made the codes.
        classes: class names.
        seed: of the mapping.
        chosen: the images to train on and to choose the bleaching threshold by.
    """
    mapping = draw_mapping(encoder.width, RAMS, ADDRESS_BITS, seed)
    threshold = choose_bleaching(histograms[list(chosen)], mapping)
    return train_histogram(
        histograms[list(chosen)].sum(axis=0),
        encoder,
        classes,
        mapping,
        threshold,
        {"method": "discriminators", "seed": seed},
    )


def saturates(model: WisardModel) -> bool:
    """Whether more than `SATURATION` of a discriminator's addresses fire: it says yes to nearly all."""
    return bool((model.saturation.mean(axis=1) > SATURATION).any())


def train_circuit(
    histograms: NDArray[np.int64], train: Trainer, share: float, chosen: Sequence[int]
) -> WisardModel:
    """A model as its circuit in domain mode answers, a plain look-up table over the bits the circuit reads.

    Args:
        histograms: int64 ``[images, classes, 2**width]``.
        train: makes the model.
        share: as in `CARE_SHARES`.
        chosen: the images to train on and to take the care set from.
    """
    model = train(chosen)
    seen = histograms[list(chosen)].sum(axis=(0, 1))
    care = care_set(seen, max(1, int(np.ceil(share * seen.sum()))))
    # Made again in every fold, so it must be quick; the table it becomes is mapped with more effort.
    network = map_luts(pixel_table(model, care), effort=0).network
    return circuit_model(model, network, {"care_share": share})


def circuit_model(model: WisardModel, network: LutNetwork, training: dict[str, float]) -> WisardModel:
    """A network made of a pixel model, as a model.

    Args:
        model: a pixel model.
        network: its circuit, with the outputs of `pixel_table`.
        training: what to record beside the model's own records.
    """
    read = {name for lut in network.luts for name in lut.inputs} | {mux.select for mux in network.muxes}
    read |= {signal for _, signal in network.outputs}
    # A constant circuit reads nothing, and a model reads one bit at least.
    kept = [x for x, name in enumerate(network.inputs) if name in read] or [0]
    # Outside of the care set a circuit of several outputs may name a class that does not exist.
    answers = np.minimum(bits_to_codes(network.evaluate(spread_codes(kept))), len(model.classes) - 1)
    encoder = BitSelect(tuple(model.encoder.names[x] for x in kept))
    return look_up_table(encoder, model.classes, answers, {**model.training, **training})
