"""The order of flight by the numbers of frames, also where a camera's counter starts again."""

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.apps.navigation.counter import frame_times, in_order, time_among
from wnn2hdl.errors import InputError

ROLLED = [f"DJI_{number:04d}.jpg" for number in (9990, 9998, 9999, 1, 2, 30)]


def test_times_are_the_numbers_at_the_end_of_names() -> None:
    assert frame_times(["DJI_001.jpg", "DJI_004.jpg", "DJI_0006.jpg"]) == [1, 4, 6]
    assert frame_times(["7", "12"]) == [7, 12]
    for names in (["a1.png", "b2.png"], ["first.png", "IMG_2.png"], ["f1.png", "f01.png"], ["f2", "f1"]):
        assert frame_times(names) is None


def test_dates_in_names_are_seconds() -> None:
    names = ["IMG_20240229_235959.jpg", "IMG_20240301_000001.jpg"]
    first, second = frame_times(names) or (0, 0)
    assert second - first == 2
    assert frame_times(["IMG_20249999_999999.jpg"]) == [999999]


def test_a_counter_that_rolled_over_goes_on() -> None:
    assert frame_times(ROLLED) == [9990, 9998, 9999, 10001, 10002, 10030]
    assert in_order(ROLLED) == [0, 1, 2, 3, 4, 5]


@given(st.integers(0, 9999), st.lists(st.integers(1, 40), min_size=1, max_size=50))
def test_any_start_of_the_counter_gives_the_same_flight(start: int, steps: list[int]) -> None:
    numbers = [start]
    for step in steps:
        numbers.append((numbers[-1] + step) % 10_000)
    times = frame_times([f"DJI_{number:04d}.jpg" for number in numbers])
    assert times is not None
    assert [later - sooner for sooner, later in pairwise(times)] == steps


def test_a_rollover_that_the_lines_do_not_show_is_named() -> None:
    with pytest.raises(InputError, match=r"rolled over: DJI_9990\.jpg may be from before DJI_0030"):
        in_order(sorted(ROLLED))


def test_names_sorted_as_texts_are_sorted_by_their_numbers() -> None:
    assert in_order(["f_1.jpg", "f_10.jpg", "f_9.jpg"]) == [0, 2, 1]


@pytest.mark.parametrize("names", [["f_10", "f_9", "f_11"], ["f_12", "f_11", "f_10"], ["f_600", "f_010"]])
def test_another_order_of_lines_than_of_names_is_refused(names: list[str]) -> None:
    with pytest.raises(InputError, match=f"another order than the numbers.*: {names[0]} before {names[1]}"):
        in_order(names)


def test_where_names_tell_nothing_the_lines_do() -> None:
    assert in_order(["river.jpg", "IMG_2.jpg", "a.jpg"]) == [0, 1, 2]
    assert in_order([]) == []


def test_another_frame_s_time_is_by_the_same_clock() -> None:
    assert time_among(ROLLED, "DJI_9995.jpg") == (frame_times(ROLLED), 9995)
    assert time_among(ROLLED, "DJI_0005.jpg") == (frame_times(ROLLED), 10005)
    assert time_among(["f_7", "f_9"], "f_12") == ([7, 9], 12)
    assert time_among(["f_7", "f_9"], "g_8") is None
    assert time_among(["f_7", "f_9"], "f_9") is None
