"""Reference Verilog: evaluated by Yosys, it is the model in NumPy."""

import re
from types import ModuleType

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wnn2hdl.ir import EdgeFilter, WisardModel
from wnn2hdl.ir.wires import word_values
from wnn2hdl.verify.equivalence import Circuit, evaluate
from wnn2hdl.verify.reference import lookup
from wnn2hdl.verify.specification import Claim, Specification, value_bits
from wnn2hdl.verify.specify import specify


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


def verilog_says(specification: Specification, claim: Claim, inputs: dict[str, int]) -> dict[str, int]:
    """What the reference module answers, by Yosys."""
    return evaluate(
        Circuit((specification.reference,), claim.module), inputs, claim.inputs, list(claim.outputs)
    )


def model_says(claim: Claim, inputs: dict[str, int]) -> dict[str, int]:
    """What the model answers."""
    samples = {port: value_bits(value, claim.inputs[port]) for port, value in inputs.items()}
    return {port: word_values(bits)[0] for port, bits in claim.answers(samples).items()}


def random_inputs(claim: Claim, count: int) -> list[dict[str, int]]:
    rng = np.random.default_rng(0)
    return [
        {port: int.from_bytes(rng.bytes(32)) % (1 << width) for port, width in claim.inputs.items()}
        for _ in range(count)
    ]


@pytest.mark.parametrize("classes", [2, 3, 5])
def test_the_reference_pixel_says_what_the_model_says(circuits: ModuleType, classes: int) -> None:
    specification = circuits.exact(circuits.random_block(classes, classes=classes))
    claim = specification.claims["pixel"]
    for inputs in random_inputs(claim, 6):
        assert verilog_says(specification, claim, inputs) == model_says(claim, inputs)


def test_among_equal_responses_the_class_named_first_wins(circuits: ModuleType) -> None:
    model = circuits.random_block(0, classes=3).model
    never_fires = WisardModel(model.encoder, model.classes, model.mapping, model.counts * 0, 1)
    specification = specify(never_fires, None, {})
    found = verilog_says(specification, specification.claims["pixel"], {"rgb": 0x123456})
    assert found == {"class_bits": 0}


def test_each_class_may_have_a_mapping_of_its_own(circuits: ModuleType) -> None:
    shared = circuits.random_block(3).model
    mapping = np.concatenate([shared.mapping, 5 - shared.mapping])
    own = WisardModel(shared.encoder, shared.classes, mapping, shared.counts, 1)
    specification = specify(own, None, {})
    claim = specification.claims["pixel"]
    for word in (0x000000, 0xC0C020, 0x80C000, 0x40F00F):
        assert verilog_says(specification, claim, {"rgb": word}) == model_says(claim, {"rgb": word})


@pytest.mark.parametrize("part", ["edge", "match", "block", "block_match"])
def test_the_reference_of_each_circuit_says_what_the_model_says(circuits: ModuleType, part: str) -> None:
    specification = circuits.exact(circuits.random_block(4, classes=3))
    claim = specification.claims[part]
    for inputs in random_inputs(claim, 3):
        assert verilog_says(specification, claim, inputs) == model_says(claim, inputs)


def test_the_reference_neighbourhood_says_what_the_model_says(circuits: ModuleType) -> None:
    specification = circuits.exact(circuits.random_neighbours(5, classes=3))
    claim = specification.claims["neighbourhood"]
    for inputs in random_inputs(claim, 6):
        assert verilog_says(specification, claim, inputs) == model_says(claim, inputs)


def test_the_care_modules_are_the_care_sets(circuits: ModuleType) -> None:
    block = circuits.random_block(5, care=0.4)
    specification = circuits.specification(block)
    claim = specification.claims["pixel"]
    for inputs in random_inputs(claim, 6):
        care = Circuit((specification.care,), "proof__care_pixel")
        found = evaluate(care, {"free": inputs["rgb"]}, {"free": 24}, ["rgb"])
        held = claim.hold({"rgb": value_bits(inputs["rgb"], 24)})
        assert found == {"rgb": word_values(held["rgb"])[0]}
    for window in (0, 100, 511):
        care = Circuit((specification.care,), "proof__care_window")
        assert evaluate(care, {"bits": window}, {"bits": 9}, ["cared"]) == {
            "cared": int(block.window_care[window])
        }


def test_the_care_module_of_a_neighbourhood_is_its_care_set(circuits: ModuleType) -> None:
    neighbours = circuits.random_neighbours(5, care=0.5)
    specification = circuits.specification(neighbours)
    care = Circuit((specification.care,), "proof__care_neighbourhood")
    for inputs in random_inputs(specification.claims["neighbourhood"], 6):
        cared = neighbours.cared({"window": value_bits(inputs["window"], 216)})
        assert evaluate(care, inputs, {"window": 216}, ["cared"]) == {"cared": int(cared[0, 0])}


def test_an_edge_filter_without_patterns_never_finds_an_edge(circuits: ModuleType) -> None:
    empty = EdgeFilter("none", np.zeros(512, dtype=np.bool_))
    specification = specify(circuits.random_block(0).model, empty, {})
    assert verilog_says(specification, specification.claims["edge"], {"bits": 16}) == {"edge_bit": 0}
