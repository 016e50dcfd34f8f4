"""The specification: the model as the judge of circuits."""

from types import ModuleType

import numpy as np
import pytest

from wnn2hdl.errors import InputError
from wnn2hdl.ir import Thermometer, WisardModel
from wnn2hdl.verify.specification import (
    NeighbourhoodSpecification,
    Specification,
    pixels_to_word,
    word_to_pixels,
)


def test_a_window_port_holds_pixel_0_in_its_low_bits_and_red_in_each_pixels_high_byte() -> None:
    pixels = np.arange(27, dtype=np.uint8).reshape(9, 3)
    word = pixels_to_word(pixels)
    assert word & 0xFFFFFF == 0x000102
    assert word >> 24 * 8 == 0x18191A
    assert np.array_equal(word_to_pixels(word, 9), pixels)


def test_the_block_is_pixels_then_edge_filter_and_match_count(circuits: ModuleType) -> None:
    specification = circuits.random_specification(0, classes=3)
    window = np.random.default_rng(0).integers(0, 256, (50, 9, 3), dtype=np.uint8)
    reference = np.arange(50)
    outputs = specification.evaluate("block_match", {"window": window, "reference": reference})
    for sample in range(50):
        classes = specification.evaluate("pixel", {"rgb": window[sample]})["class_bits"]
        bits = sum(1 << i for i in range(9) if classes[i])
        assert outputs["bits"][sample] == bits
        assert outputs["edge_bit"][sample] == specification.edge_filter.patterns[bits]
        assert outputs["match_count"][sample] == 9 - (bits ^ sample).bit_count()


def test_nearest_cared_leaves_the_care_set_alone_and_never_leaves_it(circuits: ModuleType) -> None:
    specification = circuits.random_specification(1, care=0.3)
    pixels = np.random.default_rng(0).integers(0, 256, (500, 3), dtype=np.uint8)
    cared = specification.pixel_care[circuits.ENCODER.codes(pixels)]
    held = specification.nearest_cared(pixels)
    assert np.array_equal(held[cared], pixels[cared])
    assert specification.pixel_care[circuits.ENCODER.codes(held)].all()
    assert not cared.all()


def test_an_empty_care_set_is_refused_since_any_circuit_would_pass(circuits: ModuleType) -> None:
    exact = circuits.random_specification(0)
    with pytest.raises(InputError, match="care set is empty"):
        Specification(exact.model, exact.edge_filter, np.zeros(64, dtype=np.bool_), exact.window_care)
    with pytest.raises(InputError, match="care set is empty"):
        Specification(exact.model, exact.edge_filter, exact.pixel_care, np.zeros(512, dtype=np.bool_))


def test_a_model_of_features_is_no_pixel_model(circuits: ModuleType) -> None:
    mapping = np.zeros((1, 1, 1), dtype=np.int64)
    counts = np.zeros((2, 1, 2), dtype=np.int64)
    model = WisardModel(Thermometer(((0.5,),)), ("a", "b"), mapping, counts, 1)
    with pytest.raises(InputError, match="selects pixel bits: thermometer"):
        Specification.exact(model, circuits.random_specification(0).edge_filter)


def test_a_neighbourhood_is_its_model_on_every_window(circuits: ModuleType) -> None:
    specification = circuits.random_neighbourhood(5, classes=3)
    windows = np.random.default_rng(0).integers(0, 256, (200, 9, 3), dtype=np.uint8)
    answers = specification.evaluate("neighbourhood", {"window": windows})["class_bits"]
    codes = [int(specification.encoder.codes(window.reshape(3, 3, 3))[0, 0]) for window in windows]
    assert answers.tolist() == specification.model.evaluate_all_codes()[codes].tolist()
    assert specification.part("neighbourhood").inputs == {"window": 216}
    assert specification.part("neighbourhood").outputs == {"class_bits": 2}


def test_a_neighbourhood_needs_a_model_of_one_and_something_to_prove(circuits: ModuleType) -> None:
    neighbourhood, pixel = circuits.random_neighbourhood(5), circuits.random_specification(0)
    with pytest.raises(InputError, match="does not look at neighbours"):
        NeighbourhoodSpecification(pixel.model, pixel.pixel_care)
    with pytest.raises(InputError, match="nothing to prove"):
        NeighbourhoodSpecification(neighbourhood.model, np.zeros(32, dtype=np.bool_))
    with pytest.raises(ValueError, match="does not fit the model"):
        NeighbourhoodSpecification(neighbourhood.model, np.ones(16, dtype=np.bool_))
    with pytest.raises(InputError, match="selects pixel bits"):
        Specification.exact(neighbourhood.model, pixel.edge_filter)
