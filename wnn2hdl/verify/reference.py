"""Reference Verilog, written straight from a model: what an emitted circuit is proved equal to.

No table, cover, network or hardware library lies between the model and this text: discriminators are RAMs,
sums and comparisons as in the definition of a WiSARD, the edge filter is its 512-word RAM, the matcher counts
equal bits with a plain sum. Ports are those of the emitted circuits (`Specification.part`).

A RAM of constants is written as a decision diagram: a tree of multiplexers, one address bit a level, in which
equal halves are shared. Indexing one constant vector says the same, but Yosys takes eight times as long to
map it (measured for a vector of 4096 bits).
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import WINDOW_BITS, EdgeFilter, WisardModel
from wnn2hdl.verify.specification import (
    AnySpecification,
    NeighbourhoodSpecification,
    PartName,
    Specification,
)


def reference_name(part: PartName) -> str:
    """The reference's module for a circuit."""
    return f"reference_{part}"


def reference_verilog(specification: AnySpecification) -> str:
    """The reference modules, Verilog-2001: the five of a block, or the one of a neighbourhood."""
    if isinstance(specification, NeighbourhoodSpecification):
        return _neighbourhood(specification)
    return "\n".join(
        [
            _pixel(specification),
            _edge(specification.edge_filter),
            _match(specification),
            _block(specification),
            _block_match(specification),
        ]
    )


def care_verilog(specification: AnySpecification) -> str:
    """The modules by which the wrapper of a proof knows the care set.

    ``care_neighbourhood`` tells whether a window of a neighbourhood is cared for. All others have two:
    ``care_pixel`` passes on a pixel whose code is cared for and replaces any other by one that is: its output
    runs over all cared-for pixels and no others. ``care_window`` tells whether a binary window is cared for.
    """
    if isinstance(specification, NeighbourhoodSpecification):
        return _care_neighbourhood(specification)
    free = [f"free[{position}]" for position in specification.encoder.pixel_positions]
    pixel_lines, pixel_cared = lookup("n", specification.pixel_care, free)
    window = [f"bits[{i}]" for i in range(WINDOW_BITS)]
    window_lines, window_cared = lookup("n", specification.window_care, window)
    red, green, blue = specification.cared_pixel()
    return "\n".join(
        [
            "module care_pixel(input [23:0] free, output [23:0] rgb);",
            *pixel_lines,
            f"  assign rgb = {pixel_cared} ? free : {{8'd{red}, 8'd{green}, 8'd{blue}}};",
            "endmodule",
            "",
            f"module care_window(input [{WINDOW_BITS - 1}:0] bits, output cared);",
            *window_lines,
            f"  assign cared = {window_cared};",
            "endmodule",
            "",
        ]
    )


def lookup(prefix: str, contents: NDArray[np.bool_], address: Sequence[str]) -> tuple[list[str], str]:
    """Verilog for a RAM of constants.

    Args:
        prefix: what the names of its wires begin with.
        contents: bool ``[2**len(address)]``.
        address: a one-bit expression each, the least significant first.

    Returns:
        Declarations, each wire before its use, and the expression for the addressed bit.
    """
    lines: list[str] = []
    known: dict[bytes, str] = {}

    def node(half: NDArray[np.bool_], level: int) -> str:
        if half.all() or not half.any():
            return f"1'b{int(half[0])}"
        key = half.tobytes()
        if key not in known:
            middle = len(half) // 2
            low, high = node(half[:middle], level - 1), node(half[middle:], level - 1)
            if low == high:
                known[key] = low
            else:
                known[key] = f"{prefix}_{len(lines)}"
                lines.append(f"  wire {known[key]} = {address[level - 1]} ? {high} : {low};")
        return known[key]

    return lines, node(contents, len(address))


def _pixel(specification: Specification) -> str:
    encoder, class_width = specification.encoder, specification.class_width
    code_bits = ", ".join(f"rgb[{position}]" for position in reversed(encoder.pixel_positions))
    return "\n".join(
        [
            f"module {reference_name('pixel')}(input [23:0] rgb, output [{class_width - 1}:0] class_bits);",
            f"  wire [{encoder.width - 1}:0] code = {{{code_bits}}};",
            *_winner(specification.model, class_width),
            "endmodule",
            "",
        ]
    )


def _neighbourhood(specification: NeighbourhoodSpecification) -> str:
    ((port, width),) = specification.part("neighbourhood").inputs.items()
    class_width = specification.class_width
    return "\n".join(
        [
            f"module {reference_name('neighbourhood')}(input [{width - 1}:0] {port}, "
            f"output [{class_width - 1}:0] class_bits);",
            *_window_code(specification),
            *_winner(specification.model, class_width),
            "endmodule",
            "",
        ]
    )


def _care_neighbourhood(specification: NeighbourhoodSpecification) -> str:
    ((port, width),) = specification.part("neighbourhood").inputs.items()
    address = [f"code[{i}]" for i in range(specification.encoder.width)]
    lines, cared = lookup("n", specification.care, address)
    return "\n".join(
        [
            f"module care_neighbourhood(input [{width - 1}:0] {port}, output cared);",
            *_window_code(specification),
            *lines,
            f"  assign cared = {cared};",
            "endmodule",
            "",
        ]
    )


