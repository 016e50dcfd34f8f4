"""Tables over a pixel and its neighbours, chosen from windows."""

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.ir import Neighbourhood, TruthTable, WisardModel
from wnn2hdl.minimise import map_luts
from wnn2hdl.training.bitselect import LUTS, select_neighbourhood

CLASSES = ("dark", "bright")


def noisy_windows(samples: int, seed: int) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """Windows around red 60 or 90, each pixel with noise that hides the class from a single look."""
    rng = np.random.default_rng(seed)
    labels = rng.integers(2, size=samples).astype(np.uint8)
    colours = np.array([[60, 60, 60], [90, 60, 60]])[labels]
    windows = colours[:, np.newaxis, np.newaxis] + rng.normal(0, 20, (samples, 3, 3, 3))
    return np.clip(windows, 0, 255).astype(np.uint8), labels


def select(windows: NDArray[np.uint8], labels: NDArray[np.uint8], **options: tuple[str, ...]) -> WisardModel:
    classes = options.get("classes", CLASSES)
    return select_neighbourhood(windows, labels, np.zeros(3), classes, seed=0, progress=lambda *_: None)


@pytest.fixture(scope="module")
def model() -> WisardModel:
    return select(*noisy_windows(4000, 0))


def accuracy(model: WisardModel, windows: NDArray[np.uint8], labels: NDArray[np.uint8]) -> float:
    assert isinstance(model.encoder, Neighbourhood)
    return float((model.evaluate_all_codes()[model.encoder.codes(windows)[:, 0, 0]] == labels).mean())


def test_neighbours_tell_more_than_the_pixel_alone(model: WisardModel) -> None:
    windows, labels = noisy_windows(4000, 1)
    best_single = max(((windows[:, 1, 1, 0] > threshold) == labels).mean() for threshold in range(40, 120))
    assert accuracy(model, windows, labels) > best_single + 0.08


def test_it_takes_the_luts_that_it_says(model: WisardModel) -> None:
    encoder = model.encoder
    assert isinstance(encoder, Neighbourhood)
    tables = [TruthTable.exact(tap.pixel.names, ("y",), tap.table[:, np.newaxis]) for tap in encoder.taps]
    luts = [len(map_luts(table).network.luts) for table in tables]
    assert max(luts) <= 2
    assert sum(luts) + 1 <= LUTS == 13
    assert (encoder.size, encoder.width) == (3, 6)
    assert [(tap.row, tap.column) for tap in encoder.taps[:2]] == [(1, 1), (1, 1)]


def test_a_tap_reads_only_bits_that_matter(model: WisardModel) -> None:
    assert isinstance(model.encoder, Neighbourhood)
    for tap in model.encoder.taps:
        codes = np.arange(len(tap.table))
        for bit in range(tap.pixel.width):
            assert (tap.table[codes] != tap.table[codes ^ 1 << bit]).any()


def test_the_same_windows_give_the_same_model(model: WisardModel) -> None:
    assert select(*noisy_windows(4000, 0)).digest() == model.digest()


def test_what_cannot_be_learned_is_refused() -> None:
    windows, labels = noisy_windows(50, 0)
    with pytest.raises(InputError, match="separates two classes"):
        select(windows, labels, classes=("a", "b", "c"))
    with pytest.raises(InputError, match="no training pixels: bright"):
        select(windows, np.zeros_like(labels))
    with pytest.raises(InputError, match="3x3 or 5x5"):
        select(windows[:, :2, :2], labels)
