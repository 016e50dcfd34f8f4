"""From tables, covers and LUT networks to Amaranth components."""

from collections.abc import Sequence

from hdl_templates import bit_match, discriminator, lookup
from hdl_templates import block as block_template
from hdl_templates import block_match as block_match_template
from hdl_templates import edge_filter as edge_template
from hdl_templates import neighbourhood as neighbourhood_template
from hdl_templates import sobel as sobel_template
from hdl_templates.lookup import Style
from wnn2hdl.ir import WINDOW_BITS, BitSelect, Cover, Lut, LutNetwork, Neighbourhood

Logic = Cover | LutNetwork
"""What a truth table was minimised to."""


def pixel(
    encoder: BitSelect, logic: Logic, *, class_count: int = 2, style: Style = "equations"
) -> discriminator.Discriminator:
    """The pixel classifier ``pixel``: ``rgb[23:0]`` to ``class_bits``.

    Args:
        encoder: the bits of a pixel that it reads.
        logic: their classification; inputs are the encoder's bits, output ``j`` is bit ``j`` of the class.
        class_count: classes told apart.
        style: how a LUT network is written: ``equations``, or ``cells`` of the vendor.

    Raises:
        ValueError: encoder, logic and class count do not fit together.
    """
    return _pixel(encoder, logic, class_count, style).create()


def edge_filter(logic: Logic, *, style: Style = "equations") -> edge_template.EdgeFilter:
    """The edge filter ``edge_filter``: ``bits[8:0]`` to ``edge_bit``; arguments and errors as for `pixel`."""
    return edge_template.Parameters(_lookup(logic, style)).create()


def block(
    encoder: BitSelect,
    pixel_logic: Logic,
    edge_logic: Logic,
    *,
    class_count: int = 2,
    style: Style = "equations",
) -> block_template.Block:
    """The block of nine pixel classifiers and edge filter; arguments and errors as for `pixel`."""
    return _block(encoder, pixel_logic, edge_logic, class_count, style).create()


def block_match(
    encoder: BitSelect,
    pixel_logic: Logic,
    edge_logic: Logic,
    *,
    class_count: int = 2,
    style: Style = "equations",
) -> block_match_template.BlockMatch:
    """The block with the matcher on its nine bits; arguments and errors as for `pixel`."""
    block_parameters = _block(encoder, pixel_logic, edge_logic, class_count, style)
    return block_match_template.Parameters(block_parameters).create()


def neighbourhood(
    encoder: Neighbourhood, taps: Sequence[Logic], last: Logic, *, style: Style = "equations"
) -> neighbourhood_template.Neighbourhood:
    """The classifier ``neighbourhood`` of a pixel and its neighbours: ``window`` to ``class_bits``.

    Args:
        encoder: the taps and their places.
        taps: for each tap its logic, one output.
        last: the classification of the taps' bits; output ``j`` is bit ``j`` of the class.
        style: as for `pixel`.

    Raises:
        ValueError: encoder and logic do not fit together.
    """
    if last.inputs != encoder.names:
        raise ValueError(f"the logic reads {last.inputs}, but the encoder gives {encoder.names}")
    tables = tuple(
        (encoder.size * tap.row + tap.column, _pixel(tap.pixel, logic, 2, style))
        for tap, logic in zip(encoder.taps, taps, strict=True)
    )
    return neighbourhood_template.Parameters(encoder.size, tables, _lookup(last, style)).create()


def match(width: int = WINDOW_BITS) -> bit_match.BitMatch:
    """Match-and-count of two words: ``bits`` and ``reference`` to ``match_count``."""
    return bit_match.Parameters(width).create()


def sobel(threshold: int = sobel_template.DEFAULT_THRESHOLD) -> sobel_template.Sobel:
    """The Sobel baseline: ``window[71:0]`` of nine greys to ``edge_bit``."""
    return sobel_template.Parameters(threshold).create()


def _block(
    encoder: BitSelect, pixel_logic: Logic, edge_logic: Logic, class_count: int, style: Style
) -> block_template.Parameters:
    edges = edge_template.Parameters(_lookup(edge_logic, style))
    return block_template.Parameters(_pixel(encoder, pixel_logic, class_count, style), edges)


def _pixel(encoder: BitSelect, logic: Logic, class_count: int, style: Style) -> discriminator.Parameters:
    if logic.inputs != encoder.names:
        raise ValueError(f"the logic reads {logic.inputs}, but the encoder gives {encoder.names}")
    return discriminator.Parameters(encoder.pixel_positions, _lookup(logic, style), class_count)


def _lookup(logic: Logic, style: Style) -> lookup.Lookup:
    if isinstance(logic, Cover):
        terms = tuple(
            tuple((cube.mask, cube.value) for cube in logic.cubes if cube.outputs >> position & 1)
            for position in range(len(logic.outputs))
        )
        return lookup.SumOfProducts(logic.inputs, logic.outputs, terms)
    cells = tuple(
        lookup.LutCell(cell.name, cell.inputs, cell.init)
        if isinstance(cell, Lut)
        else lookup.MuxCell(cell.name, cell.low, cell.high, cell.select)
        for cell in logic.cells
    )
    return lookup.LutNetwork(logic.inputs, cells, logic.outputs, style)
