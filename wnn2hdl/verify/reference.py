"""Building blocks of reference Verilog, which is written straight from a model.

No table, cover, network or hardware library lies between the model and this text: discriminators are RAMs,
sums and comparisons as in the definition of a WiSARD.

A RAM of constants is written as a decision diagram: a tree of multiplexers, one address bit per level, in
which equal halves are shared. Indexing one constant vector would be equivalent, but Yosys takes eight times
as long to map it (measured for a vector of 4096 bits).
"""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import PIXEL_BIT_NAMES, Comparison, WisardModel
from wnn2hdl.ir.models import ClassifierModel, FirstOrLast


def module(name: str, inputs: Mapping[str, int], outputs: Mapping[str, int], lines: Sequence[str]) -> str:
    """A module with these ports, widths in bits, and statements."""
    ports = [f"input [{width - 1}:0] {port}" for port, width in inputs.items()]
    ports += [f"output [{width - 1}:0] {port}" for port, width in outputs.items()]
    return "\n".join([f"module {name}({', '.join(ports)});", *lines, "endmodule", ""])


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


def care_module(
    name: str, inputs: Mapping[str, int], word: str, cared: NDArray[np.bool_], lines: Sequence[str] = ()
) -> str:
    """The module that says, by ``cared``, whether what it is given matters.

    Args:
        name: of the module.
        inputs: its ports, widths in bits.
        word: the port, or the wire that the lines make, of what is cared for.
        cared: bool ``[2**width of the word]``.
        lines: that make the wire.
    """
    width = (len(cared) - 1).bit_length()
    tree, answer = lookup("n", cared, [f"{word}[{i}]" for i in range(width)])
    return module(name, inputs, {"cared": 1}, [*lines, *tree, f"  assign cared = {answer};"])


def pixel_code(names: Sequence[str], pixel: str) -> tuple[list[str], list[str]]:
    """Lines, and for each named bit of a pixel its expression, where ``pixel`` is a net of 24 bits.

    Names are those of `wnn2hdl.ir.relational.Relational`. Comparisons are of plain numbers of 32 bits, which
    their weights and offsets cannot exceed.
    """
    lines: list[str] = []
    code: list[str] = []
    for position, name in enumerate(names):
        if name in PIXEL_BIT_NAMES:
            code.append(f"{pixel}[{PIXEL_BIT_NAMES[name]}]")
            continue
        comparison = Comparison.parse(name)
        sides = []
        for terms, offset in (comparison.left, -comparison.offset), (comparison.right, comparison.offset):
            channels = [
                f"32'd{term.weight} * {pixel}[{PIXEL_BIT_NAMES[f'{term.channel}{term.high}']}:"
                f"{PIXEL_BIT_NAMES[f'{term.channel}{term.low}']}]"
                for term in terms
            ]
            sides.append(" + ".join([*channels, f"32'd{max(offset, 0)}"]))
        lines.append(f"  wire compared_{position} = ({sides[0]}) >= ({sides[1]});")
        code.append(f"compared_{position}")
    return lines, code


def winner(model: WisardModel) -> list[str]:
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
        lines.append(
            f"  wire [{sum_width - 1}:0] response_{discriminator} = {plain_sum(answers, sum_width)};"
        )
    return [*lines, *winning(len(model.classes), sum_width, ties="first")]


def winning(classes: int, width: int, *, ties: FirstOrLast) -> list[str]:
    """Lines that drive ``class_bits`` with the class of the highest of ``response_0`` and so on.

    Args:
        classes: at least 2.
        width: bits of a response.
        ties: which of several highest classes wins.
    """
    # Challengers come in turn; among equal responses a strict comparison leaves the class named first.
    compare = ">" if ties == "first" else ">="
    bits = (classes - 1).bit_length()
    lines = [f"  wire [{width - 1}:0] best_0 = response_0;", f"  wire [{bits - 1}:0] class_0 = {bits}'d0;"]
    for number in range(1, classes):
        last = number - 1
        lines += [
            f"  wire wins_{number} = response_{number} {compare} best_{last};",
            f"  wire [{width - 1}:0] best_{number} = wins_{number} ? response_{number} : best_{last};",
            f"  wire [{bits - 1}:0] class_{number} = wins_{number} ? {bits}'d{number} : class_{last};",
        ]
    return [*lines, f"  assign class_bits = class_{classes - 1};"]


def class_bits(model: WisardModel | ClassifierModel) -> int:
    """Bits of a class index: 1 for two classes."""
    return (len(model.classes) - 1).bit_length()


def plain_sum(bits: Sequence[str], width: int) -> str:
    """A plain sum of single bits, each extended to the width of the result."""
    return " + ".join(f"{{{width - 1}'d0, {bit}}}" if width > 1 else bit for bit in bits)


def weighted_sum(bits: Sequence[str], weights: Sequence[int], offset: int) -> str:
    """The sum of the weights of the bits that are set, and a constant, as wide as the largest sum."""
    width = (sum(weights) + offset).bit_length()
    terms = [f"({bit} ? {width}'d{weight} : {width}'d0)" for bit, weight in zip(bits, weights, strict=True)]
    return " + ".join([*terms, f"{width}'d{offset}"])
