"""Reference Verilog: evaluated by Yosys, it is the model in NumPy."""

import re
from types import ModuleType

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wnn2hdl.ir import WisardModel
from wnn2hdl.verify.equivalence import Circuit, evaluate
from wnn2hdl.verify.reference import care_verilog, lookup, reference_name, reference_verilog
from wnn2hdl.verify.specification import Specification, pixels_to_word


@given(
    st.integers(0, 6).flatmap(lambda width: st.lists(st.booleans(), min_size=1 << width, max_size=1 << width))
)
@settings(deadline=None)
def test_a_lookup_is_its_contents_at_every_address(contents: list[bool]) -> None:
    width = len(contents).bit_length() - 1
    lines, answer = lookup("n", np.array(contents, dtype=np.bool_), [f"a{i}" for i in range(width)])
    for address, expected in enumerate(contents):
        wires = {f"a{i}": bool(address >> i & 1) for i in range(width)} | {"1'b0": False, "1'b1": True}
        for line in lines:
            match = re.fullmatch(r"  wire (\S+) = (\S+) \? (\S+) : (\S+);", line)
            assert match is not None
            name, select, high, low = match.groups()
            wires[name] = wires[high] if wires[select] else wires[low]
        assert wires[answer] == expected


@pytest.mark.parametrize("classes", [2, 3, 5])
def test_the_reference_pixel_says_what_the_model_says(circuits: ModuleType, classes: int) -> None:
    specification = circuits.random_specification(classes, classes=classes)
    circuit = Circuit((reference_verilog(specification),), reference_name("pixel"))
    pixels = np.random.default_rng(0).integers(0, 256, (6, 3), dtype=np.uint8)
    expected = specification.evaluate("pixel", {"rgb": pixels})["class_bits"]
    for pixel, answer in zip(pixels, expected, strict=True):
        found = evaluate(circuit, {"rgb": pixels_to_word(pixel)}, {"rgb": 24}, ["class_bits"])
        assert found == {"class_bits": answer}


def test_among_equal_responses_the_class_named_first_wins(circuits: ModuleType) -> None:
    model = circuits.random_specification(0, classes=3).model
    never_fires = WisardModel(model.encoder, model.classes, model.mapping, model.counts * 0, 1)
    specification = Specification.exact(never_fires, circuits.random_specification(0).edge_filter)
    circuit = Circuit((reference_verilog(specification),), reference_name("pixel"))
    assert evaluate(circuit, {"rgb": 0x123456}, {"rgb": 24}, ["class_bits"]) == {"class_bits": 0}


def test_each_class_may_have_a_mapping_of_its_own(circuits: ModuleType) -> None:
    shared = circuits.random_specification(3).model
    mapping = np.concatenate([shared.mapping, 5 - shared.mapping])
    own = WisardModel(shared.encoder, shared.classes, mapping, shared.counts, 1)
    specification = Specification.exact(own, circuits.random_specification(3).edge_filter)
    circuit = Circuit((reference_verilog(specification),), reference_name("pixel"))
    for word in (0x000000, 0xC0C020, 0x80C000, 0x40F00F):
        samples = {"rgb": np.array([[word >> 16, word >> 8 & 255, word & 255]], dtype=np.uint8)}
        answer = int(specification.evaluate("pixel", samples)["class_bits"][0])
        assert evaluate(circuit, {"rgb": word}, {"rgb": 24}, ["class_bits"]) == {"class_bits": answer}


def test_the_reference_block_says_what_the_model_says(circuits: ModuleType) -> None:
    specification = circuits.random_specification(4, classes=3)
    ports = specification.part("block_match")
    circuit = Circuit((reference_verilog(specification),), reference_name("block_match"))
    window = np.random.default_rng(1).integers(0, 256, (3, 9, 3), dtype=np.uint8)
    reference = np.array([0, 0b101010101, 511])
    expected = specification.evaluate("block_match", {"window": window, "reference": reference})
    for sample in range(3):
        values = {"window": pixels_to_word(window[sample]), "reference": int(reference[sample])}
        found = evaluate(circuit, values, ports.inputs, list(ports.outputs))
        assert found == {port: int(answers[sample]) for port, answers in expected.items()}


def test_care_pixel_is_nearest_cared_and_care_window_the_window_care_set(circuits: ModuleType) -> None:
    specification = circuits.random_specification(5, care=0.4)
    verilog = care_verilog(specification)
    pixels = np.random.default_rng(2).integers(0, 256, (6, 3), dtype=np.uint8)
    for pixel in pixels:
        found = evaluate(
            Circuit((verilog,), "care_pixel"), {"free": pixels_to_word(pixel)}, {"free": 24}, ["rgb"]
        )
        assert found == {"rgb": pixels_to_word(specification.nearest_cared(pixel))}
    for window in (0, 100, 511):
        found = evaluate(Circuit((verilog,), "care_window"), {"bits": window}, {"bits": 9}, ["cared"])
        assert found == {"cared": int(specification.window_care[window])}
