"""Straightforward Verilog of a network: what an engineer writes by hand from the model.

Thresholds are comparisons, tables are vectors of constants that are indexed, sums are ``+`` and the winner is
a chain of comparisons. What that takes is up to synthesis.
"""

from collections.abc import Sequence

import numpy as np

from wnn2hdl.ir import Thermometer, WisardModel
from wnn2hdl.ir.encoder import Encoder
from wnn2hdl.ir.models import LutGroupModel, SparseWisardModel, SumLayer, TableSumModel, VotingModel
from wnn2hdl.ir.models.base import ZERO

TOP = "plain"


def plain_verilog(model: VotingModel | TableSumModel) -> str:
    """The module `TOP` with the ports ``features`` and ``class_bits`` of a network."""
    lines, width, values = _sums(model) if isinstance(model, TableSumModel) else _votes(model)
    bits = (len(model.classes) - 1).bit_length()
    best, index = values[0], f"{bits}'d0"
    for number, value in enumerate(values[1:], start=1):
        wins = f"{value} {'>' if model.ties == 'first' else '>='} {best}"
        lines += [
            f"  wire wins_{number} = {wins};",
            f"  wire {_range(values[0], width)} best_{number} = wins_{number} ? {value} : {best};",
            f"  wire [{bits - 1}:0] index_{number} = wins_{number} ? {bits}'d{number} : {index};",
        ]
        best, index = f"best_{number}", f"index_{number}"
    ports = f"input [{_width(model.encoder) - 1}:0] features, output [{bits - 1}:0] class_bits"
    return "\n".join([f"module {TOP}({ports});", *lines, f"  assign class_bits = {index};", "endmodule", ""])


def _range(value: str, width: int) -> str:
    return f"signed [{width - 1}:0]" if value.startswith("value") else f"[{width - 1}:0]"


def _width(encoder: Encoder) -> int:
    if isinstance(encoder, Thermometer):
        assert encoder.input is not None
        return encoder.features * encoder.input.bits
    return encoder.width


def _bits(encoder: Encoder) -> tuple[list[str], list[str]]:
    """Lines, and the encoder's bits."""
    if not isinstance(encoder, Thermometer):
        return [], [f"features[{place}]" for place in range(encoder.width)]
    form = encoder.input
    assert form is not None
    lines: list[str] = []
    bits: list[str] = []
    signed = "signed " if form.signed else ""
    for feature, levels in enumerate(encoder.levels):
        low = feature * form.bits
        lines.append(
            f"  wire {signed}[{form.bits - 1}:0] x_{feature} = features[{low + form.bits - 1}:{low}];"
        )
        for place, level in enumerate(levels):
            if not form.lowest < level <= form.highest:
                bits.append(f"1'b{int(level <= form.lowest)}")
                continue
            constant = f"{'-' if level < 0 else ''}{form.bits}'{'s' if form.signed else ''}d{abs(level)}"
            bits.append(f"t_{feature}_{place}")
            lines.append(f"  wire {bits[-1]} = x_{feature} >= {constant};")
    return lines, bits


def _votes(model: VotingModel) -> tuple[list[str], int, list[str]]:
    """Lines, the width of a response and the names of all."""
    lines, bits = _bits(model.encoder)
    if isinstance(model, LutGroupModel):
        for number, layer in enumerate(model.layers):
            contents = [table.tolist() for table in layer.tables]
            bits = _tables(lines, f"node_{number}", layer.mapping.tolist(), contents, bits)
        owners = model.groups.tolist()
    else:
        owners = np.repeat(np.arange(len(model.classes)), model.rams).tolist()
        own = len(model.mapping) > 1
        mapping = [row for c in range(len(model.classes)) for row in model.mapping[c * own].tolist()]
        bits = _tables(lines, "ram", mapping, _contents(model), bits)
    votes: list[list[str]] = [[] for _ in model.classes]
    for bit, owner in zip(bits, owners, strict=True):
        votes[owner].append(bit)
    width = max(map(len, votes)).bit_length()
    lines += [f"  wire [{width - 1}:0] votes_{c} = {' + '.join(word)};" for c, word in enumerate(votes)]
    return lines, width, [f"votes_{c}" for c in range(len(votes))]


