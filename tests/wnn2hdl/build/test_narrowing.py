"""Thresholds move to coarser numbers as long as hardly any answer changes, and every count is true."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.small_networks import encoder_of, lut_network
from wnn2hdl.build.narrowing import Narrowed, encoder_luts, narrow_features, narrow_formats
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.rows import feature_answers
from wnn2hdl.importers import ImportOptions, import_model
from wnn2hdl.ir import Thermometer, WisardModel, Words
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.ir.models import LutGroupModel, LutLayer


def silent(step: str, done: int, total: int) -> None:
    pass


def wide(seed: int = 2, *, input: FixedPoint | None = None) -> LutGroupModel:  # noqa: A002 - as the encoder has it
    network = lut_network(seed)
    return replace(network, encoder=replace(encoder_of(network), input=input))


def rows(count: int = 400) -> NDArray[np.float64]:
    return np.random.default_rng(5).uniform(-6, 6, (count, 3))


def changed(found: Narrowed, model: LutGroupModel, features: NDArray[np.float64]) -> int:
    return int(np.count_nonzero(feature_answers(found.model, features) != feature_answers(model, features)))


@pytest.mark.parametrize("seed", range(4))
def test_what_is_stated_of_a_format_is_so(seed: int) -> None:
    model, features = wide(seed), rows()
    found = list(narrow_formats(model, features))
    assert [str(one.words) for one in found[:2]] == [
        f"Q{found[0].words.bits - 13}.12",
        f"Q{found[0].words.bits - 13}.11",
    ]
    for one in found:
        assert one.changed == changed(one, model, features)
        assert one.unmoved is not None
        assert one.changed <= one.unmoved
        unmoved = replace(model, encoder=replace(encoder_of(model), input=one.words))
        assert one.unmoved == np.count_nonzero(
            feature_answers(unmoved, features) != feature_answers(model, features)
        )
    assert any(one.unmoved and one.changed < one.unmoved for one in found)


@pytest.mark.parametrize("most", [0, 4, 40])
def test_features_are_narrowed_within_what_may_change(most: int) -> None:
    model, features = wide(), rows()
    found = narrow_features(model, features, most, silent)
    assert found.changed == changed(found, model, features) <= most
    encoder = found.model.encoder
    assert isinstance(encoder, Thermometer)
    for bits, levels in zip(found.fractions, encoder.thresholds, strict=True):
        assert bits is not None
        assert np.array_equal(np.ldexp(levels, bits), np.rint(np.ldexp(levels, bits)))


def test_more_changes_need_fewer_bits() -> None:
    few, many = (narrow_features(wide(), rows(), most, silent) for most in (0, 40))
    assert sum(bits or 0 for bits in many.fractions) < sum(bits or 0 for bits in few.fractions)
    luts = [encoder_luts(one.model) for one in (few, many)]
    assert luts[0] is not None
    assert luts[1] is not None
    assert luts[1] < luts[0]


def test_words_of_a_model_are_where_the_search_starts() -> None:
    model = wide(input=FixedPoint(8, 4))
    found = narrow_features(model, rows(), 0, silent)
    assert found.words.fraction <= 4
    assert found.changed == 0


def test_a_feature_that_is_not_read_costs_nothing() -> None:
    layer = LutLayer(np.array([[1], [2]], dtype=np.int32), np.array([[True, False], [False, True]]))
    encoder = Thermometer(((-1.0,), (0.3, 0.7), (0.0,)))
    model = LutGroupModel(encoder, ("a", "b"), (layer,), np.array([0, 1], dtype=np.int32))
    found = narrow_features(model, np.random.default_rng(0).uniform(0, 1, (50, 3)), 0, silent)
    assert found.fractions[0] is None
    assert found.fractions[2] is None
    assert not found.words.signed


def test_models_that_cannot_be_narrowed() -> None:
    bits = WisardModel(Words(2), ("a", "b"), np.array([[[0, 1]]]), np.zeros((2, 1, 4), dtype=np.int64), 1)
    with pytest.raises(InputError, match="no thresholds that could be moved: words"):
        narrow_features(bits, np.zeros((2, 2)), 0, silent)
    layer = LutLayer(np.zeros((2, 1), dtype=np.int32), np.array([[True, False], [False, True]]))
    fine = LutGroupModel(Thermometer(((0.0001,),)), ("a", "b"), (layer,), np.array([0, 1], dtype=np.int32))
    with pytest.raises(
        InputError, match=r"the finest words change more answers than allowed: 1 of 2 with 12"
    ):
        narrow_features(fine, np.array([[0.00009], [0.00011]]), 0, silent)


@pytest.mark.realdata
@pytest.mark.slow
def test_the_published_network_for_jets_needs_half_the_encoder(realdata: Path) -> None:
    _, model = import_model(next((realdata / "dwn").glob("*t200*checkpoint.pt")), ImportOptions())
    assert isinstance(model, LutGroupModel)
    with np.load(next((realdata / "dwn").glob("*t200*testvectors.npz"))) as vectors:
        features, recorded = vectors["x_raw"].astype(np.float64), vectors["pred"]
    found = narrow_features(model, features, 2, silent)
    assert np.count_nonzero(feature_answers(found.model, features) != recorded) <= 2
    luts = encoder_luts(found.model)
    assert luts is not None
    assert luts <= 150  # of 309 at Q3.12
