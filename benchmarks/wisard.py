"""Training and prediction of 12-bit pixels, ours against rivals: ``python benchmarks/wisard.py``.

The rivals are scikit-learn's BernoulliNB on the same bits and, where it is installed, wisardpkg with the same
n and k, on fewer pixels since it is slow and takes Python lists. It builds with ``pip install pybind11
setuptools wheel`` and then ``pip install --no-build-isolation wisardpkg``. Rates are those of the fastest of
several runs, of wisardpkg's only one.
"""

import importlib
import importlib.util
import time
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray
from sklearn.naive_bayes import BernoulliNB

from wnn2hdl.encode import high_bits
from wnn2hdl.ir import codes_to_bits
from wnn2hdl.wisard import (
    PixelClassifier,
    WisardClassifier,
    choose_bleaching,
    draw_mapping,
    train_histogram,
)

PIXELS = 1_000_000
RIVAL_PIXELS = 20_000
IMAGES = 10
RAMS, ADDRESS_BITS = 16, 4
ENCODER = high_bits()
CLASSES = ("forest", "deforested")

Case = tuple[NDArray[np.uint8], NDArray[np.int64]]
Rates = tuple[float, float]


def pixels_and_labels() -> Case:
    """Two overlapping clouds of colours: uint8 ``[PIXELS, 3]`` and their classes ``[PIXELS]``."""
    rng = np.random.default_rng(0)
    labels = rng.integers(0, 2, PIXELS)
    centres = np.array([[50, 70, 45], [110, 100, 75]])
    pixels = centres[labels] + rng.normal(0, 18, (PIXELS, 3))
    return pixels.clip(0, 255).astype(np.uint8), labels


def rate(job: Callable[[], object], pixels: int, runs: int = 3) -> float:
    """Pixels per second of the fastest run."""
    seconds = []
    for _ in range(runs):
        start = time.perf_counter()
        job()
        seconds.append(time.perf_counter() - start)
    return pixels / min(seconds)


def by_histogram(pixels: NDArray[np.uint8], labels: NDArray[np.int64]) -> PixelClassifier:
    """From pixels to a classifier: codes, histograms, bleaching by image, counts, table."""
    codes, size = ENCODER.codes(pixels), 1 << ENCODER.width
    parts = zip(np.array_split(codes, IMAGES), np.array_split(labels, IMAGES), strict=True)
    histograms = np.stack([np.bincount(y * size + x, minlength=2 * size).reshape(2, size) for x, y in parts])
    mapping = draw_mapping(ENCODER.width, RAMS, ADDRESS_BITS, seed=0)
    bleaching = choose_bleaching(histograms, mapping)
    return PixelClassifier(train_histogram(histograms.sum(axis=0), ENCODER, CLASSES, mapping, bleaching))


def our_pixels(pixels: NDArray[np.uint8], labels: NDArray[np.int64]) -> Iterator[tuple[str, Rates]]:
    """The pixel classifier, from RGB and from codes."""
    classifier = by_histogram(pixels, labels)
    codes = ENCODER.codes(pixels)
    training = rate(lambda: by_histogram(pixels, labels), PIXELS)
    yield "wnn2hdl, RGB pixels", (training, rate(lambda: classifier.classify(pixels), PIXELS, 9))
    yield "wnn2hdl, 12-bit codes", (training, rate(lambda: np.take(classifier.table, codes), PIXELS, 9))


def estimator(model: WisardClassifier | BernoulliNB, bits: NDArray[np.bool_], y: NDArray[np.int64]) -> Rates:
    """A scikit-learn estimator on bits ``[samples, 12]``."""
    return rate(lambda: model.fit(bits, y), len(y)), rate(lambda: model.predict(bits), len(y))


def wisardpkg(bits: NDArray[np.bool_], labels: NDArray[np.int64]) -> Rates:
    """The package's `Wisard` on Python lists, which is what it takes; bleaching is on by default."""
    package = importlib.import_module("wisardpkg")
    rows, names = bits.astype(int).tolist(), [CLASSES[label] for label in labels]

    # Its mapping covers each input once, so k RAMs of n bits take the inputs several times over.
    wide = [(row * (RAMS * ADDRESS_BITS // len(row) + 1))[: RAMS * ADDRESS_BITS] for row in rows]
    network = package.Wisard(ADDRESS_BITS)
    training = rate(lambda: network.train(wide, names), len(rows), runs=1)
    return training, rate(lambda: network.classify(wide), len(rows), runs=1)


def main() -> None:
    """Print rates, then ratios of the pixel classifier to each rival."""
    pixels, labels = pixels_and_labels()
    bits = codes_to_bits(ENCODER.codes(pixels), ENCODER.width)
    rates = dict(our_pixels(pixels, labels))
    rates["wnn2hdl, WisardClassifier"] = estimator(WisardClassifier(ADDRESS_BITS, RAMS), bits, labels)
    rates["scikit-learn, BernoulliNB"] = estimator(BernoulliNB(), bits, labels)
    if importlib.util.find_spec("wisardpkg"):
        rates["wisardpkg, Wisard"] = wisardpkg(bits[:RIVAL_PIXELS], labels[:RIVAL_PIXELS])
    ours = rates["wnn2hdl, RGB pixels"]
    print(f"{'million pixels per second':28}{'train':>10}{'predict':>10}{'ours is faster by':>24}")
    for name, (training, prediction) in rates.items():
        ratio = f"{ours[0] / training:12.1f} {ours[1] / prediction:11.1f}"
        print(f"{name:28}{training / 1e6:10.3f}{prediction / 1e6:10.3f}{ratio}")


if __name__ == "__main__":
    main()
