"""A template and what is asked of a position."""

import numpy as np

from wnn2hdl.apps.navigation.matching.query import Query
from wnn2hdl.apps.navigation.matching.scores import Sums
from wnn2hdl.apps.navigation.matching.spectra import Layers

WHOLE = np.ones((8, 8), dtype=np.bool_)


def sums(counts: list[float]) -> Sums:
    common = np.array(counts, dtype=np.float64)
    return Sums(common, common, common, common, common, common)


def test_a_position_with_too_few_common_pixels_has_no_score() -> None:
    query = Query(Layers.of(WHOLE, WHOLE, np.float64), "match_count", 0.5)
    assert query.evaluate(sums([31, 32, 64]), slack=0.5).tolist() == [-np.inf, 1, 1]
    nowhere = Query(Layers.of(WHOLE, WHOLE, np.float64), "match_count", 0)
    assert nowhere.evaluate(sums([0, 1]), slack=0.5).tolist() == [-np.inf, 1]


def test_a_shrunk_query_estimates_the_full_correlation() -> None:
    query = Query(Layers.of(WHOLE, WHOLE, np.float64), "correlation", 0.5).shrink(2)
    assert query.layers.value.shape == (4, 4)
    assert query.layers.value.dtype == np.float32
    assert query.evaluate(sums([16]), slack=0).tolist() == [64]


def test_spectra_are_kept_for_the_last_shape() -> None:
    query = Query(Layers.of(WHOLE, WHOLE, np.float32), "ncc", 0.5)
    first = query.spectra((16, 16))
    assert query.spectra((16, 16)) is first
    assert query.spectra((32, 32)).value.shape == (32, 32)
