"""What a LUT computes, for a person to read: contents, expression, and a table of at most eight by eight."""

from dataclasses import dataclass

from wnn2hdl.ir import Lut, equation


@dataclass(frozen=True)
class Grid:
    """A truth table folded into two dimensions.

    Attributes:
        across: inputs that the columns count through, the least significant last, as numbers are written.
        down: inputs that the rows count through, in the same order; empty for a table of one row.
        columns: their values at each column, as in ``010``.
        rows: (values of `down`, output at each column) of each row.
    """

    across: tuple[str, ...]
    down: tuple[str, ...]
    columns: tuple[str, ...]
    rows: tuple[tuple[str, tuple[int, ...]], ...]


def contents(lut: Lut) -> str:
    """The INIT value as Verilog writes it: ``64'h8000000000000000``."""
    size = 1 << len(lut.inputs)
    return f"{size}'h{lut.init:0{max(1, size // 4)}x}"


def grid(lut: Lut) -> Grid:
    """The truth table with the lower half of the inputs across and the rest down."""
    width = (len(lut.inputs) + 1) // 2
    height = len(lut.inputs) - width
    rows = tuple(
        (
            f"{row:0{height}b}" if height else "",
            tuple(lut.init >> (row << width | column) & 1 for column in range(1 << width)),
        )
        for row in range(1 << height)
    )
    return Grid(
        lut.inputs[:width][::-1],
        lut.inputs[width:][::-1],
        tuple(f"{column:0{width}b}" for column in range(1 << width)),
        rows,
    )


def expression(lut: Lut) -> str:
    """The function in Verilog's operators, over the names of the LUT's inputs."""
    return equation(lut.init, len(lut.inputs)).text(lut.inputs)
