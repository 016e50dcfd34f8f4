"""Modules as Yosys's JSON netlist describes them: ports, nets and cells over numbered bits.

Amaranth writes RTLIL; Yosys turns its processes into flip-flops and multiplexers (``proc``) and writes the
structure as JSON. Nothing is optimised on the way, so the netlist is what the components describe.
"""

import itertools
import json
import tempfile
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from wnn2hdl.errors import ToolError
from wnn2hdl.tools import find_yosys

Bit = int | str
"""A bit of a module: its number, or ``0``, ``1`` or ``x``."""

BitVector = tuple[Bit, ...]
"""Bits side by side, the least significant first."""

_SECONDS = 120.0
CELL_OUTPUTS = frozenset({"O", "O5", "O6"})
"""Output pins of the vendor's look-up tables and multiplexers (UG953), whose modules are not read."""


FLIP_FLOP = "$dff"
MEMORY_READ, MEMORY_WRITE, MEMORY_CONTENTS = "$memrd_v2", "$memwr_v2", "$meminit_v2"
"""Kinds of cells: a register, the ports of a memory, and what is in it at first."""


_TRIMMED = frozenset({"$add", "$sub", "$mul"})


@dataclass(frozen=True)
class Net:
    """A named net.

    Attributes:
        bits: its bits.
        hidden: whether its name was made up by a tool.
        initial: its value before the first clock edge, for a net that a flip-flop drives; None if undefined.
        attributes: all others, as text.
    """

    bits: BitVector
    hidden: bool
    initial: int | None
    attributes: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Cell:
    """An operator, a flip-flop, or an instance of another module.

    Attributes:
        name: of the instance.
        kind: an operator such as ``$and``, or the name of the other module.
        parameters: as Yosys writes them: numbers as binary digits, the most significant first.
        attributes: in the same form; text is kept as it is.
        inputs: the bits on each input pin.
        outputs: the bits on each output pin.
    """

    name: str
    kind: str
    parameters: Mapping[str, str]
    attributes: Mapping[str, str]
    inputs: Mapping[str, BitVector]
    outputs: Mapping[str, BitVector]

    @property
    def is_instance(self) -> bool:
        """Whether it is an instance of another module, or of a vendor's cell."""
        return not self.kind.startswith("$")

    def number(self, parameter: str) -> int:
        """The value of a numeric parameter."""
        return int(self.parameters[parameter], 2)

    @property
    def memory(self) -> str:
        """The memory that it is a port of."""
        return self.parameters["MEMID"].removeprefix("\\")


@dataclass(frozen=True)
class Memory:
    """A memory: bits of a word, how many words, and attributes. Its ports are cells, see `MEMORY_READ`."""

    width: int
    words: int
    attributes: Mapping[str, str]


@dataclass(frozen=True)
class Module:
    """A module: the bits of its ports in the order of declaration, its nets, its cells, its memories."""

    name: str
    inputs: Mapping[str, BitVector]
    outputs: Mapping[str, BitVector]
    nets: Mapping[str, Net]
    cells: tuple[Cell, ...]
    memories: Mapping[str, Memory] = field(default_factory=dict)


def read_modules(rtlil: Sequence[str], ports: Mapping[str, Sequence[str]]) -> dict[str, Module]:
    """The modules in texts of RTLIL, by name.

    Args:
        rtlil: one module each.
        ports: for each module the names of its ports in the order wanted; those that it does not name, such
            as a clock, come before.

    Raises:
        ToolError: Yosys is missing, or cannot read a text.
    """
    with tempfile.TemporaryDirectory(prefix="wnn2hdl-") as name:
        folder = Path(name)
        (folder / "design.il").write_text("\n".join(rtlil), encoding="utf-8")
        log = find_yosys().run(
            "read_rtlil design.il\nproc\nwrite_json design.json", timeout=_SECONDS, cwd=folder
        )
        try:
            found = json.loads((folder / "design.json").read_text(encoding="utf-8"))["modules"]
        except (OSError, ValueError, LookupError) as error:
            raise ToolError("Yosys wrote no netlist that can be read", value=error, output=log) from error
    for name, data in found.items():
        wanted = {port: place for place, port in enumerate(ports.get(name, ()))}
        ordered = sorted(data["ports"].items(), key=lambda item: wanted.get(item[0], -1))
        data["ports"] = dict(ordered)
    return {name: _module(name, data, found) for name, data in found.items()}


