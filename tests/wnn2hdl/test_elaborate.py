"""From covers and LUT networks to circuits that compute the same."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hdl_templates.discriminator import pixel_words
from hdl_templates.lookup import Style
from wnn2hdl import elaborate
from wnn2hdl.ir import BitSelect, Cover, Cube, Lut, LutNetwork, Mux
from wnn2hdl.verify.simulation import simulate

WINDOW_NAMES = tuple(f"bit{i}" for i in range(9))


@st.composite
def covers(draw: st.DrawFn, inputs: tuple[str, ...], outputs: tuple[str, ...]) -> Cover:
    """Random cubes over the inputs, each feeding at least one output."""
    cubes = []
    for _ in range(draw(st.integers(0, 12))):
        mask = draw(st.integers(0, (1 << len(inputs)) - 1))
        value = draw(st.integers(0, (1 << len(inputs)) - 1)) & mask
        cubes.append(Cube(mask, value, draw(st.integers(1, (1 << len(outputs)) - 1))))
    return Cover(inputs, outputs, tuple(cubes))


@st.composite
def networks(draw: st.DrawFn, inputs: tuple[str, ...], outputs: tuple[str, ...]) -> LutNetwork:
    """Random LUTs, sometimes with a multiplexer behind the first two."""
    cells: list[Lut | Mux] = []
    signals = list(inputs)
    for i in range(draw(st.integers(2, 6))):
        chosen = draw(st.lists(st.sampled_from(signals), min_size=1, max_size=6, unique=True))
        contents = draw(st.integers(0, (1 << (1 << len(chosen))) - 1))
        cells.append(Lut(f"lut{i}", tuple(chosen), contents))
        signals.append(f"lut{i}")
    if draw(st.booleans()):
        cells.append(Mux("mux0", "lut0", "lut1", draw(st.sampled_from(inputs))))
        signals.append("mux0")
    sources = [draw(st.sampled_from([*signals, "0", "1"])) for _ in outputs]
    return LutNetwork(inputs, tuple(cells), tuple(zip(outputs, sources, strict=True)))


def pixels_of(encoder: BitSelect) -> np.ndarray[tuple[int, ...], np.dtype[np.int64]]:
    """For each code a pixel word that has it, the other bits at random."""
    codes = np.arange(1 << encoder.width)
    words = np.random.default_rng(0).integers(0, 1 << 24, len(codes))
    for i, position in enumerate(encoder.pixel_positions):
        words = words & ~(1 << position) | (codes >> i & 1) << position
    return words


ENCODER = BitSelect(("R7", "G0", "B5", "R6", "B0"))
OUTPUTS = ("class_bit0", "class_bit1")


@settings(max_examples=40, deadline=None)
@given(
    covers(ENCODER.names, OUTPUTS) | networks(ENCODER.names, OUTPUTS), st.sampled_from(["equations", "cells"])
)
def test_pixel_logic_golden_model_and_simulation_agree(logic: Cover | LutNetwork, style: Style) -> None:
    component = elaborate.pixel(ENCODER, logic, class_count=4, style=style)
    words = pixels_of(ENCODER)
    classes = logic.evaluate(np.arange(1 << ENCODER.width)) @ np.array([1, 2])
    np.testing.assert_array_equal(component.parameters.compute(words), classes)
    simulate(component, {"rgb": words}, {"class_bits": classes})


@settings(max_examples=10, deadline=None)
@given(covers(WINDOW_NAMES, ("edge_bit",)) | networks(WINDOW_NAMES, ("edge_bit",)))
def test_an_edge_filter_is_right_for_every_window(logic: Cover | LutNetwork) -> None:
    windows = np.arange(512)
    simulate(elaborate.edge_filter(logic), {"bits": windows}, {"edge_bit": logic.evaluate(windows)[:, 0]})


def test_a_block_puts_the_parts_together() -> None:
    encoder = BitSelect(("R7", "G7"))
    pixel = Cover(encoder.names, ("class_bit0",), (Cube(0b11, 0b01, 1),))
    centre_without_top = Cover(WINDOW_NAMES, ("edge_bit",), (Cube(0b10010, 0b10000, 1),))
    rng = np.random.default_rng(1)
    pixels = rng.integers(0, 256, (10_000, 9, 3), dtype=np.uint8)
    references = rng.integers(0, 512, 10_000)
    flags = pixel.evaluate(encoder.codes(pixels))[..., 0]
    bits = flags @ (1 << np.arange(9))
    expected = {
        "bits": bits,
        "edge_bit": flags[:, 4] & ~flags[:, 1],
        "match_count": 9 - np.bitwise_count(bits ^ references),
    }
    result = simulate(
        elaborate.block_match(encoder, pixel, centre_without_top),
        {"window": pixel_words(pixels), "reference": references},
        expected,
    )
    assert result.vectors == 10_000


def test_logic_over_other_bits_than_the_encoders_is_refused() -> None:
    with pytest.raises(ValueError, match=r"the logic reads \('R6',\), but the encoder gives \('R7',\)"):
        elaborate.pixel(BitSelect(("R7",)), Cover(("R6",), ("class_bit0",), ()))


def test_the_baseline_and_the_matcher_need_no_model() -> None:
    assert elaborate.sobel().parameters.threshold == 128
    assert elaborate.match().parameters.width == 9
