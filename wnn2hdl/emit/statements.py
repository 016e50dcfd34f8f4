"""From the cells of a module to Verilog statements; operators that are read once are inlined."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from wnn2hdl.emit.expression import Operation, constant, render, render_word
from wnn2hdl.emit.names import Names
from wnn2hdl.emit.netlist import (
    FLIP_FLOP,
    MEMORY_CONTENTS,
    MEMORY_READ,
    MEMORY_WRITE,
    Bit,
    BitVector,
    Cell,
    Module,
    count_reads,
)

_MOST_INITIAL = 1 << 16
"""Words of the largest memory whose contents are written down: Yosys takes minutes to read more of them."""

UNUSED = "unused"
"""The wire that gathers what nothing reads; it stays although nothing reads it either."""

_BITWISE = {"$and": "&", "$or": "|", "$xor": "^"}
_ARITHMETIC = {"$add": "+", "$sub": "-", "$mul": "*"}
_COMPARISONS = {"$ge": ">=", "$gt": ">", "$le": "<=", "$lt": "<", "$eq": "==", "$ne": "!="}
_REDUCTIONS = {"$reduce_or": "|", "$reduce_bool": "|", "$reduce_and": "&", "$reduce_xor": "^"}
_KINDS = (
    {"$mux", "$not", "$neg", "$logic_not"}
    | _BITWISE.keys()
    | _ARITHMETIC.keys()
    | _COMPARISONS.keys()
    | _REDUCTIONS.keys()
)


@dataclass(frozen=True)
class Statement:
    """A statement of a module.

    Attributes:
        drives: the nets that it drives; of what writes a memory, the memory.
        reads: the nets and memories that it reads.
        text: an expression, for ``assign``; the pins of an instance; what happens at a clock edge.
        head: of an instance, what stands before its pins; empty of all others.
        marks: of a flip-flop, the attributes of its net; of what writes a memory, those of the memory.
        clock: of what happens at a clock edge, as an expression of the edge; None of all others.
        initial: of a flip-flop, and of the words of a memory that is not large, the value before the first
            edge.
        words: of what writes a memory, how many words it has.
    """

    drives: tuple[str, ...]
    reads: frozenset[str]
    text: str
    head: str = ""
    marks: str = ""
    clock: str | None = None
    initial: int | None = None
    words: int | None = None


def statements(module: Module) -> tuple[list[Statement], dict[str, int]]:
    """The statements of a module in no particular order, and the width of every net by name.

    Raises:
        NotImplementedError: a cell that no statement is known for.
    """
    return _Translation(module).run()


class _Translation:
    """One module on its way to statements."""

    def __init__(self, module: Module) -> None:
        self.module = module
        self.names = Names(module)
        self.reads = count_reads(module)
        self.drivers: dict[Bit, Cell] = {
            bit: cell for cell in module.cells for bits in cell.outputs.values() for bit in bits
        }
        self.readers: dict[Bit, list[Cell]] = {}
        for cell in module.cells:
            for bit in dict.fromkeys(bit for bits in cell.inputs.values() for bit in bits):
                self.readers.setdefault(bit, []).append(cell)
        self.hidden = self._hidden_words()
        self.read_nets: set[str] = set()

    def run(self) -> tuple[list[Statement], dict[str, int]]:
        """See `statements`."""
        words = {port: self.names.word(bits) for port, bits in self.module.outputs.items()}
        # The others are driven by a cell, under their own name.
        composed = [port for port, word in words.items() if word != [(port, 0, self.names.widths[port])]]
        found = [self._output(port, self.module.outputs[port]) for port in composed]
        for port in composed:
            if len(words[port]) > 1:
                self.names.joined_output(port)
        found += [
            self._statement(cell)
            for cell in self.module.cells
            if cell.kind != MEMORY_CONTENTS and not self._inlined(cell)
        ]
        found += [
            Statement((name,), frozenset({piece[0]}), render_word([piece], self.names.widths))
            for name, piece in self.names.aliases.items()
        ]
        return _without_unread(found, set(self.module.outputs)), self.names.widths

    def _hidden_words(self) -> set[BitVector]:
        """Words that only tools have a name for."""
        public = {net.bits for net in self.module.nets.values() if not net.hidden}
        return {net.bits for net in self.module.nets.values() if net.hidden} - public

    def _inlined(self, cell: Cell) -> bool:
        """Whether a cell's expression stands where its output is read.

        Only operations of one bit are, and only inside such: there a Verilog expression means the same in any
        context.
        """
        bits = next(iter(cell.outputs.values()), ())
        if len(bits) != 1 or bits not in self.hidden or _operator(cell) is None:
            return False
        readers = self.readers.get(bits[0], [])
        if not all(_operator(reader) and len(reader.outputs["Y"]) == 1 for reader in readers):
            return False
        return self.reads[bits[0]] == len(readers) and (self.reads[bits[0]] == 1 or cell.kind == "$not")

    def _word(self, bits: BitVector) -> str:
        word = self.names.word(bits)
        self.read_nets |= {net for net, _, _ in word if net}
        return render_word(word, self.names.widths)

    def _output(self, port: str, bits: BitVector) -> Statement:
        self.read_nets = set()
        text = self._word(bits)
        return Statement((port,), frozenset(self.read_nets), text)

    def _statement(self, cell: Cell) -> Statement:
        self.read_nets = set()
        if cell.is_instance:
            return self._instance(cell)
        if cell.kind == MEMORY_WRITE:
            return self._memory_write(cell)
        if cell.kind not in _KINDS | {FLIP_FLOP, MEMORY_READ}:
            raise NotImplementedError(f"{self.module.name} has a {cell.kind}, for which there is no Verilog")
        (output,) = cell.outputs.values()
        ((net, _, _),) = self.names.driven(output)
        if cell.kind == FLIP_FLOP:
            return self._flip_flop(cell, net, output)
        if cell.kind == MEMORY_READ:
            return self._memory_read(cell, net)
        text = self._expression(cell)
        return Statement((net,), frozenset(self.read_nets), text)

    def _expression(self, cell: Cell) -> str:
        (output,) = cell.outputs.values()
        if _operator(cell) is not None and len(output) == 1:
            return render(self._tree(cell))
        if cell.kind in _REDUCTIONS:
            return f"{_REDUCTIONS[cell.kind]}{self._word(cell.inputs['A'])}"
        if cell.kind == "$logic_not":
            return f"~|{self._word(cell.inputs['A'])}"
        if cell.kind == "$not":
            return f"~{self._extended(cell, 'A', len(output))}"
        if cell.kind == "$neg":
            return f"-{self._extended(cell, 'A', len(output))}"
        if cell.kind == "$mux":
            select, high, low = (self._word(cell.inputs[pin]) for pin in "SBA")
            return f"{select} ? {high} : {low}"
        if cell.kind in _BITWISE | _ARITHMETIC:
            left, right = (self._extended(cell, pin, len(output)) for pin in "AB")
            return f"{left} {(_BITWISE | _ARITHMETIC)[cell.kind]} {right}"
        width = max(len(cell.inputs["A"]), len(cell.inputs["B"]))
        left, right = (self._extended(cell, pin, width) for pin in "AB")
        if cell.number("A_SIGNED") and cell.number("B_SIGNED"):
            left, right = f"$signed({left})", f"$signed({right})"
        return f"{left} {_COMPARISONS[cell.kind]} {right}"

    def _tree(self, cell: Cell) -> Operation:
        """A one-bit operation with the operations of its operands inside."""
        operator = _operator(cell)
        assert operator is not None
        pins = {"~": "A", "?": "SBA"}.get(operator, "AB")
        operands: list[Operation | str] = []
        for pin in pins:
            bits = cell.inputs[pin]
            inner = self.drivers.get(bits[0])
            if inner is not None and self._inlined(inner):
                operands.append(self._tree(inner))
            else:
                operands.append(self._word(bits))
        return Operation(operator, tuple(operands)).flat()

    def _extended(self, cell: Cell, pin: str, width: int) -> str:
        """An operand at the width of its operator, extended by zeros or by its sign."""
        bits = cell.inputs[pin][:width]
        sign: Bit = bits[-1] if cell.number(f"{pin}_SIGNED") else "0"
        return self._word((*bits, *[sign] * (width - len(bits))))

    def _flip_flop(self, cell: Cell, net: str, output: BitVector) -> Statement:
        text = self._update(net, output, cell.inputs["D"])
        nets = [x for x in self.module.nets.values() if x.bits == output]
        initial = next((x.initial for x in nets if x.initial is not None), None)
        marks = _marks({name: text for x in nets for name, text in x.attributes.items()})
        clock = self._edge(cell)
        return Statement((net,), frozenset(self.read_nets), text, marks=marks, clock=clock, initial=initial)

    def _update(self, net: str, old: BitVector, new: BitVector) -> str:
        """What a flip-flop does at an edge: a multiplexer in front of it alone is an ``if``."""
        mux = self.drivers.get(new[0])
        if mux is None or not self._private(mux, new):
            return f"{net} <= {self._value(new)};"
        condition = self._value(mux.inputs["S"])
        then, otherwise = mux.inputs["B"], mux.inputs["A"]
        if otherwise == old:
            return f"if ({condition}) {self._update(net, old, then)}"
        if then == old:
            return f"if ({_opposite(condition)}) {self._update(net, old, otherwise)}"
        first, second = self._update(net, old, then), self._update(net, old, otherwise)
        if first.startswith("if"):
            # An ``else`` belongs to the nearest ``if``.
            condition, first, second = _opposite(condition), second, first
            first = f"begin {first} end" if first.startswith("if") else first
        return f"if ({condition}) {first} else {second}"

    def _private(self, cell: Cell, bits: BitVector) -> bool:
        """Whether a cell is a multiplexer of these bits, which have no name and one reader."""
        if cell.kind != "$mux" or cell.outputs["Y"] != bits or bits not in self.hidden:
            return False
        return all(self.reads[bit] == 1 for bit in bits)

    def _value(self, bits: BitVector) -> str:
        """A word, or the operation of one bit that stands in its place."""
        inner = self.drivers.get(bits[0])
        return render(self._tree(inner)) if inner is not None and self._inlined(inner) else self._word(bits)

    def _memory_read(self, cell: Cell, net: str) -> Statement:
        if not cell.number("CLK_ENABLE") or set(cell.inputs["SRST"]) | set(cell.inputs["ARST"]) != {"0"}:
            raise self._refused(cell, "that is read without a clock, or whose output is reset")
        if "1" in cell.parameters["TRANSPARENCY_MASK"]:
            raise self._refused(cell, "whose reads see what is written at the same time")
        if not self._ports(cell, MEMORY_WRITE):
            raise self._refused(cell, "that nothing writes")
        memory = self.names.memories[cell.memory]
        text = f"{net} <= {memory}[{self._word(cell.inputs['ADDR'])}];"
        return self._enabled(cell, (net,), text, frozenset({memory}))

    def _memory_write(self, cell: Cell) -> Statement:
        if len(self._ports(cell, MEMORY_WRITE)) > 1 or len(set(cell.inputs["EN"])) > 1:
            raise self._refused(cell, "that is written in several places, or in parts")
        contents = self._ports(cell, MEMORY_CONTENTS)
        if any(set(port.inputs["DATA"]) != {"0"} for port in contents):
            raise self._refused(cell, "that is not empty at first")
        memory = self.names.memories[cell.memory]
        address, data = self._word(cell.inputs["ADDR"]), self._word(cell.inputs["DATA"])
        statement = self._enabled(cell, (memory,), f"{memory}[{address}] <= {data};", frozenset())
        kind = self.module.memories[cell.memory]
        initial = 0 if contents and kind.words <= _MOST_INITIAL else None
        return replace(statement, words=kind.words, initial=initial, marks=_marks(kind.attributes))

    def _ports(self, of: Cell, kind: str) -> list[Cell]:
        """The cells of a kind that belong to the memory of a cell."""
        return [cell for cell in self.module.cells if cell.kind == kind and cell.memory == of.memory]

    def _refused(self, cell: Cell, what: str) -> NotImplementedError:
        return NotImplementedError(
            f"{self.module.name} has a memory {cell.memory} {what}, for which there is no Verilog"
        )

    def _enabled(self, cell: Cell, drives: tuple[str, ...], text: str, reads: frozenset[str]) -> Statement:
        """What a memory's port does at an edge."""
        enable = cell.inputs["EN"][:1]
        text = text if enable == ("1",) else f"if ({self._value(enable)}) {text}"
        clock = self._edge(cell)
        return Statement(drives, reads | self.read_nets, text, clock=clock)

    def _edge(self, cell: Cell) -> str:
        edge = "posedge" if cell.number("CLK_POLARITY") else "negedge"
        return f"{edge} {self._word(cell.inputs['CLK'])}"

    def _instance(self, cell: Cell) -> Statement:
        parameters = ", ".join(
            f".{name}({constant(int(digits, 2), len(digits))})" for name, digits in cell.parameters.items()
        )
        driven: list[str] = []
        pins = [f".{pin}({self._word(bits)})" for pin, bits in cell.inputs.items()]
        for pin, bits in cell.outputs.items():
            word = self.names.driven(bits)
            driven += [net for net, _, _ in word]
            pins.append(f".{pin}({render_word(word, self.names.widths)})")
        marks = _marks(cell.attributes)
        head = f"{marks}{cell.kind}{f' #({parameters})' if parameters else ''} {self.names.instances[cell]}"
        return Statement(tuple(driven), frozenset(self.read_nets), ", ".join(pins), head=head)


def _opposite(condition: str) -> str:
    return f"!{condition}" if condition.isidentifier() else f"!({condition})"


def _marks(attributes: Mapping[str, str]) -> str:
    marks = ", ".join(f'{name} = "{text}"' for name, text in attributes.items())
    return f"(* {marks} *) " if marks else ""


def _operator(cell: Cell) -> str | None:
    """The operator of a bitwise operation on single bits; None of all other cells."""
    operators: Mapping[str, str] = {**_BITWISE, "$not": "~", "$mux": "?"}
    single = all(len(bits) == 1 for bits in cell.inputs.values())
    return operators.get(cell.kind) if single else None


def _without_unread(found: list[Statement], kept: set[str]) -> list[Statement]:
    """The statements whose outputs are read, or are ports, or gather what is unused."""
    drivers = {net: statement for statement in found for net in statement.drives}
    needed: set[int] = set()
    stack = [drivers[net] for net in (*kept, UNUSED) if net in drivers]
    stack += [statement for statement in found if statement.head]
    while stack:
        statement = stack.pop()
        if id(statement) not in needed:
            needed.add(id(statement))
            stack += [drivers[net] for net in statement.reads if net in drivers]
    return [statement for statement in found if id(statement) in needed]