def _window_code(specification: NeighbourhoodSpecification) -> list[str]:
    """Lines that make the wire ``code`` of a window: each tap's table at its pixel."""
    encoder = specification.encoder
    lines, bits = [], []
    for i, tap in enumerate(encoder.taps):
        low = 24 * (encoder.size * tap.row + tap.column)
        address = [f"window[{low + position}]" for position in tap.pixel.pixel_positions]
        tap_lines, bit = lookup(f"tap_{i}", tap.table, address)
        lines += tap_lines
        bits.append(bit)
    return [*lines, f"  wire [{encoder.width - 1}:0] code = {{{', '.join(reversed(bits))}}};"]


def _winner(model: WisardModel, class_width: int) -> list[str]:
    """Lines that drive ``class_bits`` with the winning class for the wire ``code``."""
    sum_width = model.rams.bit_length()
    lines = []
    fires = model.counts >= model.bleaching
    for discriminator in range(len(model.classes)):
        mapping = model.mapping[discriminator if len(model.mapping) > 1 else 0]
        answers = []
        for ram, inputs in enumerate(mapping):
            address = [f"code[{position}]" for position in inputs]
            ram_lines, answer = lookup(f"ram_{discriminator}_{ram}", fires[discriminator, ram], address)
            lines += ram_lines
            answers.append(answer)
        lines.append(f"  wire [{sum_width - 1}:0] response_{discriminator} = {_sum(answers, sum_width)};")
    lines += [
        f"  wire [{sum_width - 1}:0] best_0 = response_0;",
        f"  wire [{class_width - 1}:0] class_0 = {class_width}'d0;",
    ]
    for challenger in range(1, len(model.classes)):
        # A strict comparison: among equal responses the class named first stays.
        last = challenger - 1
        lines += [
            f"  wire wins_{challenger} = response_{challenger} > best_{last};",
            f"  wire [{sum_width - 1}:0] best_{challenger} = "
            f"wins_{challenger} ? response_{challenger} : best_{last};",
            f"  wire [{class_width - 1}:0] class_{challenger} = "
            f"wins_{challenger} ? {class_width}'d{challenger} : class_{last};",
        ]
    return [*lines, f"  assign class_bits = class_{len(model.classes) - 1};"]


def _edge(edge_filter: EdgeFilter) -> str:
    lines, answer = lookup("n", edge_filter.patterns, [f"bits[{i}]" for i in range(WINDOW_BITS)])
    return "\n".join(
        [
            f"module {reference_name('edge')}(input [{WINDOW_BITS - 1}:0] bits, output edge_bit);",
            *lines,
            f"  assign edge_bit = {answer};",
            "endmodule",
            "",
        ]
    )


def _match(specification: Specification) -> str:
    width = specification.part("match").outputs["match_count"]
    count = _sum([f"same[{i}]" for i in range(WINDOW_BITS)], width)
    return "\n".join(
        [
            f"module {reference_name('match')}(input [{WINDOW_BITS - 1}:0] bits, "
            f"input [{WINDOW_BITS - 1}:0] reference, output [{width - 1}:0] match_count);",
            f"  wire [{WINDOW_BITS - 1}:0] same = ~(bits ^ reference);",
            f"  assign match_count = {count};",
            "endmodule",
            "",
        ]
    )


def _block(specification: Specification) -> str:
    lines = [f"module {reference_name('block')}(input [215:0] window, output [8:0] bits, output edge_bit);"]
    for pixel in range(WINDOW_BITS):
        lines += [
            f"  wire [{specification.class_width - 1}:0] class_{pixel};",
            f"  {reference_name('pixel')} pixel_{pixel} "
            f"(.rgb(window[{24 * pixel + 23}:{24 * pixel}]), .class_bits(class_{pixel}));",
            f"  assign bits[{pixel}] = |class_{pixel};",
        ]
    lines += [
        f"  {reference_name('edge')} edge_filter (.bits(bits), .edge_bit(edge_bit));",
        "endmodule",
        "",
    ]
    return "\n".join(lines)


def _block_match(specification: Specification) -> str:
    count = specification.part("block_match").outputs["match_count"]
    return "\n".join(
        [
            f"module {reference_name('block_match')}(input [215:0] window, input [8:0] reference, "
            f"output [8:0] bits, output edge_bit, output [{count - 1}:0] match_count);",
            f"  {reference_name('block')} block (.window(window), .bits(bits), .edge_bit(edge_bit));",
            f"  {reference_name('match')} bit_match "
            "(.bits(bits), .reference(reference), .match_count(match_count));",
            "endmodule",
            "",
        ]
    )


def _sum(bits: Sequence[str], width: int) -> str:
    """A plain sum of single bits, each extended to the width of the result."""
    return " + ".join(f"{{{width - 1}'d0, {bit}}}" if width > 1 else bit for bit in bits)
