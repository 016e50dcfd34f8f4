"""And-inverter graphs in AIGER, ASCII (``.aag``) and binary (``.aig``)."""

import re

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.importers.base import Importer, ImportOptions, Source, damage_reported
from wnn2hdl.importers.gates import in_order
from wnn2hdl.ir.models import LogicModel

HEADER = re.compile(rb"(aag|aig)((?: \d{1,9}){5,9})[ \t\r]*\n")

MAX_VARIABLES = 10_000_000

MAX_NAMES = 1_000_000

SYMBOL = re.compile(r"([ilobcjf])(\d{1,9}) (.+)")


def recognises(source: Source) -> bool:
    """Whether the file starts as AIGER does."""
    return source.content.startswith((b"aag ", b"aig "))


def read(source: Source, _: ImportOptions) -> LogicModel:
    """The network in an AIGER file; what its symbol table does not name is ``i0``, ``i1`` …, ``o0`` …."""
    content = source.content
    with damage_reported(source, "an AIGER file"):
        header = HEADER.match(content)
        if header is None:
            raise ValueError("the first line is not a header")
        variables, inputs, latches, outputs, ands, *properties = map(int, header[2].split())
        if latches or any(properties):
            raise InputError(
                "the network has latches or properties; only combinational ones can be imported",
                value=f"{source.path} ({latches} latches, {sum(properties)} properties)",
            )
        if not 0 < inputs <= MAX_NAMES or not 0 < outputs <= MAX_NAMES:
            raise ValueError(f"it has {inputs} inputs and {outputs} outputs")
        if variables > MAX_VARIABLES or variables < inputs + ands or len(content) < header.end() + 2 * ands:
            raise ValueError(f"the header says {variables} variables, {inputs} inputs and {ands} gates")
        body = _ascii if header[1] == b"aag" else _binary
        gates, literals, end = body(content, header.end(), (variables, inputs, outputs, ands))
        names = _symbols(content[end:].decode("utf-8"), {"i": inputs, "o": outputs})
        return LogicModel(
            inputs=names["i"],
            outputs=names["o"],
            gates=gates,
            literals=literals,
            origin=source.origin("AIGER"),
        )


Sizes = tuple[int, int, int, int]
"""Variables, inputs, outputs and gates, as the header says."""

Body = tuple[NDArray[np.uint32], NDArray[np.uint32], int]
"""Gates and output literals as of `LogicModel`, and where the symbol table starts."""


def _lines(content: bytes, at: int, count: int) -> tuple[list[bytes], int]:
    """``count`` lines from a place, and where the next one starts."""
    lines = []
    for _ in range(count):
        end = content.find(b"\n", at)
        if end < 0:
            raise ValueError("the file ends too early")
        lines.append(content[at:end])
        at = end + 1
    return lines, at


def _numbers(lines: list[bytes], columns: int) -> NDArray[np.int64]:
    """Lines of ``columns`` numbers each: int64 ``[lines, columns]``."""
    words = b" ".join(lines).split()
    if len(words) != columns * len(lines) or not all(word.isdigit() and len(word) < 10 for word in words):
        raise ValueError(f"there are lines that do not hold {columns} numbers")
    return np.array(words, dtype=np.int64).reshape(-1, columns)


def _binary(content: bytes, at: int, sizes: Sizes) -> Body:
    variables, inputs, outputs, ands = sizes
    if variables != inputs + ands:
        raise ValueError(f"there are {variables} variables for {inputs} inputs and {ands} gates")
    lines, at = _lines(content, at, outputs)
    deltas, end = _deltas(content, at, 2 * ands)
    own = 2 * (inputs + 1 + np.arange(ands, dtype=np.int64))
    left = own - deltas[0::2]
    right = left - deltas[1::2]
    if ands and (left.max(initial=0) >= own.max() or right.min() < 0 or (deltas[0::2] < 1).any()):
        raise ValueError("a gate reads itself, a gate after it, or nothing")
    gates = np.stack([left, right], axis=1).astype(np.uint32)
    return gates, _checked(_numbers(lines, 1)[:, 0], variables), end


