"""The Sobel baseline."""

import numpy as np
import pytest

from hdl_templates.sobel import MAXIMUM, Parameters
from wnn2hdl.verify.simulation import simulate


def windows() -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
    """Random greys, faint steps around the threshold, and all corners of black and white."""
    rng = np.random.default_rng(7)
    corners = (np.arange(512)[:, np.newaxis] >> np.arange(9) & 1) * 255
    flat = np.clip(rng.integers(0, 256, (2000, 1)) + rng.integers(-30, 31, (2000, 9)), 0, 255)
    return np.concatenate([rng.integers(0, 256, (1000, 9)), corners, flat]).astype(np.uint8)


def test_the_golden_model_is_the_definition() -> None:
    step = np.array([[0, 0, 32, 0, 0, 32, 0, 0, 32], [0, 0, 32, 0, 0, 31, 0, 0, 32]], dtype=np.uint8)
    assert Parameters(128).compute(step).tolist() == [True, False]


@pytest.mark.parametrize("threshold", [1, 2, 127, 128, 129, 500, 1530, 1531, MAXIMUM])
def test_the_circuit_equals_the_golden_model(threshold: int) -> None:
    parameters = Parameters(threshold)
    greys = windows()
    expected = parameters.compute(greys)
    assert threshold > 1000 or 0 < expected.sum() < len(expected)
    bits = np.unpackbits(greys, axis=1, bitorder="little").astype(np.bool_)
    simulate(parameters.create(), {"window": bits}, {"edge_bit": expected[:, np.newaxis]})


@pytest.mark.parametrize("threshold", [0, MAXIMUM + 1])
def test_a_threshold_out_of_reach_is_refused(threshold: int) -> None:
    with pytest.raises(ValueError, match="lies between 1 and 2040"):
        Parameters(threshold)
