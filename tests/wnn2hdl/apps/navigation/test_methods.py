"""What is matched of a picture."""

import numpy as np
import pytest

from wnn2hdl.apps.navigation.binarise import shrunk
from wnn2hdl.apps.navigation.methods import (
    Describe,
    canny_edges,
    compared_methods,
    grey_levels,
    sobel_edges,
)
from wnn2hdl.apps.navigation.weightless import by_rule

STEP = np.repeat(np.where(np.arange(40) < 20, 40, 200).astype(np.uint8)[None, :, None], 40, axis=0).repeat(
    3, -1
)
EVERYWHERE = np.ones((40, 40), dtype=np.bool_)


@pytest.mark.parametrize("describe", [canny_edges, sobel_edges])
def test_edges_lie_where_the_picture_steps(describe: Describe) -> None:
    edges, inside = describe(STEP, EVERYWHERE)
    assert edges.shape == inside.shape == (40, 40)
    columns = np.flatnonzero(edges[20])
    assert columns.size
    assert set(columns) <= {18, 19, 20, 21}


@pytest.mark.parametrize("describe", [canny_edges, sobel_edges])
def test_the_border_of_what_is_valid_is_no_edge(describe: Describe) -> None:
    valid = EVERYWHERE.copy()
    valid[:, :10] = False
    picture = STEP.copy()
    picture[:, :10] = 255
    edges, inside = describe(picture, valid)
    assert edges[20, 8:12].any()
    assert not inside[:, :11].any()
    assert not np.logical_and(edges, inside)[:, :15].any()


def test_grey_is_taken_as_it_is() -> None:
    picture, inside = grey_levels(STEP, EVERYWHERE)
    assert picture[0].tolist() == STEP[0, :, 0].tolist()
    assert inside.all()


def test_shrinking_leaves_out_the_surroundings_of_what_is_not_valid() -> None:
    valid = EVERYWHERE.copy()
    valid[15, 15] = False
    inner = shrunk(valid, 3)
    assert inner[3:-3, 3:-3].sum() == 34 * 34 - 7 * 7
    assert inner.sum() == 34 * 34 - 7 * 7


def test_the_rows_of_the_table() -> None:
    methods = compared_methods(by_rule())
    assert [method.key for method in methods] == [
        "perspective-canny",
        "rotation-canny",
        "perspective-weightless",
        "perspective-sobel",
        "grey",
    ]
    assert [method.key for method in methods if not method.perspective] == ["rotation-canny"]
