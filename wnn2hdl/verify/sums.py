"""What a network of sums of tables has to compute: layer by layer, as its model defines them.

A layer's totals are proved to be sums of the model's tables (`wnn2hdl.verify.addition`), on all words that
may occur. What saturates them is proved against the definition, on every total, and so is the winner. What is
left is wiring, which makes the model of these pieces (`wnn2hdl.verify.composition`). Which words may occur on
a layer is found from the model: those that the layer before can make at all.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import codes_to_bits
from wnn2hdl.ir.models import SumLayer, TableSumModel
from wnn2hdl.ir.models.sums import Total
from wnn2hdl.ir.wires import Bits
from wnn2hdl.verify.addition import Sums, TableSum
from wnn2hdl.verify.composition import Box, Composition, Piece, bits
from wnn2hdl.verify.network import PART, SAMPLES
from wnn2hdl.verify.reference import class_bits, lookup, module, winning
from wnn2hdl.verify.specification import Claim, Samples, Specification


def sums_specification(model: TableSumModel) -> Specification:
    """The claim of a model whose features are words, and those of its pieces."""
    pieces: dict[str, Piece] = {}
    boxes: dict[str, Box] = {}
    reference: list[str] = []

    def add(part: str, box: str, piece: Piece, lines: Sequence[str], drivers: Sequence[str]) -> list[str]:
        """Add a piece that reads these bits; what drives the bits of its outputs."""
        pieces[part] = piece
        left = iter(drivers)
        inputs = {
            port: tuple(bit for _, bit in zip(range(width), left, strict=False))
            for port, width in piece.inputs.items()
        }
        boxes[box] = Box(part, inputs)
        reference.append(module(f"proof__{part}", piece.inputs, piece.outputs, lines))
        return [bit for port, width in piece.outputs.items() for bit in bits(f"{box}.{port}", width)]

    drivers = list(bits("features", model.width))
    for number in range(len(model.layers)):
        drivers = add(f"layer_{number}", f"adds_{number}", *_adding(model, number), drivers)
        drivers = add(f"saturation_{number}", f"saturates_{number}", *_saturating(model, number), drivers)
    drivers = add("winner", "winner", *_winner(model), drivers)
    modules = "\n".join(reference)
    composition = Composition(PART, pieces, boxes, {"class_bits": tuple(drivers)}, modules)
    claim = _network(model)
    whole = module(claim.module, claim.inputs, claim.outputs, _wiring(pieces))
    return Specification({PART: claim}, f"{modules}\n{whole}", "", composition)


def _adding(model: TableSumModel, number: int) -> tuple[Piece, list[str]]:
    """``words`` to the total of each node: the sum of its edges and `Total.offset`."""
    layer, totals, occurring = model.layers[number], model.totals[number], model.occurring(number)
    added = tuple(
        TableSum(f"total_{node}", total.bits, _tables(layer, node), total.offset)
        for node, total in enumerate(totals)
    )
    piece = Piece(
        "the totals are sums of the model's tables, for all words that may occur",
        None,
        {"words": len(occurring) * layer.input_bits},
        {f"total_{node}": total.bits for node, total in enumerate(totals)},
        sums=Sums("words", layer.input_bits, occurring, added),
    )
    return piece, _sum_lines(layer, totals)


def _tables(layer: SumLayer, node: int) -> dict[int, NDArray[np.int64]]:
    """What a node adds for each code of each word that it reads."""
    found: dict[int, NDArray[np.int64]] = {}
    for edge in range(*layer.edges(node).indices(len(layer.values))):
        source = int(layer.sources[edge])
        added = layer.values[edge].astype(np.int64)
        found[source] = found[source] + added if source in found else added
    return found


def _words(occurring: Sequence[NDArray[np.bool_]]) -> Bits:
    """Random words of those that may occur, side by side."""
    rng = np.random.default_rng(0)
    size = len(occurring[0]).bit_length() - 1
    columns = [codes_to_bits(rng.choice(np.flatnonzero(codes), SAMPLES), size) for codes in occurring]
    return np.concatenate(columns, axis=1)


def _sum_lines(layer: SumLayer, totals: Sequence[Total]) -> list[str]:
    lines: list[str] = []
    for node, total in enumerate(totals):
        terms = [f"{total.bits}'d{total.offset % (1 << total.bits)}"]
        for source, table in _tables(layer, node).items():
            address = [f"words[{source * layer.input_bits + place}]" for place in range(layer.input_bits)]
            name, bits = f"added_{node}_{source}", []
            for place in range(total.bits):
                made, bit = lookup(f"{name}_{place}", (table >> place & 1).astype(np.bool_), address)
                lines += made
                bits.append(bit)
            lines.append(f"  wire [{total.bits - 1}:0] {name} = {{{', '.join(reversed(bits))}}};")
            terms.append(name)
        lines.append(f"  assign total_{node} = {' + '.join(terms)};")
    return lines


def _saturating(model: TableSumModel, number: int) -> tuple[Piece, list[str]]:
    """Totals to ``words``: below the range of a node is its lowest value, above it is its highest."""
    layer, totals = model.layers[number], model.totals[number]
    size = layer.output_bits
    # A node's lowest value is the address 0, and its total that plus these.
    least = [total.offset + layer.lowest for total in totals]
    lines = []
    for node, total in enumerate(totals):
        # One bit more than both numbers need.
        width = max(total.bits, size, least[node].bit_length()) + 1
        above = f"{width}'d{least[node] + (1 << size)}"
        lines += [
            f"  wire [{width - 1}:0] wide_{node} = total_{node};",
            f"  wire [{width - 1}:0] within_{node} = wide_{node} - {width}'d{least[node]};",
            f"  assign words[{(node + 1) * size - 1}:{node * size}] = wide_{node} < {width}'d{least[node]} ? "
            f"{size}'d0 : wide_{node} >= {above} ? {size}'d{(1 << size) - 1} : within_{node}[{size - 1}:0];",
        ]
    piece = Piece(
        "the words are the totals, saturated, for all totals",
        f"proof__saturation_{number}",
        {f"total_{node}": total.bits for node, total in enumerate(totals)},
        {"words": size * len(totals)},
    )
    return piece, lines


def _winner(model: TableSumModel) -> tuple[Piece, list[str]]:
    count, size = len(model.classes), model.layers[-1].output_bits
    piece = Piece(
        f"the index of the largest number, of equal ones the {model.ties}, for all numbers",
        "proof__winner",
        {f"response_{number}": size for number in range(count)},
        {"class_bits": class_bits(model)},
    )
    return piece, winning(count, size, ties=model.ties)


def _network(model: TableSumModel) -> Claim:
    width = class_bits(model)

    def answers(inputs: Samples) -> dict[str, Bits]:
        return {"class_bits": codes_to_bits(model.evaluate(inputs["features"]), width)}

    def stimulus() -> dict[str, Bits]:
        return {"features": _words(model.occurring(0))}

    inputs, outputs = {"features": model.width}, {"class_bits": width}
    return Claim(PART, inputs, outputs, f"proof__{PART}", answers, stimulus)


def _wiring(pieces: Mapping[str, Piece]) -> list[str]:
    """The pieces one after the other, each of which reads all that the one before makes."""
    lines: list[str] = []
    word = "features"
    for part, piece in pieces.items():
        made = f"made_{part}"
        pins = [*_pins(piece.inputs, word), *_pins(piece.outputs, made)]
        lines += [
            f"  wire [{sum(piece.outputs.values()) - 1}:0] {made};",
            f"  proof__{part} {part} ({', '.join(pins)});",
        ]
        word = made
    return [*lines, f"  assign class_bits = {word};"]


def _pins(ports: Mapping[str, int], word: str) -> list[str]:
    """Ports connected to the bits of a word, the first to the lowest."""
    ends = np.cumsum(list(ports.values())).tolist()
    return [
        f".{port}({word}[{end - 1}:{end - width}])"
        for (port, width), end in zip(ports.items(), ends, strict=True)
    ]
