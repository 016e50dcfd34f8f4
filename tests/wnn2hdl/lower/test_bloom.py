"""Bloom filters as tables, collapsed or by their hashes, answer as the model."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.small_networks import bloom, thermometer
from wnn2hdl.ir import ThermometerBits, codes_to_bits
from wnn2hdl.ir.models import BloomWisardModel
from wnn2hdl.ir.wires import Slice
from wnn2hdl.lower.structural import network
from wnn2hdl.verify.network import encoder_bits, stimulus


def few_members(seed: int) -> BloomWisardModel:
    return bloom(seed, entries=1024, density=0.1)


def is_the_model(model: BloomWisardModel) -> bool:
    features = stimulus(model.encoder)[::20]
    found = network(model).evaluate({"features": features})["class_bits"]
    expected = model.evaluate(encoder_bits(model.encoder, features))
    return np.array_equal(found @ (1 << np.arange(found.shape[1])), expected)


@given(st.integers(0, 10_000), st.sampled_from([16, 64, 1024]), st.floats(0, 1))
@settings(max_examples=30, deadline=None)
def test_filters_are_the_model(seed: int, entries: int, density: float) -> None:
    assert is_the_model(bloom(seed, entries=entries, density=density))


@given(st.integers(0, 10_000), st.sampled_from([16, 1024]))
@settings(max_examples=20, deadline=None)
def test_constant_and_equal_bits_of_a_thermometer_are_left_out_of_hashes(seed: int, entries: int) -> None:
    model = bloom(seed, encoder=thermometer(seed, features=6, thresholds=4), entries=entries)
    assert is_the_model(model)


def test_few_entries_are_looked_up_and_few_members_are_one_table() -> None:
    hashed, collapsed = network(bloom(1)).definitions(), network(few_members(1)).definitions()
    assert "hashes" in hashed
    assert "hashes" not in collapsed
    assert len(collapsed["tables"].nodes) == 6


def test_an_exclusive_or_says_of_which_bits_it_is() -> None:
    parts = network(bloom(1)).definitions()
    encoder, hashes = parts["encoder"], parts["hashes"]
    bits = np.random.default_rng(0).random((200, encoder.outputs[0].width)) < 0.5
    forms = hashes.evaluate({"bits": bits})["forms"]
    places = {number: bit.low for number, bit in encoder.carries.items() if isinstance(bit, Slice)}
    for mask, bit in hashes.carries.items():
        assert isinstance(bit, Slice)
        read = [places[number] for number in range(24) if mask >> number & 1]
        assert np.array_equal(forms[:, bit.low], bits[:, read].sum(axis=1) % 2 == 1)


def test_bits_that_cannot_occur_together_are_free() -> None:
    tables = network(few_members(2)).definitions()["tables"]
    cared = [int(table.function.care.sum()) for table in tables.tables().values()]  # type: ignore[union-attr]
    assert max(cared) < 1 << 12


def test_of_classes_that_are_equal_the_first_wins() -> None:
    features = np.zeros((1, 24), dtype=np.bool_)
    assert not network(bloom(3, density=0.0)).evaluate({"features": features})["class_bits"].any()


def test_inputs_beyond_a_table_are_looked_up() -> None:
    rng = np.random.default_rng(0)
    model = BloomWisardModel(
        ThermometerBits(24, 1),
        ("a", "b"),
        rng.permutation(24).reshape(1, 24).astype(np.int32),
        rng.integers(0, 16, (2, 24)).astype(np.uint32),
        rng.random((2, 1, 16)) < 0.6,
    )
    features = codes_to_bits(rng.integers(0, 1 << 24, 500), 24)
    found = network(model).evaluate({"features": features})["class_bits"][:, 0]
    assert np.array_equal(found, model.evaluate(features))
