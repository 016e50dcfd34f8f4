"""From a model to its truth table, and from imagery to the codes the table has to care about."""

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.ir import (
    PIXEL_BIT_NAMES,
    Comparison,
    PictureEncoder,
    TruthTable,
    WisardModel,
    all_codes,
    codes_to_bits,
)
from wnn2hdl.ir.nodes import Table
from wnn2hdl.ir.relational import signal_name
from wnn2hdl.ir.wires import Slice


def pixel_table(model: WisardModel, care: NDArray[np.bool_] | None = None) -> TruthTable:
    """The model as one truth table over its input bits.

    Args:
        model: any model of at most `MAX_TABLE_INPUTS` input bits.
        care: bool ``[2**width]``, the codes that matter; all of them if left out.

    Returns:
        A table with the inputs ``model.encoder.names``, as identifiers, and the outputs ``class_bit0`` …, the
        index of the winning class in binary, least significant bit first; two classes have one output.

    Raises:
        InputError: the model reads more bits than a table may have.
    """
    outputs = (len(model.classes) - 1).bit_length()
    names = tuple(f"class_bit{position}" for position in range(outputs))
    values = codes_to_bits(model.evaluate_all_codes(), outputs)
    inputs = tuple(map(signal_name, model.encoder.names))
    table = TruthTable.exact(inputs, names, values)
    return table if care is None else table.with_care(care)


def pixel_code(names: Sequence[str]) -> tuple[list[Table], tuple[Slice, ...]]:
    """What makes bits of a pixel of the net ``rgb``.

    Args:
        names: of the bits, as in `wnn2hdl.ir.relational.Relational`.

    Returns:
        A table for each comparison, and for each bit its signal.
    """
    tables: list[Table] = []
    code: list[Slice] = []
    for name in names:
        if name in PIXEL_BIT_NAMES:
            code.append(Slice("rgb", PIXEL_BIT_NAMES[name]))
            continue
        comparison = Comparison.parse(name)
        word = tuple(Slice("rgb", PIXEL_BIT_NAMES[bit]) for bit in comparison.bits)
        node = signal_name(name)
        function = TruthTable.exact(comparison.bits, (node,), comparison.table()[:, np.newaxis])
        tables.append(Table(node, word, function))
        code.append(Slice(node))
    return tables, tuple(code)


def code_histogram(encoder: PictureEncoder, images: Iterable[NDArray[np.uint8]]) -> NDArray[np.int64]:
    """How often each code of a pixel or a neighbourhood occurs, int64 ``[2**width]``.

    Args:
        encoder: what makes codes of pictures.
        images: uint8 ``[height, width, 3]`` each; read one after the other, never held together.

    Raises:
        InputError: the encoder has more bits than a table may have.
    """
    total = np.zeros(len(all_codes(encoder.width)), dtype=np.int64)
    for image in images:
        total += np.bincount(encoder.codes(image).ravel(), minlength=len(total))
    return total


def care_set(histogram: NDArray[np.int64], minimum: int) -> NDArray[np.bool_]:
    """The codes that occur at least ``minimum`` times, bool shaped as ``histogram``.

    Raises:
        InputError: ``minimum`` is below 1, or no code occurs that often.
    """
    if minimum < 1:
        raise InputError(
            "a care set cannot ask for so few occurrences", value=minimum, hint="ask for 1 or more"
        )
    care = histogram >= minimum
    if not care.any():
        raise InputError(
            "no code occurs often enough to be cared for",
            value=f"{minimum} times asked, {histogram.max()} at most seen",
            hint="ask for fewer or give more imagery",
        )
    return care
