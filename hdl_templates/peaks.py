"""The best of many scores, the best one elsewhere, and their sums: the end of a match engine.

What "elsewhere" means is defined in `wnn2hdl.ir.engine`: not in the cell of the best, nor in one that touches
it. The best score of each cell is kept in a memory. When all scores are there, the memory is read twice: for
the best of all, and for the best of those cells that are not near.
"""

from typing import Any

from amaranth.hdl import Cat, Module, Mux, ResetInserter, Signal, Value
from amaranth.lib.memory import Memory
from amaranth.lib.wiring import In, Out

from hdl_templates.hierarchy import Part
from wnn2hdl.ir.engine import CELL, EngineFormat

_CELL_BITS = CELL.bit_length() - 1


class Peaks(Part):
    """The best of the scores of all positions, and the best one elsewhere.

    Args:
        engine: sizes.

    Members:
        reset: In, synchronous.
        valid: In, whether a score comes; they come in the order of their positions, row by row.
        score: In, the score.
        done: Out, for one cycle: the outputs are those of all scores, until the next score comes.
        best, second: Out, row and column of a position and its score, from the lowest bits.
        alone: Out, there is no position elsewhere.
        total, squares: Out, the sum of all scores and of their squares.
    """

    clocked = True
    clock = "aclk"
    module_name = "peaks"

    def __init__(self, *, engine: EngineFormat) -> None:
        self.engine = engine
        rows, columns = engine.positions
        most = rows * columns * engine.template[0] * engine.template[1]
        self.places = (rows - 1).bit_length(), (columns - 1).bit_length()
        width = sum(self.places) + engine.score_bits
        super().__init__(
            {
                "reset": In(1),
                "valid": In(1),
                "score": In(engine.score_bits),
                "done": Out(1),
                "best": Out(width),
                "second": Out(width),
                "alone": Out(1),
                "total": Out(most.bit_length()),
                "squares": Out((most * engine.template[0] * engine.template[1]).bit_length()),
            }
        )

    def elaborate(self, platform: object) -> Any:  # noqa: ARG002  # there are no parts inside
        """The best of each cell while scores come, then the best of the cells."""
        m = Module()
        rows, columns = self.engine.positions
        cells = self.engine.cells[0] * self.engine.cells[1]
        row = Signal(range(max(rows, 2)), name="row")
        column = Signal(range(max(columns, 2)), name="column")
        line_ends, ends = Signal(name="line_ends"), Signal(name="ends")
        m.d.comb += [line_ends.eq(column == columns - 1), ends.eq(line_ends & (row == rows - 1))]
        with m.If(self.valid):
            m.d.sync += column.eq(Mux(line_ends, 0, column + 1))
            with m.If(line_ends):
                m.d.sync += row.eq(Mux(ends, 0, row + 1))
        self._sums(m, (row == 0) & (column == 0))

        # The best of the part of a row that lies in a cell. Of equal scores the first one stays.
        entry = Cat(row[: self.places[0]], column[: self.places[1]], self.score)
        low = sum(self.places)
        run, run_ends = Signal(len(entry), name="run", reset_less=True), Signal(name="run_ends")
        starts, cell_ends = Signal(name="starts"), Signal(name="cell_ends")
        m.d.comb += [
            starts.eq(column[:_CELL_BITS] == 0),
            cell_ends.eq(line_ends | column[:_CELL_BITS].all() if columns > CELL else line_ends),
        ]
        with m.If(self.valid & (starts | (self.score > run[low:]))):
            m.d.sync += run.eq(entry)
        m.d.sync += run_ends.eq(self.valid & cell_ends)

        # It is compared with the best of the rows above in the cell.
        place, first_place = (Signal(range(max(cells, 2)), name=name) for name in ("place", "first_place"))
        memory = Memory(shape=len(entry), depth=max(cells, 2), init=[])
        m.submodules.cells = memory
        write, read = memory.write_port(), memory.read_port()
        written, fresh = (
            Signal(range(max(cells, 2)), name="written", reset_less=True),
            Signal(name="fresh", reset_less=True),
        )
        last_in_cell = row[:_CELL_BITS].all() if rows > CELL else row == rows - 1
        scans, scanned = Signal(name="scans"), Signal(range(max(cells, 2)), name="scanned")
        m.d.sync += [written.eq(place), fresh.eq(row[:_CELL_BITS] == 0)]
        with m.If(self.valid & cell_ends):
            m.d.sync += place.eq(place + 1)
            with m.If(line_ends):
                m.d.sync += place.eq(Mux(ends, 0, Mux(last_in_cell, place + 1, first_place)))
                with m.If(last_in_cell | ends):
                    m.d.sync += first_place.eq(Mux(ends, 0, place + 1))
        m.d.comb += [
            read.addr.eq(Mux(scans, scanned, place)),
            write.addr.eq(written),
            write.data.eq(run),
            write.en.eq(run_ends & (fresh | (run[low:] > read.data[low:]))),
        ]
        self._scan(m, read.data, scans, scanned, ends & self.valid, cells)
        return ResetInserter(self.reset)(m)

    def _sums(self, m: Module, first: Value) -> None:
        """Add up scores and squares."""
        square = Signal(2 * len(self.score), name="square", reset_less=True)
        adds, restarts = Signal(name="adds"), Signal(name="restarts", reset_less=True)
        m.d.sync += [square.eq(self.score * self.score), adds.eq(self.valid), restarts.eq(first)]
        with m.If(self.valid):
            m.d.sync += self.total.eq(Mux(first, 0, self.total) + self.score)
        with m.If(adds):
            m.d.sync += self.squares.eq(Mux(restarts, 0, self.squares) + square)

    def _scan(self, m: Module, kept: Value, scans: Signal, scanned: Signal, ends: Value, cells: int) -> None:
        """Read the best of all cells twice."""
        ready, again = Signal(name="ready"), Signal(name="again")
        arrives, arrives_again, first, last = (
            Signal(name=name) for name in ("arrives", "arrives_again", "first", "last")
        )
        m.d.sync += [
            ready.eq(ends),
            arrives.eq(scans),
            arrives_again.eq(again),
            first.eq(scanned == 0),
            last.eq(scans & again & (scanned == cells - 1)),
            self.done.eq(last),
        ]
        with m.If(ready):
            m.d.sync += [scans.eq(1), again.eq(0), scanned.eq(0)]
        with m.If(scans):
            m.d.sync += scanned.eq(scanned + 1)
            with m.If(scanned == cells - 1):
                m.d.sync += [scanned.eq(0), again.eq(1), scans.eq(~again)]
        # The better one has the greater score, then the lower row, then the lower column.
        near = Signal(name="near")
        m.d.comb += near.eq(self._near(kept, 0) & self._near(kept, 1))

        def beats(other: Value) -> Value:
            return self._order(kept) > self._order(other)

        with m.If(arrives & ~arrives_again & (first | beats(self.best))):
            m.d.sync += [self.best.eq(kept), self.alone.eq(1)]
        with m.If(arrives & arrives_again & ~near & (self.alone | beats(self.second))):
            m.d.sync += [self.second.eq(kept), self.alone.eq(0)]

    def _order(self, entry: Value) -> Value:
        rows, columns = self.places
        return Cat(~entry[rows : rows + columns], ~entry[:rows], entry[rows + columns :])

    def _near(self, entry: Value, axis: int) -> Value:
        """Whether a cell and that of the best are neighbours along an axis, or in one line."""
        start, width = (0, self.places[0]) if axis == 0 else self.places
        if width <= _CELL_BITS:
            return Value.cast(1)
        cell, best = (word[start + _CELL_BITS : start + width] for word in (entry, self.best))
        return (cell == best) | (cell + 1 == best) | (best + 1 == cell)
