"""The block of nine pixels, alone and with the matcher on its bits."""

import numpy as np
import pytest

from hdl_templates import block, discriminator, edge_filter
from hdl_templates.lookup import SumOfProducts
from wnn2hdl.verify.simulation import simulate

WINDOW_NAMES = tuple(f"bit{i}" for i in range(9))
CENTRE_WITHOUT_TOP = edge_filter.Parameters(
    SumOfProducts(WINDOW_NAMES, ("edge_bit",), (((0b000010010, 0b000010000),),))
)


def classifier(class_count: int) -> discriminator.Parameters:
    outputs = tuple(f"class_bit{j}" for j in range((class_count - 1).bit_length()))
    terms = (((0b11, 0b01), (0b100, 0b100)), ((0b101, 0b101),))[: len(outputs)]
    return discriminator.Parameters(
        (23, 0, 8), SumOfProducts(("R7", "B0", "G0"), outputs, terms), class_count
    )


@pytest.mark.parametrize("class_count", [2, 3])
def test_the_circuit_equals_the_golden_model(class_count: int) -> None:
    parameters = block.Parameters(classifier(class_count), CENTRE_WITHOUT_TOP)
    windows = np.random.default_rng(class_count).integers(0, 1 << 24, (1000, 9))
    expected = parameters.compute(windows)
    assert len(np.unique(expected["bits"])) > 300
    simulate(parameters.create(), {"window": windows}, expected)


def test_the_golden_model_reads_windows_row_by_row() -> None:
    window = np.zeros(9, dtype=np.int64)
    window[4] = 0x800000
    answers = block.Parameters(classifier(2), CENTRE_WITHOUT_TOP).compute(window)
    assert {name: int(value) for name, value in answers.items()} == {"bits": 0b000010000, "edge_bit": 1}
