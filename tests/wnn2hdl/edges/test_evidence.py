import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.edges import boundary, filter_agreement, half_plane
from wnn2hdl.edges.evidence import gather
from wnn2hdl.errors import InputError
from wnn2hdl.ir import EdgeFilter

Pictures = list[tuple[NDArray[np.bool_], NDArray[np.bool_]]]


@pytest.fixture(scope="module")
def pictures() -> Pictures:
    """Blobs, and reference edges that are true near half of the blobs' pixels; none on the windows' rim."""
    rng = np.random.default_rng(4)
    made = []
    for _ in range(3):
        binary = np.kron(rng.random((10, 10)) < 0.4, np.ones((4, 4))).astype(np.bool_)
        edges = (binary ^ np.roll(binary, 1, axis=1))[1:-1, 1:-1] & (rng.random((38, 38)) < 0.8)
        edges[[0, -1]] = edges[:, [0, -1]] = False
        made.append((binary, edges))
    return made


@pytest.mark.parametrize("known", [boundary(), half_plane()], ids=lambda known: known.name)
def test_f1_is_that_of_the_agreement_over_the_pictures(pictures: Pictures, known: EdgeFilter) -> None:
    expected = filter_agreement(known, pictures).f1
    assert gather(pictures).f1(known.patterns) == pytest.approx(expected, abs=1e-12)


def test_gain_is_the_f1_with_a_window_less_that_without_it(pictures: Pictures) -> None:
    evidence = gather(pictures)
    patterns = np.random.default_rng(0).random(512) < 0.2
    gains = evidence.gains(patterns)
    for code in range(512):
        with_it, without = patterns.copy(), patterns.copy()
        with_it[code], without[code] = True, False
        assert gains[code] == pytest.approx(evidence.f1(with_it) - evidence.f1(without), abs=1e-12)


def test_windows_that_never_occur_gain_nothing(pictures: Pictures) -> None:
    evidence = gather(pictures)
    assert not evidence.gains(boundary().patterns)[evidence.seen == 0].any()


def test_no_patterns_have_no_f1(pictures: Pictures) -> None:
    assert gather(pictures).f1(np.zeros(512, dtype=np.bool_)) == 0


@pytest.mark.parametrize("empty", [[], [(np.zeros((8, 8), bool), np.zeros((6, 6), bool))]])
def test_pictures_without_an_edge_are_refused(empty: Pictures) -> None:
    with pytest.raises(
        InputError, match="Canny finds no edge in the pictures; give pictures with more contrast"
    ):
        gather(empty)
