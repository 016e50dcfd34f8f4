"""The claim about a classifier of a pixel and its neighbours."""

from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import bits_to_codes
from wnn2hdl.ir.pixels import pixel_bits


def random_windows(count: int) -> NDArray[np.uint8]:
    return np.random.default_rng(0).integers(0, 256, (count, 9, 3), dtype=np.uint8)


def test_a_neighbourhood_is_its_model_on_every_window(circuits: ModuleType) -> None:
    neighbours = circuits.random_neighbours(5, classes=3)
    claim = circuits.specification(neighbours).claims["neighbourhood"]
    windows = random_windows(200)
    answers = bits_to_codes(claim.answers({"window": pixel_bits(windows)})["class_bits"])
    codes = [int(neighbours.encoder.codes(window.reshape(3, 3, 3))[0, 0]) for window in windows]
    assert answers.tolist() == neighbours.model.evaluate_all_codes()[codes].tolist()
    assert claim.inputs == {"window": 216}
    assert claim.outputs == {"class_bits": 2}


def test_windows_are_cared_for_by_their_code(circuits: ModuleType) -> None:
    neighbours = circuits.random_neighbours(5, care=0.5)
    claim = circuits.specification(neighbours).claims["neighbourhood"]
    windows = {"window": pixel_bits(random_windows(200))}
    cared = claim.cared(windows)
    assert cared.shape == (200, 1)
    assert np.array_equal(cared[:, 0], neighbours.care[neighbours.codes(windows["window"])])
    assert 0 < cared.sum() < 200
