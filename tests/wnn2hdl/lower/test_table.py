import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from wnn2hdl.encode import high_bits, parse_bits
from wnn2hdl.errors import InputError
from wnn2hdl.ir import Encoder, Thermometer, WisardModel, codes_to_bits
from wnn2hdl.lower.table import care_set, code_histogram, pixel_table

small_images = arrays(
    np.uint8, st.tuples(st.integers(1, 6), st.integers(1, 6), st.just(3)), elements=st.integers(0, 255)
)
histograms = arrays(np.int64, 16, elements=st.integers(0, 9)).filter(np.any)


def one_ram(encoder: Encoder, winner: list[int], classes: int) -> WisardModel:
    """A model whose one RAM a class reads every bit: the table of ``winner`` itself."""
    counts = np.zeros((classes, 1, len(winner)), dtype=np.int64)
    counts[winner, 0, np.arange(len(winner))] = 1
    names = tuple(f"class {i}" for i in range(classes))
    return WisardModel(encoder, names, np.arange(encoder.width).reshape(1, 1, -1), counts, 1)


def test_two_classes_have_one_output() -> None:
    table = pixel_table(one_ram(parse_bits("R7,B6"), [0, 1, 1, 0], classes=2))
    assert table.inputs == ("R7", "B6")
    assert table.outputs == ("class_bit0",)
    assert table.values[:, 0].tolist() == [False, True, True, False]
    assert table.care.all()


@given(
    st.integers(2, 9).flatmap(
        lambda c: st.tuples(st.just(c), st.lists(st.integers(0, c - 1), min_size=8, max_size=8))
    )
)
def test_the_class_index_is_written_in_binary_least_significant_first(case: tuple[int, list[int]]) -> None:
    classes, winner = case
    table = pixel_table(one_ram(parse_bits("R7,G7,B7"), winner, classes))
    assert 2 ** (len(table.outputs) - 1) < classes <= 2 ** len(table.outputs)
    assert (table.values @ (1 << np.arange(len(table.outputs)))).tolist() == winner


def test_the_care_set_goes_along() -> None:
    care = np.array([True, False, False, True])
    table = pixel_table(one_ram(parse_bits("R7,B6"), [0, 1, 1, 0], classes=2), care)
    assert np.array_equal(table.care, care)


def test_a_model_of_thermometer_bits_has_a_table_too() -> None:
    table = pixel_table(one_ram(Thermometer(((0.5, 1.5),)), [0, 0, 0, 1], classes=2))
    assert table.inputs == ("x0_t0", "x0_t1")
    assert table.values[:, 0].tolist() == [False, False, False, True]


def test_more_bits_than_a_table_may_have() -> None:
    counts = np.ones((2, 1, 2), dtype=np.int64)
    model = WisardModel(high_bits(7), ("a", "b"), np.zeros((1, 1, 1), dtype=np.int64), counts, 1)
    line = "too many input bits for one truth table: 21 bits; choose at most 20"
    with pytest.raises(InputError, match=line):
        pixel_table(model)
    with pytest.raises(InputError, match=line):
        code_histogram(high_bits(7), [])


@given(st.lists(small_images, max_size=4))
def test_every_pixel_is_counted_once(images: list[NDArray[np.uint8]]) -> None:
    encoder = parse_bits("R7,G6,B0,G7")
    expected = np.zeros(16, dtype=np.int64)
    for image in images:
        for pixel in image.reshape(-1, 3):
            expected[encoder.codes(pixel)] += 1
    assert np.array_equal(code_histogram(encoder, iter(images)), expected)


@given(histograms, st.integers(1, 9))
def test_the_care_set_holds_what_occurs_often_enough(histogram: NDArray[np.int64], minimum: int) -> None:
    if histogram.max() < minimum:
        with pytest.raises(InputError, match=f"{minimum} times asked, {histogram.max()} at most seen"):
            care_set(histogram, minimum)
        return
    assert care_set(histogram, minimum).tolist() == [count >= minimum for count in histogram.tolist()]


def test_a_care_set_of_everything_is_not_asked_for() -> None:
    with pytest.raises(InputError, match="so few occurrences: 0; ask for 1 or more"):
        care_set(np.ones(4, dtype=np.int64), 0)


def test_the_table_answers_as_the_model_does() -> None:
    rng = np.random.default_rng(3)
    model = WisardModel(
        high_bits(2), ("a", "b", "c"), rng.integers(0, 6, (3, 5, 2)), rng.integers(0, 4, (3, 5, 4)), 2
    )
    table = pixel_table(model)
    pixels = rng.integers(0, 256, (200, 3)).astype(np.uint8)
    codes = model.encoder.codes(pixels)  # type: ignore[union-attr]
    winner = model.evaluate(codes_to_bits(codes, 6))
    assert np.array_equal(table.evaluate(codes) @ [1, 2], winner)
