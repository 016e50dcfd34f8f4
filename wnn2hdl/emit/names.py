"""Which name each bit of a module goes by in the emitted text."""

import re

from wnn2hdl.emit.expression import Piece, pieces
from wnn2hdl.emit.netlist import CELL_OUTPUTS, Bit, BitVector, Cell, Module
from wnn2hdl.ir.identifiers import RESERVED

_NO_LETTER = re.compile(r"\W", re.ASCII)


class Names:
    """The names of a module's bits, and the widths of what is named.

    A word that a cell drives takes the name of a net of the same bits: of an output port, else of a net that
    the component named, else a new one. Bits of input ports to which the component gave a name, as in
    ``R7``, go by that name. Names that Verilog cannot have, or has for something else, are changed.

    Attributes:
        widths: bits of each named net, ports among them.
        instances: the name of each cell that is an instance of a module.
        memories: the name of each memory.
        aliases: for each name of a bit of an input port, that bit's own reference.
    """

    def __init__(self, module: Module) -> None:
        self._module = module
        self._references: dict[Bit, Piece] = {}
        self._outputs: dict[BitVector, str] = {}
        self.widths = {port: len(bits) for port, bits in (*module.inputs.items(), *module.outputs.items())}
        self.aliases: dict[str, Piece] = {}
        self.instances: dict[Cell, str] = {}
        self._instance_names: set[str] = set()
        for cell in module.cells:
            if cell.is_instance:
                self.instances[cell] = self._plain(cell.name)
                self._instance_names.add(self.instances[cell])
        self.memories = {name: self._new(name, memory.width) for name, memory in module.memories.items()}
        self._by_bits: dict[BitVector, str] = {}
        # A name that Amaranth numbered or made of two, as in ``total$7`` or ``port__en``, is used only if
        # there is no other.
        for name in sorted(module.nets, key=lambda name: "$" in name or "__" in name):
            if not module.nets[name].hidden:
                self._by_bits.setdefault(module.nets[name].bits, name)
        for port, bits in module.inputs.items():
            self._references |= {bit: (port, position, 1) for position, bit in enumerate(bits)}
        self._name_input_bits()
        for cell in module.cells:
            for pin, bits in cell.outputs.items():
                self._name_driven(cell, pin, bits)

    def word(self, bits: BitVector) -> list[Piece]:
        """A word that is read, as pieces of named nets; the word of a joined output is that port."""
        if len(bits) > 1 and bits in self._outputs:
            return [(self._outputs[bits], 0, len(bits))]
        return pieces([self._references[bit] if isinstance(bit, int) else _constant(bit) for bit in bits])

    def driven(self, bits: BitVector) -> list[Piece]:
        """A word that a cell drives, as pieces of named nets."""
        return pieces([self._references[bit] for bit in bits])

    def joined_output(self, port: str) -> None:
        """From now on a word of the bits of this output port goes by the name of the port."""
        self._outputs[self._module.outputs[port]] = port

    def _name_input_bits(self) -> None:
        """Use the names that the component gave to single bits of wider ports, the highest bit first."""
        named: list[tuple[Piece, str, Bit]] = []
        for name, net in self._module.nets.items():
            if len(net.bits) == 1 and not net.hidden and name not in self.widths:
                piece = self._references.get(net.bits[0])
                if piece is not None and self.widths[piece[0]] > 1:
                    named.append((piece, name, net.bits[0]))
        for piece, name, bit in sorted(named, key=lambda item: (item[0][0], -item[0][1], item[1])):
            plain = self._new(name, 1)
            self.aliases[plain] = piece
            self._references[bit] = (plain, 0, 1)

    def _name_driven(self, cell: Cell, pin: str, bits: BitVector) -> None:
        public = self._by_bits.get(bits)
        port = next((name for name, word in self._module.outputs.items() if word == bits), None)
        if port is not None:
            name = port
        elif cell.is_instance and not _is_vendor_cell(cell):
            name = self._new(f"{cell.name}_{pin}", len(bits))
        else:
            name = self._new(public or f"term_{cell.name.strip('$')}", len(bits))
        self._references |= {bit: (name, position, 1) for position, bit in enumerate(bits)}

    def _new(self, wanted: str, width: int) -> str:
        """A name for a net of this many bits."""
        plain = self._plain(wanted)
        self.widths[plain] = width
        return plain

    def _plain(self, wanted: str) -> str:
        """An identifier like ``wanted`` that nothing else in the module has."""
        base = plain = _NO_LETTER.sub("_", wanted)
        if not base[0].isalpha():
            base = plain = f"n{base}"
        number = 0
        while plain in self.widths or plain in self._instance_names or plain.lower() in RESERVED:
            number += 1
            plain = f"{base}_{number}"
        return plain


def _is_vendor_cell(cell: Cell) -> bool:
    return set(cell.outputs) <= CELL_OUTPUTS


def _constant(bit: str) -> Piece:
    if bit not in ("0", "1"):
        raise NotImplementedError("an undefined bit (x) cannot be emitted")
    return ("", int(bit), 1)
