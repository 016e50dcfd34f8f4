"""Figures of a method, against small cases worked out by hand and against NumPy."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.apps.navigation.results import FlightResult, FrameFix, MethodResult, SearchResult


def fix(error_m: float | None, *, fixed: bool = True, geodesic_m: float | None = None) -> FrameFix:
    place = 1.0 if error_m is not None else None
    return FrameFix("f.jpg", 1.0, 2.0, place, place, error_m, geodesic_m, 0.5, fixed, 0.25)


def method(*fixes: FrameFix) -> MethodResult:
    return MethodResult("m", fixes)


def test_figures_of_four_frames() -> None:
    m = method(fix(10), fix(20), fix(99.9, fixed=False), fix(100))
    assert m.errors_m == (10.0, 20.0, 99.9, 100.0)
    assert m.mean_m == pytest.approx(57.475)
    assert m.median_m == pytest.approx(59.95)
    assert m.false_positive_percent == 25
    assert m.true_positive_percent == 75
    assert m.fixed_percent == 75
    assert m.fixed_mean_m == pytest.approx(130 / 3)
    assert m.fixed_true_percent == pytest.approx(200 / 3)
    assert m.mean_seconds == 0.25


def test_the_middle_of_an_odd_number_is_the_median() -> None:
    assert method(fix(30), fix(1), fix(2)).median_m == 2


@given(st.lists(st.floats(0, 1e4), min_size=1, max_size=30))
def test_mean_and_population_deviation_are_numpys(errors: list[float]) -> None:
    m = method(*map(fix, errors))
    assert m.mean_m == pytest.approx(np.mean(errors), abs=1e-6)
    assert m.median_m == pytest.approx(np.median(errors), abs=1e-6)
    assert m.variance_m2 == pytest.approx(np.var(errors), abs=1e-6)
    assert m.std_m == pytest.approx(np.std(errors), abs=1e-6)


def test_frames_without_a_position_count_for_the_share_of_fixes_alone() -> None:
    m = method(fix(10), fix(None, fixed=False))
    assert m.mean_m == 10
    assert m.true_positive_percent == 100
    assert m.fixed_percent == 50


def test_nothing_to_average_gives_nothing() -> None:
    for m in (method(), method(fix(None, fixed=False))):
        figures = (m.mean_m, m.std_m, m.variance_m2, m.median_m, m.false_positive_percent)
        assert (*figures, m.true_positive_percent, m.fixed_mean_m, m.fixed_true_percent) == (None,) * 8
    assert method().fixed_percent is None


def test_the_references_window_allows_134_m_and_a_blind_guess_is_73_m_off() -> None:
    """Windows of 599 pixels around frames of 219 at half a metre: 95 m to each side."""
    window = SearchResult("window", (599 - 219) / 2 * 0.5, ())
    assert window.key == "window_95m"
    assert window.furthest_m == pytest.approx(134.35, abs=0.01)
    places = np.random.default_rng(0).uniform(-95, 95, (400_000, 2))
    assert window.blind_mean_m == pytest.approx(np.hypot(*places.T).mean(), rel=2e-3)


def test_the_whole_map_has_no_limit() -> None:
    search = SearchResult("map", None, ())
    assert search.key == "map"
    assert search.furthest_m is None
    assert search.blind_mean_m is None


def test_the_largest_difference_to_the_geodesic_is_taken_over_everything() -> None:
    near = SearchResult("window", 95, (method(fix(10, geodesic_m=10.5), fix(None, geodesic_m=None)),))
    far = SearchResult("map", None, (method(fix(900, geodesic_m=896)),))
    flight = FlightResult("map.tif", 0.5, 750, (10.0,), (), (near, far))
    assert flight.largest_geodesic_difference_m is not None
    assert math.isclose(flight.largest_geodesic_difference_m, 4)
    assert FlightResult("map.tif", 0.5, 750, (10.0,), (), ()).largest_geodesic_difference_m is None


def test_what_is_nearer_than_the_weightless_edges_is_said() -> None:
    own = MethodResult("weightless", (fix(10.0),), weightless=True)
    better, worse, tracked = (
        MethodResult("grey", (fix(3.0),)),
        MethodResult("Canny", (fix(30.0),)),
        MethodResult("grey, track", (fix(1.0),), tracked=True),
    )
    found = SearchResult("map", None, (worse, own, better, tracked)).beaten
    assert found == "On this flight grey (3.0 m) is nearer on average than weightless (10.0 m)."
    both = SearchResult("map", None, (MethodResult("Sobel", (fix(9.0),)), own, better)).beaten
    assert "Sobel (9.0 m), grey (3.0 m) are nearer" in both
    for methods in ((own, worse, tracked), (worse, better), (MethodResult("w", (), weightless=True), better)):
        assert SearchResult("map", None, methods).beaten == ""
