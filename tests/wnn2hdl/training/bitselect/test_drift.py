import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.training.bitselect.drift import (
    STEPS,
    WIDTH,
    Colours,
    blurred,
    main_drift,
    merged,
    packed,
    unpacked,
)


def test_drift_is_the_main_axis_of_the_mean_colours_as_long_as_their_standard_deviation() -> None:
    axis = np.array([2.0, 1.0, 2.0]) / 3
    means = 60 + np.outer([-3.0, 0.0, 3.0], axis)
    drift = main_drift(means)
    np.testing.assert_allclose(np.abs(drift), 3 * axis)


def test_fewer_than_three_images_show_no_drift() -> None:
    assert not main_drift(np.array([[10.0, 20, 30], [40, 50, 60]])).any()
    assert not main_drift(np.zeros((0, 3))).any()


def test_equal_colours_are_summed() -> None:
    colours = merged(np.array([5, 3, 5]), np.array([[1.0, 2, 3], [0, 1, 0]]))
    assert colours.rgb.tolist() == [[0, 0, 3], [0, 0, 5]]
    assert colours.weights.tolist() == [[2, 4], [1, 0]]


def test_blur_spreads_a_colour_symmetrically_along_the_drift() -> None:
    one = Colours(np.array([[100, 100, 100]]), np.array([[8.0], [0]]))
    spread = blurred(one, np.array([4.0, 0, 0]))
    offsets = np.rint(WIDTH * STEPS * 4).astype(int)
    assert spread.rgb[:, 0].tolist() == (100 + offsets).tolist()
    assert (spread.rgb[:, 1:] == 100).all()
    np.testing.assert_allclose(spread.weights[0], spread.weights[0, ::-1])
    assert spread.weights[0].argmax() == len(STEPS) // 2


def test_blur_without_drift_changes_nothing() -> None:
    colours = Colours(np.array([[1, 2, 3], [255, 0, 7]]), np.array([[5.0, 1], [0, 2]]))
    same = blurred(colours, np.zeros(3))
    assert same.rgb.tolist() == colours.rgb.tolist()
    np.testing.assert_allclose(same.weights, colours.weights)


@given(
    st.lists(st.tuples(*[st.integers(0, 255)] * 3), min_size=1, max_size=5, unique=True),
    st.tuples(*[st.floats(-60, 60)] * 3),
)
def test_blur_keeps_the_weight_of_each_class_and_the_range_of_a_channel(
    rgb: list[tuple[int, int, int]], drift: tuple[float, float, float]
) -> None:
    weights = np.arange(2.0 * len(rgb)).reshape(2, -1)
    spread = blurred(Colours(np.array(rgb), weights), np.array(drift))
    np.testing.assert_allclose(spread.weights.sum(axis=1), weights.sum(axis=1))
    assert spread.rgb.min() >= 0
    assert spread.rgb.max() <= 255


@given(st.integers(0, 0xFFFFFF))
def test_packing_is_undone_by_unpacking(colour: int) -> None:
    assert packed(unpacked(np.array([colour]))).tolist() == [colour]