def count_reads(module: Module) -> Counter[Bit]:
    """How often each bit is read by cells and output ports."""
    words: Iterable[BitVector] = (
        *(bits for cell in module.cells for bits in cell.inputs.values()),
        *module.outputs.values(),
    )
    return Counter(bit for bits in words for bit in bits)


def trimmed(module: Module) -> Module:
    """The module with adders and so on no wider than what is read of them, as of the next value of a counter.

    The low bits of what they compute are those of narrower ones.
    """
    reads = count_reads(module)
    cells = []
    for cell in module.cells:
        if cell.kind in _TRIMMED:
            bits = cell.outputs["Y"]
            wanted = max((place + 1 for place, bit in enumerate(bits) if reads[bit]), default=len(bits))
            reads.subtract(bit for word in cell.inputs.values() for bit in word[wanted:])
            inputs = {pin: word[:wanted] for pin, word in cell.inputs.items()}
            cell = replace(cell, inputs=inputs, outputs={"Y": bits[:wanted]})
        cells.append(cell)
    return replace(module, cells=tuple(cells))


def _module(name: str, data: Mapping[str, Any], modules: Mapping[str, Any]) -> Module:
    ports: dict[str, dict[str, BitVector]] = {"input": {}, "output": {}}
    for port, details in data["ports"].items():
        ports[details["direction"]][port] = tuple(details["bits"])
    nets = {
        net: Net(
            tuple(details["bits"]),
            bool(details["hide_name"]),
            _initial(details["attributes"].get("init")),
            {name: text for name, text in details["attributes"].items() if name != "init"},
        )
        for net, details in data["netnames"].items()
    }
    cells = [_cell(cell, details, modules) for cell, details in data["cells"].items()]
    cells.sort(key=lambda cell: _natural(cell.name))
    memories = {
        memory: Memory(details["width"], details["size"], details["attributes"])
        for memory, details in data.get("memories", {}).items()
    }
    return Module(name, ports["input"], ports["output"], nets, tuple(cells), memories)


def _cell(name: str, data: Mapping[str, Any], modules: Mapping[str, Any]) -> Cell:
    kind = data["type"]
    pins = {pin: tuple(bits) for pin, bits in data["connections"].items()}
    if kind in modules:
        ports = modules[kind]["ports"]
        outputs = {pin for pin, port in ports.items() if port["direction"] == "output"}
        # In the order of declaration.
        pins = {pin: pins[pin] for pin in ports if pin in pins}
    elif "port_directions" in data:
        outputs = {pin for pin, direction in data["port_directions"].items() if direction == "output"}
    else:
        outputs = set(CELL_OUTPUTS)
    return Cell(
        name,
        kind,
        data["parameters"],
        data["attributes"],
        {pin: bits for pin, bits in pins.items() if pin not in outputs},
        {pin: bits for pin, bits in pins.items() if pin in outputs},
    )


def _natural(name: str) -> list[tuple[bool, int, str]]:
    """A key that sorts ``t2`` before ``t10``; numbers that Amaranth gives follow the order of its code."""
    groups = ("".join(group) for _, group in itertools.groupby(name, str.isdigit))
    return [(text.isdigit(), int(text) if text.isdigit() else 0, text) for text in groups]


def _initial(text: str | None) -> int | None:
    return int(text, 2) if text and set(text) <= {"0", "1"} else None