def _deltas(content: bytes, at: int, count: int) -> tuple[NDArray[np.int64], int]:
    """``count`` numbers of seven bits per byte, the lowest first; the last byte of each has no high bit."""
    raw = np.frombuffer(content, dtype=np.uint8, offset=at)[: 5 * count]
    ends = np.flatnonzero(raw < 0x80)[:count]
    if len(ends) < count:
        raise ValueError("the gates end too early")
    if not count:
        return np.empty(0, dtype=np.int64), at
    starts = np.concatenate([[0], ends[:-1] + 1])
    if (ends - starts).max() > 4:
        raise ValueError("a gate's number is too long")
    used = raw[: ends[-1] + 1].astype(np.int64) & 0x7F
    position = np.arange(len(used)) - np.repeat(starts, ends - starts + 1)
    return np.add.reduceat(used << 7 * position, starts), at + int(ends[-1]) + 1


def _ascii(content: bytes, at: int, sizes: Sizes) -> Body:
    variables, inputs, outputs, ands = sizes
    lines, at = _lines(content, at, inputs)
    own_inputs = _numbers(lines, 1)[:, 0]
    lines, at = _lines(content, at, outputs)
    literals = _checked(_numbers(lines, 1)[:, 0], variables)
    lines, end = _lines(content, at, ands)
    gates = _numbers(lines, 3) if ands else np.empty((0, 3), dtype=np.int64)
    defined = np.concatenate([own_inputs, gates[:, 0]])
    if (defined & 1).any() or defined.min() < 2 or defined.max() >> 1 > variables:
        raise ValueError("an input or a gate has a literal that is not a variable")
    if len(np.unique(defined)) != len(defined):
        raise ValueError("a variable is defined twice")
    _checked(gates[:, 1:].ravel(), variables)
    ordered, renamed = _in_order(own_inputs >> 1, gates[:, 0] >> 1, gates[:, 1:], variables)
    return ordered, _renamed(literals.astype(np.int64), renamed), end


def _in_order(
    inputs: NDArray[np.int64], owners: NDArray[np.int64], reads: NDArray[np.int64], variables: int
) -> tuple[NDArray[np.uint32], NDArray[np.int64]]:
    """Gates as of `LogicModel`, and the new number of each old variable, -1 for one that is not defined."""
    gate_of = np.full(variables + 1, -1, dtype=np.int64)
    gate_of[owners] = np.arange(len(owners))
    others = gate_of[reads >> 1]
    order = np.arange(len(owners))
    if (others >= order[:, np.newaxis]).any():  # few files have their gates in another order
        order = np.array(in_order([[gate for gate in pair if gate >= 0] for pair in others.tolist()]))
    renamed = np.full(variables + 1, -1, dtype=np.int64)
    renamed[0] = 0
    renamed[inputs] = 1 + np.arange(len(inputs))
    renamed[owners[order]] = 1 + len(inputs) + np.arange(len(owners))
    return _renamed(reads[order], renamed), renamed


def _renamed(literals: NDArray[np.int64], renamed: NDArray[np.int64]) -> NDArray[np.uint32]:
    found = renamed[literals >> 1]
    if (found < 0).any():
        raise ValueError("a literal is of a variable that nothing defines")
    return np.asarray((2 * found + (literals & 1)).astype(np.uint32))


def _checked(literals: NDArray[np.int64], variables: int) -> NDArray[np.uint32]:
    if literals.max(initial=0) > 2 * variables + 1:
        raise ValueError(f"literal {literals.max()} is of a variable that does not exist")
    return literals.astype(np.uint32)


def _symbols(text: str, counts: dict[str, int]) -> dict[str, tuple[str, ...]]:
    """Names of inputs (``i``) and outputs (``o``), from the symbol table."""
    names = {kind: [f"{kind}{index}" for index in range(count)] for kind, count in counts.items()}
    for line in text.splitlines():
        if line == "c":
            break
        symbol = SYMBOL.fullmatch(line)
        if symbol is None or int(symbol[2]) >= counts.get(symbol[1], 0):
            raise ValueError(f"{line[:40]!r} names nothing that exists")
        names[symbol[1]][int(symbol[2])] = symbol[3]
    return {kind: tuple(each) for kind, each in names.items()}


IMPORTER = Importer("aiger", "an and-inverter graph (AIGER)", recognises, read)
