"""Combinational networks in BLIF, the Berkeley Logic Interchange Format."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from wnn2hdl.errors import InputError
from wnn2hdl.importers.base import Importer, ImportOptions, Source, damage_reported
from wnn2hdl.importers.gates import GateBuilder, in_order
from wnn2hdl.ir.models import LogicModel

NEEDLESS = frozenset(
    {
        *(
            ".default_input_arrival",
            ".default_output_required",
            ".default_input_drive",
            ".default_output_load",
        ),
        *(".input_arrival", ".output_required", ".input_drive", ".output_load", ".area", ".delay"),
        *(".wire", ".wire_load_slope", ".default_max_input_load", ".max_input_load"),
    }
)
"""Directives about delay and load, which decide no answer."""

REFUSED = {
    ".latch": "it has latches; only combinational networks can be imported",
    ".clock": "it has a clock; only combinational networks can be imported",
    ".subckt": "it uses other models; flatten it first",
    ".search": "it uses other files; flatten it first",
    ".gate": "it uses cells of a library; write it with .names only",
    ".mlatch": "it has latches; only combinational networks can be imported",
    ".exdc": "it states don't-cares, which a model does not have",
}


@dataclass(slots=True)
class _Node:
    """A ``.names``: the signals that it reads, and the lines of its cover."""

    inputs: list[str]
    rows: list[tuple[str, str]] = field(default_factory=list)


@dataclass
class _Network:
    inputs: list[str] = field(default_factory=list)
    outputs: list[str] = field(default_factory=list)
    nodes: dict[str, _Node] = field(default_factory=dict)


def recognises(source: Source) -> bool:
    """Whether the first directive of the file is one of BLIF's."""
    for line in source.content[:65536].splitlines():
        words = line.split(b"#")[0].split()
        if words:
            return words[0] in (b".model", b".inputs", b".outputs", b".names", b".latch")
    return False


def read(source: Source, _: ImportOptions) -> LogicModel:
    """The network in a BLIF file of one model; its inputs and outputs keep their names."""
    with damage_reported(source, "a BLIF file"):
        network = _parse(source, source.content.decode("utf-8"))
        signals = {name: 2 * (1 + index) for index, name in enumerate(network.inputs)}
        if len(signals) != len(network.inputs) or signals.keys() & network.nodes:
            raise ValueError("an input is defined twice")
        builder = GateBuilder(len(signals))
        names = list(network.nodes)
        index = {name: at for at, name in enumerate(names)}
        for node in network.nodes.values():
            for name in node.inputs:
                if name not in index and name not in signals:
                    raise ValueError(f"nothing defines {name[:40]}")
        reads = [[index[i] for i in network.nodes[name].inputs if i in index] for name in names]
        for at in in_order(reads):
            signals[names[at]] = _literal(builder, network.nodes[names[at]], signals)
        missing = [name for name in network.outputs if name not in signals]
        if missing:
            raise ValueError(f"nothing defines {missing[0][:40]}")
        return LogicModel(
            inputs=tuple(network.inputs),
            outputs=tuple(network.outputs),
            gates=builder.array(),
            literals=np.array([signals[name] for name in network.outputs], dtype=np.uint32),
            origin=source.origin("BLIF"),
        )


def _lines(text: str) -> Iterator[list[str]]:
    """Words of each line that has any, without comments, continued lines joined."""
    held: list[str] = []
    for line in text.splitlines():
        bare = line.split("#", 1)[0].rstrip()
        if bare.endswith("\\"):
            held += bare[:-1].split()
            continue
        words = held + bare.split()
        held = []
        if words:
            yield words
    if held:
        raise ValueError("the last line is continued by nothing")


def _parse(source: Source, text: str) -> _Network:
    network = _Network()
    node: _Node | None = None
    models = 0
    for words in _lines(text):
        directive = words[0]
        if not directive.startswith("."):
            if node is None:
                raise ValueError(f"{directive[:40]!r} is neither a directive nor a line of a cover")
            node.rows.append(_row(tuple(words), len(node.inputs)))
            continue
        node = None
        if directive in REFUSED:
            raise InputError("the network cannot be imported", value=source.path, hint=REFUSED[directive])
        if directive == ".end":
            break
        if directive == ".model":
            models += 1
        elif directive == ".inputs":
            network.inputs += words[1:]
        elif directive == ".outputs":
            network.outputs += words[1:]
        elif directive == ".names":
            node = _Node(words[1:-1])
            if len(words) < 2 or words[-1] in network.nodes:
                raise ValueError(f"{words[-1][:40]} is defined twice, or has no name")
            network.nodes[words[-1]] = node
        elif directive not in NEEDLESS:
            raise ValueError(f"there is no directive {directive[:40]}")
    if models > 1:
        raise ValueError("it holds several models; flatten it first")
    return network


@lru_cache(maxsize=1024)
def _row(words: tuple[str, ...], inputs: int) -> tuple[str, str]:
    """A line of a cover: what each input must be, and the answer."""
    cube, answer = (words[0], words[1]) if len(words) == 2 else ("", words[0])
    if len(words) > 2 or len(cube) != inputs or cube.strip("01-") or answer not in ("0", "1"):
        raise ValueError(f"{' '.join(words)[:40]!r} is not a line of a cover of {inputs} inputs")
    return cube, answer


def _literal(builder: GateBuilder, node: _Node, signals: dict[str, int]) -> int:
    """The literal of a node whose inputs have theirs: its cover lists where it is 1, or where it is 0."""
    answers = {answer for _, answer in node.rows}
    if len(answers) > 1:
        raise ValueError("a cover lists both where it is 1 and where it is 0")
    inputs = [signals[name] for name in node.inputs]
    cubes = [
        builder.every([inputs[place] ^ inverted for place, inverted in _literals(cube)])
        for cube, _ in node.rows
    ]
    return builder.any(cubes) ^ (answers == {"0"})


@lru_cache(maxsize=1024)
def _literals(cube: str) -> list[tuple[int, int]]:
    """Which inputs a line of a cover reads, and whether inverted."""
    return [(place, int(wanted == "0")) for place, wanted in enumerate(cube) if wanted != "-"]


IMPORTER = Importer("blif", "a network in BLIF", recognises, read)
