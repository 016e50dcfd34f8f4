"""Edge patterns learned from Canny's edges."""

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.edges import boundary, canny, filter_agreement, grey, half_plane, learned
from wnn2hdl.errors import InputError
from wnn2hdl.images import MaskFormat, pair_masks, read_labels, read_rgb
from wnn2hdl.ir import EdgeFilter
from wnn2hdl.samples import landscape

Pictures = list[tuple[NDArray[np.bool_], NDArray[np.bool_]]]


def random_pictures(seed: int) -> Pictures:
    """Blocks, whose sides repeat one window, and edges off the rim, where the learned F1 is not defined."""
    rng = np.random.default_rng(seed)
    pictures = []
    for _ in range(2):
        edges = np.zeros((22, 18), dtype=np.bool_)
        edges[1:-1, 1:-1] = rng.random((20, 16)) < 0.05
        pictures.append((np.kron(rng.random((6, 5)) < 0.6, np.ones((4, 4))) > 0, edges))
    return pictures


def score(codes: list[int], pictures: Pictures) -> float:
    patterns = np.zeros(512, dtype=np.bool_)
    patterns[codes] = True
    return filter_agreement(EdgeFilter("", patterns), pictures).f1 or 0.0


@pytest.mark.parametrize("seed", [0, 1])
def test_each_step_takes_the_pattern_that_leaves_the_highest_f1(seed: int) -> None:
    pictures = random_pictures(seed)
    chosen: list[int] = []
    for count in (1, 2, 3):
        codes = np.flatnonzero(learned(pictures, count).patterns).tolist()
        best = max(score([*chosen, code], pictures) for code in range(1, 511))
        assert score(codes, pictures) == pytest.approx(best, abs=1e-12)
        assert set(chosen) < set(codes)
        chosen = codes


@pytest.mark.parametrize("count", [1, 75, 510])
def test_exactly_as_many_patterns_as_asked_for_and_never_a_flat_one(count: int) -> None:
    chosen = learned(random_pictures(0), count)
    assert chosen.name == "learned"
    assert chosen.size == count
    assert not chosen.patterns[[0, 511]].any()


@pytest.mark.parametrize("count", [0, 511])
def test_an_impossible_count_is_refused(count: int) -> None:
    with pytest.raises(InputError, match=f"1 to 510 patterns: {count}"):
        learned(random_pictures(0), count)


def test_pictures_without_edges_are_refused() -> None:
    flat = [(np.zeros((9, 9), dtype=np.bool_), np.zeros((7, 7), dtype=np.bool_))]
    with pytest.raises(InputError, match="no edge in the pictures"):
        learned(flat)
    with pytest.raises(InputError, match="no edge in the pictures"):
        learned([])


def test_learned_patterns_agree_with_canny_better_than_the_boundary_on_other_landscapes() -> None:
    scenes = [landscape(192, 192, seed) for seed in range(6)]
    pictures = [(scene.image[..., 0] > 95, canny(grey(scene.image), 20, 60)) for scene in scenes]
    chosen = learned(pictures[:4])
    mine, plain = filter_agreement(chosen, pictures[4:]).f1, filter_agreement(boundary(), pictures[4:]).f1
    assert mine is not None
    assert plain is not None
    assert mine > plain + 0.05


@pytest.mark.realdata
def test_learned_patterns_agree_with_canny_best_on_real_pictures(realdata: Path) -> None:
    folder = realdata / "amazon_masks"
    pictures = []
    for picture, mask in pair_masks(folder / "images", folder / "masks"):
        rgb = read_rgb(picture)
        labels = read_labels(mask, picture, (512, 512), MaskFormat())
        pictures.append((labels.classes > 0, canny(grey(rgb))))
    scores = [
        filter_agreement(edge_filter, pictures[20:]).f1 or 0.0
        for edge_filter in (boundary(), half_plane(), learned(pictures[:20]))
    ]
    assert scores == sorted(scores)
    assert scores[2] > 0.6
