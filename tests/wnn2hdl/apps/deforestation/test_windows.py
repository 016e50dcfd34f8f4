"""How pictures are cut into windows."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.apps.deforestation.windows import BAND_PIXELS, cut


@given(
    height=st.integers(1, 20_000),
    width=st.integers(1, 20_000),
    block=st.sampled_from([(1, 0), (5, 0), (256, 256), (512, 512), (100, 300), (16, 4096)]),
    side=st.integers(1, 5_000),
)
def test_windows_cover_each_pixel_once_and_cut_no_square(
    height: int, width: int, block: tuple[int, int], side: int
) -> None:
    bands = cut(height, width, (block[0], block[1] or width), side)
    assert [window.index for band in bands for window in band] == list(range(sum(map(len, bands))))
    row = 0
    for band in bands:
        assert {(window.row, window.height) for window in band} == {(row, band[0].height)}
        assert [window.column for window in band] == [0, *np.cumsum([x.width for x in band[:-1]]).tolist()]
        assert sum(window.width for window in band) == width
        assert all(window.row % side == 0 and window.column % side == 0 for window in band)
        row += band[0].height
    assert row == height


def test_windows_are_made_of_whole_tiles_where_squares_allow() -> None:
    window = cut(31_744, 31_744, (512, 512), 20)[0][0]
    assert (window.height, window.width) == (2560, 2560)
    assert cut(31_744, 31_744, (512, 512))[0][0].width == 2048
    # The least common multiple of 509 and 512 is far too large.
    assert cut(31_744, 31_744, (512, 512), 509)[0][0].width == 4 * 509


def test_pictures_stored_in_rows_are_cut_into_rows() -> None:
    (window,) = cut(10_000, 10_000, (1, 10_000), 20)[0]
    assert (window.width, window.height) == (10_000, 400)


def test_one_row_of_windows_is_never_too_much_to_hold() -> None:
    assert cut(1024, 10**6, (64, 64))[0][0].height * 10**6 <= BAND_PIXELS
