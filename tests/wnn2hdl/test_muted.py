"""Warnings are muted and recorded by one thread at a time."""

import threading
import warnings

import pytest

from wnn2hdl.muted import muted, recorded


def test_a_muted_warning_is_not_given_and_others_are() -> None:
    with muted(UserWarning, message="expected"):
        warnings.warn("expected here", UserWarning, stacklevel=1)
        with pytest.raises(UserWarning, match="unknown"):
            warnings.warn("unknown", UserWarning, stacklevel=1)
        with pytest.raises(RuntimeWarning):
            warnings.warn("expected, but of another kind", RuntimeWarning, stacklevel=1)
    with pytest.raises(UserWarning, match="expected"):
        warnings.warn("expected no more", UserWarning, stacklevel=1)


def test_recorded_warnings_are_kept() -> None:
    with recorded() as noted:
        warnings.warn("kept", RuntimeWarning, stacklevel=1)
    assert [(str(warning.message), warning.category) for warning in noted] == [("kept", RuntimeWarning)]


def test_a_thread_that_ends_muting_does_not_end_it_for_another() -> None:
    before = list(warnings.filters)
    first_is_done, second_is_in = threading.Event(), threading.Event()
    faults: list[Warning] = []

    def second() -> None:
        with muted():
            second_is_in.set()
            first_is_done.wait()
            try:
                warnings.warn("in the second thread", UserWarning, stacklevel=1)
            except Warning as warning:
                faults.append(warning)

    thread = threading.Thread(target=second)
    with muted():
        thread.start()
        second_is_in.wait(0.2)
    first_is_done.set()
    thread.join()
    assert not faults
    assert list(warnings.filters) == before
