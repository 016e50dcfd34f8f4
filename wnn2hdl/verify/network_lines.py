"""Reference Verilog of the parts of a network, straight from the model: thresholds, tables, votes."""

from collections.abc import Container, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.ir import Thermometer, WisardModel
from wnn2hdl.ir.encoder import Encoder
from wnn2hdl.ir.features import ThermometerBits, Words
from wnn2hdl.ir.models import BloomWisardModel, LutGroupModel, NetworkModel, SparseWisardModel
from wnn2hdl.ir.models.base import ZERO
from wnn2hdl.verify.bloom_lines import filter_lines
from wnn2hdl.verify.reference import lookup


def features_width(encoder: Encoder) -> int:
    """Bits of the port ``features``."""
    if isinstance(encoder, Thermometer) and encoder.input is not None:
        return encoder.features * encoder.input.bits
    if isinstance(encoder, Words | ThermometerBits):
        return encoder.width
    raise InputError(
        "the model states no fixed-point format of its features",
        value=encoder.kind,
        hint="state one with --input",
    )


def positions_read(model: NetworkModel) -> set[int]:
    """The encoder's bits that the model's tables read."""
    mapping = model.layers[0].mapping if isinstance(model, LutGroupModel) else model.mapping
    return {int(position) for position in np.unique(mapping) if position != ZERO}


def encoder_lines(encoder: Encoder, read: Container[int]) -> tuple[list[str], list[str]]:
    """Lines and, for each bit of the encoder, its expression.

    Args:
        encoder: of features.
        read: the bits that matter; the others are not compared with anything, and are 0.
    """
    if not isinstance(encoder, Thermometer):
        return [], [f"features[{position}]" for position in range(features_width(encoder))]
    form = encoder.input
    assert form is not None
    lines: list[str] = []
    signals: list[str] = []
    for feature, levels in enumerate(encoder.levels):
        low = feature * form.bits
        word = f"features[{low + form.bits - 1}:{low}]"
        shift = f" ^ {form.bits}'h{1 << (form.bits - 1):x}" if form.signed else ""
        lines.append(f"  wire [{form.bits - 1}:0] x_{feature} = {word}{shift};")
        for position, level in enumerate(levels):
            if level > form.highest or len(signals) not in read:
                signals.append("1'b0")
                continue
            name = f"x_{feature}_{position}"
            lines.append(f"  wire {name} = {at_least(f'x_{feature}', level - form.lowest, form.bits)};")
            signals.append(name)
    return lines, signals


def at_least(word: str, least: int, width: int, low: int = 0) -> str:
    """The expression ``word >= least``, bit by bit, which Yosys maps much faster than a comparison.

    From the lowest bit up: where a bit of ``least`` is set, the bit of the word has to be set, and what is
    below it has to be enough; where it is not, either will do. The word has its lowest bit at ``low``.
    """
    if least <= 0:
        return "1'b1"
    if least >> width:
        return "1'b0"
    lowest = (least & -least).bit_length() - 1
    expression = f"{word}[{low + lowest}]"
    for place in range(lowest + 1, width):
        expression = f"({word}[{low + place}] {'&' if least >> place & 1 else '|'} {expression})"
    return expression


def owners_of(model: NetworkModel) -> list[int]:
    """The class that each table of the last layer votes for."""
    if isinstance(model, LutGroupModel):
        return [int(owner) for owner in model.groups]
    if isinstance(model, BloomWisardModel):
        return np.repeat(np.arange(len(model.classes)), len(model.mapping)).tolist()
    return np.repeat(np.arange(len(model.classes)), model.rams).tolist()


def table_lines(
    model: NetworkModel, signals: Sequence[str], forms: Mapping[int, str] | None = None
) -> tuple[list[str], list[str]]:
    """Lines of all tables over the encoder's bits, and the output of each table of the last layer.

    Args:
        model: the model.
        signals: the encoder's bits.
        forms: of Bloom filters, see `wnn2hdl.verify.bloom_lines.filter_lines`.
    """
    if isinstance(model, BloomWisardModel):
        return filter_lines(model, signals, forms or {})
    lines: list[str] = []
    if isinstance(model, LutGroupModel):
        for number, layer in enumerate(model.layers):
            signals = _tables(lines, f"layer_{number}", layer.mapping.tolist(), layer.tables, signals)
        return lines, list(signals)
    mapping, contents = _rams(model)
    return lines, _tables(lines, "ram", mapping, contents, signals)


def _tables(
    lines: list[str],
    prefix: str,
    mapping: Sequence[Sequence[int]],
    contents: NDArray[np.bool_],
    signals: Sequence[str],
) -> list[str]:
    """Add tables to the lines; their outputs."""
    outputs = []
    for number, (inputs, table) in enumerate(zip(mapping, contents, strict=True)):
        address = ["1'b0" if position == ZERO else signals[position] for position in inputs]
        made, answer = lookup(f"{prefix}_{number}", table, address)
        lines += [*made, f"  wire {prefix}_{number} = {answer};"]
        outputs.append(f"{prefix}_{number}")
    return outputs


def _rams(model: WisardModel | SparseWisardModel) -> tuple[list[list[int]], NDArray[np.bool_]]:
    """Mapping and contents of all RAMs, class by class."""
    mapping = [
        inputs
        for owner in range(len(model.classes))
        for inputs in model.mapping[owner if len(model.mapping) > 1 else 0].tolist()
    ]
    if isinstance(model, WisardModel):
        return mapping, (model.counts >= model.bleaching).reshape(len(mapping), -1)
    assert isinstance(model.bleaching, int)
    contents = np.zeros((len(mapping), 1 << model.address_bits), dtype=np.bool_)
    for ram in range(len(mapping)):
        addresses, counts = model.contents(*divmod(ram, model.rams))
        contents[ram, addresses[counts >= model.bleaching].astype(np.int64)] = True
    return mapping, contents
