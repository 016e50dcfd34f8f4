"""Adam as it was published, and its short form."""

import numpy as np

from wnn2hdl.training.gradient.adam import Adam


def test_the_first_step_is_the_rate_whatever_the_scale() -> None:
    for scale in (1e-3, 1.0, 1e6):
        array = np.zeros((1, 2), dtype=np.float32)
        Adam(array.shape).step(array, np.array([[scale, -scale]], dtype=np.float32), 0.1)
        assert np.allclose(array, [[-0.1, 0.1]], rtol=1e-3)


def test_three_steps_by_hand() -> None:
    array, adam = np.zeros((1, 1), dtype=np.float32), Adam((1, 1))
    mean = square = position = 0.0
    for step, gradient in enumerate((1.0, -3.0, 2.0), start=1):
        adam.step(array, np.full((1, 1), gradient, np.float32), 0.1)
        mean, square = 0.9 * mean + 0.1 * gradient, 0.999 * square + 0.001 * gradient**2
        position -= 0.1 * mean / (1 - 0.9**step) / np.sqrt(square / (1 - 0.999**step))
    assert abs(array[0, 0] - position) < 1e-5


def test_rows_may_share_a_scale() -> None:
    array, adam = np.zeros((2, 2), dtype=np.float32), Adam((2, 2), by_row=True)
    adam.step(array, np.array([[3, 4], [0.3, 0.4]], dtype=np.float32), 1.0)
    assert np.allclose(array, -np.array([[3, 4], [3, 4]]) / np.sqrt(12.5), rtol=1e-4)


def test_a_state_that_was_saved_goes_on_as_it_was() -> None:
    rng = np.random.default_rng(0)
    gradients = rng.normal(size=(4, 3, 2)).astype(np.float32)
    for by_row in (False, True):
        array, adam = np.zeros((3, 2), dtype=np.float32), Adam((3, 2), by_row=by_row)
        for gradient in gradients[:2]:
            adam.step(array, gradient, 0.1)
        copy, again = array.copy(), Adam.of({name: part.copy() for name, part in adam.arrays().items()})
        for gradient in gradients[2:]:
            adam.step(array, gradient, 0.1)
            again.step(copy, gradient, 0.1)
        assert np.array_equal(array, copy)
