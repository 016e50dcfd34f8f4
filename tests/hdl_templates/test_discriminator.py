"""The pixel classifier."""

import numpy as np
import pytest

from hdl_templates.discriminator import Parameters, pixel_words
from hdl_templates.lookup import SumOfProducts

R7_AND_NOT_B0 = SumOfProducts(("R7", "B0"), ("class_bit0",), (((0b11, 0b01),),))


def test_the_golden_model_reads_the_chosen_bits() -> None:
    parameters = Parameters((23, 0), R7_AND_NOT_B0)
    pixels = pixel_words(np.array([[255, 0, 0], [255, 0, 1], [127, 0, 0], [128, 255, 254]], dtype=np.uint8))
    assert pixels.tolist() == [0xFF0000, 0xFF0001, 0x7F0000, 0x80FFFE]
    assert parameters.compute(pixels).tolist() == [1, 0, 0, 1]


@pytest.mark.parametrize(
    ("positions", "class_count", "message"),
    [
        ((23,), 2, "a lookup of 2 inputs needs as many different pixel bits"),
        ((23, 23), 2, "a lookup of 2 inputs needs as many different pixel bits"),
        ((23, 24), 2, "a pixel has bits 0 to 23"),
        ((23, 0), 3, "3 classes need 2 outputs, not 1"),
        ((23, 0), 1, "at least 2 classes"),
    ],
)
def test_parts_that_do_not_fit_are_refused(
    positions: tuple[int, ...], class_count: int, message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        Parameters(positions, R7_AND_NOT_B0, class_count)
