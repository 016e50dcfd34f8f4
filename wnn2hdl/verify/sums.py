"""What a network of sums of tables has to compute: layer by layer, as its model defines them.

A layer's totals are proved to be sums of the model's tables (`wnn2hdl.verify.addition`), on all words that
may occur. What saturates them is proved against the definition, on every total. The whole network is then
proved with the reference of each of these circuits in its place: if it is right with what the model says of
them, and they are what the model says, it is right. Which words may occur on a layer is found from the model:
those that the layer before can make at all.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import codes_to_bits
from wnn2hdl.ir.models import SumLayer, TableSumModel
from wnn2hdl.ir.models.sums import Total
from wnn2hdl.ir.wires import Bits
from wnn2hdl.verify.addition import Sums, TableSum
from wnn2hdl.verify.network import SAMPLES
from wnn2hdl.verify.reference import class_bits, lookup, module, winning
from wnn2hdl.verify.specification import Claim, Samples, Specification


def sums_specification(model: TableSumModel) -> Specification:
    """The claims of a model whose features are words."""
    claims: list[Claim] = []
    reference: list[str] = []
    for number in range(len(model.layers)):
        for claim, lines in (_adding(model, number), _saturating(model, number)):
            claims.append(claim)
            reference.append(module(claim.module, claim.inputs, claim.outputs, lines))
    network = _network(model, tuple(claim.part for claim in claims))
    reference.append(module(network.module, network.inputs, network.outputs, _wiring(model, claims)))
    return Specification({claim.part: claim for claim in (*claims, network)}, "\n".join(reference), "")


def _adding(model: TableSumModel, number: int) -> tuple[Claim, list[str]]:
    """``words`` to the total of each node: the sum of its edges and `Total.offset`."""
    layer, totals, occurring = model.layers[number], model.totals[number], model.occurring(number)
    sums = Sums(
        "words",
        layer.input_bits,
        occurring,
        tuple(
            TableSum(f"total_{node}", _tables(layer, node), total.offset) for node, total in enumerate(totals)
        ),
    )

    def answers(inputs: Samples) -> dict[str, Bits]:
        bits = inputs["words"].reshape(len(inputs["words"]), -1, layer.input_bits)
        words = (bits @ (1 << np.arange(layer.input_bits, dtype=np.int64))).T
        found = {}
        for node, total in enumerate(totals):
            value = np.full(words.shape[1], total.offset)
            for source, table in _tables(layer, node).items():
                value += table[words[source]]
            found[f"total_{node}"] = codes_to_bits(value % (1 << total.bits), total.bits)
        return found

    claim = Claim(
        f"layer_{number}",
        {"words": len(occurring) * layer.input_bits},
        {f"total_{node}": total.bits for node, total in enumerate(totals)},
        f"proof__layer_{number}",
        answers,
        lambda: {"words": _words(occurring)},
        sums=sums,
    )
    return claim, _sum_lines(layer, totals)


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


def _saturating(model: TableSumModel, number: int) -> tuple[Claim, list[str]]:
    """Totals to ``words``: below the range of a node is its lowest value, above it is its highest."""
    layer, totals = model.layers[number], model.totals[number]
    size = layer.output_bits
    # A node's lowest value is the address 0, and its total that plus these.
    least = [total.offset + layer.lowest for total in totals]

    def answers(inputs: Samples) -> dict[str, Bits]:
        words = []
        for node, total in enumerate(totals):
            value = inputs[f"total_{node}"] @ (1 << np.arange(total.bits, dtype=np.int64))
            words.append(codes_to_bits(np.clip(value - least[node], 0, (1 << size) - 1), size))
        return {"words": np.concatenate(words, axis=1)}

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
    claim = Claim(
        f"saturation_{number}",
        {f"total_{node}": total.bits for node, total in enumerate(totals)},
        {"words": size * len(totals)},
        f"proof__saturation_{number}",
        answers,
        None,
    )
    return claim, lines


def _network(model: TableSumModel, pieces: tuple[str, ...]) -> Claim:
    width = class_bits(model)

    def answers(inputs: Samples) -> dict[str, Bits]:
        return {"class_bits": codes_to_bits(model.evaluate(inputs["features"]), width)}

    def stimulus() -> dict[str, Bits]:
        return {"features": _words(model.occurring(0))}

    return Claim(
        "network",
        {"features": model.width},
        {"class_bits": width},
        "proof__network",
        answers,
        stimulus,
        pieces=pieces,
    )


def _wiring(model: TableSumModel, claims: Sequence[Claim]) -> list[str]:
    """The layers one after the other, and the winner."""
    lines, nets = [], {"words": "features"}
    for number, claim in enumerate(claims):
        driven = {port: f"stage_{number}_{port}" for port in claim.outputs}
        lines += [f"  wire [{width - 1}:0] {driven[port]};" for port, width in claim.outputs.items()]
        inputs = {port: nets[port] for port in claim.inputs}
        pins = ", ".join(f".{port}({net})" for port, net in [*inputs.items(), *driven.items()])
        lines.append(f"  {claim.module} stage_{number} ({pins});")
        nets = driven
    size = model.layers[-1].output_bits
    for number in range(len(model.classes)):
        word = f"{nets['words']}[{(number + 1) * size - 1}:{number * size}]"
        lines.append(f"  wire [{size - 1}:0] response_{number} = {word};")
    return [*lines, *winning(len(model.classes), size, ties=model.ties)]
