"""The circuits of a classifier that counts bits in squares: what is found of a pixel, and its class."""

import numpy as np

from wnn2hdl.ir import PIXEL_BITS, Context, TruthTable, WisardModel, all_codes
from wnn2hdl.ir.care import CareSet
from wnn2hdl.ir.circuit import Care, Circuit
from wnn2hdl.ir.nodes import Table
from wnn2hdl.ir.relational import signal_name
from wnn2hdl.ir.wires import Port, Slice
from wnn2hdl.lower.deforestation import DECISION
from wnn2hdl.lower.table import pixel_code, pixel_table


def planes(encoder: Context) -> Circuit:
    """The bits of a pixel that are counted: ``rgb`` to ``plane_bits``, a bit for each of its `planes`."""
    tables, bits = pixel_code(encoder.planes)
    summary = "Bits of a pixel that are counted around others."
    return Circuit("planes", summary, (Port("rgb", PIXEL_BITS),), tuple(tables), {"plane_bits": bits})


def context(model: WisardModel, encoder: Context, care: CareSet) -> Circuit:
    """The class by what was counted around a pixel: ``counts`` to ``class_bits``.

    Args:
        model: a model that counts.
        encoder: its encoder; ``counts`` are its `sums` side by side, the first in the lowest bits.
        care: the codes of the encoder that matter.
    """
    counts = Port("counts", sum(encoder.widths))
    lows = np.cumsum((0, *encoder.widths)).tolist()
    words = {
        sum_of: Slice("counts", low, width)
        for sum_of, low, width in zip(encoder.sums, lows, encoder.widths, strict=False)
    }
    tables: list[Table] = []
    code: list[Slice] = []
    for name, count in zip(encoder.names, encoder.counts, strict=True):
        word = words[count.plane, count.size]
        if count.size == 1:
            code.append(word)
            continue
        reached = all_codes(word.width) >= count.least
        inputs = tuple(f"bit{place}" for place in range(word.width))
        function = TruthTable.exact(inputs, ("reached",), reached[:, np.newaxis])
        tables.append(Table(signal_name(name), (word,), function))
        code.append(Slice(signal_name(name)))
    possible = encoder.possible & care.project(tuple(range(encoder.width)))
    table = Table(DECISION, tuple(code), pixel_table(model).with_care(possible))
    return Circuit(
        "context",
        f"Class of a pixel, of {len(model.classes)}, by what was counted around it.",
        (counts,),
        (*tables, table),
        {"class_bits": tuple(Slice(net, 0, width) for net, width in table.drives.items())},
        (Care(tuple(code), care),),
    )