def _contents(model: WisardModel | SparseWisardModel) -> list[list[bool]]:
    assert isinstance(model.bleaching, int)
    if isinstance(model, WisardModel):
        fires = (model.counts >= model.bleaching).reshape(-1, 1 << model.address_bits)
        return [row.tolist() for row in fires]
    tables = []
    for ram in range(len(model.classes) * model.rams):
        table = [False] * (1 << model.address_bits)
        for address, count in zip(*model.contents(*divmod(ram, model.rams)), strict=True):
            table[int(address)] = bool(count >= model.bleaching)
        tables.append(table)
    return tables


def _tables(
    lines: list[str],
    prefix: str,
    mapping: Sequence[Sequence[int]],
    contents: Sequence[Sequence[bool]],
    bits: Sequence[str],
) -> list[str]:
    """Add tables to the lines; the bits that they make."""
    for number, (inputs, table) in enumerate(zip(mapping, contents, strict=True)):
        name, size = f"{prefix}_{number}", len(table)
        init = sum(bool(bit) << place for place, bit in enumerate(table))
        address = ", ".join("1'b0" if place == ZERO else bits[place] for place in reversed(inputs))
        lines += [
            f"  localparam [{size - 1}:0] C_{name} = {size}'h{init:x};",
            f"  wire {name} = C_{name}[{{{address}}}];",
        ]
    return [f"{prefix}_{number}" for number in range(len(mapping))]


def _sums(model: TableSumModel) -> tuple[list[str], int, list[str]]:
    """As `_votes`."""
    lines: list[str] = []
    words = [
        f"features[{(place + 1) * model.layers[0].input_bits - 1}:{place * model.layers[0].input_bits}]"
        for place in range(_width(model.encoder) // model.layers[0].input_bits)
    ]
    values: list[str] = []
    for number, layer in enumerate(model.layers):
        values = [f"value_{number}_{node}" for node in range(layer.nodes)]
        for node in range(layer.nodes):
            lines += _node(layer, number, node, words)
        words = [f"word_{number}_{node}" for node in range(layer.nodes)]
        lines += [
            f"  wire [{layer.output_bits - 1}:0] {word} = {value} + {layer.output_bits}'d{-layer.lowest};"
            for word, value in zip(words, values, strict=True)
        ]
    return lines, model.layers[-1].output_bits, values


def _node(layer: SumLayer, number: int, node: int, words: Sequence[str]) -> list[str]:
    """What the edges of a node give, its sum and its value within the node's range."""
    edges = range(*layer.edges(node).indices(len(layer.values)))
    size = 1 << layer.input_bits
    most = sum(int(np.abs(layer.values[edge]).max()) for edge in edges)
    width = max(most.bit_length() + 1, layer.output_bits + 1)
    lines, terms = [], [f"{width}'sd0"]
    for edge in edges:
        name = f"edge_{number}_{edge}"
        own = int(np.abs(layer.values[edge]).max()).bit_length() + 1
        for place in range(own):
            init = sum((int(value) >> place & 1) << code for code, value in enumerate(layer.values[edge]))
            lines.append(f"  localparam [{size - 1}:0] C_{name}_{place} = {size}'h{init:x};")
        read = ", ".join(f"C_{name}_{place}[{words[layer.sources[edge]]}]" for place in reversed(range(own)))
        lines.append(f"  wire signed [{own - 1}:0] {name} = {{{read}}};")
        terms.append(name)
    total = f"total_{number}_{node}"
    low, high = f"-{width}'sd{-layer.lowest}", f"{width}'sd{-layer.lowest - 1}"
    return [
        *lines,
        f"  wire signed [{width - 1}:0] {total} = {' + '.join(terms)};",
        f"  wire signed [{layer.output_bits - 1}:0] value_{number}_{node} = "
        f"{total} < {low} ? {low} : {total} > {high} ? {high} : {total};",
    ]
