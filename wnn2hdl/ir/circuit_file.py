"""Circuits as JSON: each definition once, innermost first, so that instances refer to what is known."""

from collections.abc import Callable, Mapping
from typing import Any

from wnn2hdl.errors import ModelFileError
from wnn2hdl.ir.care import care_from_json
from wnn2hdl.ir.circuit import Care, Circuit, Instance, Node
from wnn2hdl.ir.models.logic import LogicModel
from wnn2hdl.ir.network import LutNetwork
from wnn2hdl.ir.nodes import ArgMax, Function, Match, Register, Sum, Table, Threshold
from wnn2hdl.ir.tables import TruthTable
from wnn2hdl.ir.wires import Port, Slice, word_from_json, word_to_json


def circuit_to_json(circuit: Circuit) -> list[dict[str, Any]]:
    """A JSON array of the circuit's definitions; the circuit itself is the last."""
    return [
        {
            "name": name,
            "summary": definition.summary,
            "inputs": {port.name: port.width for port in definition.inputs},
            "nodes": [_node_to_json(node) for node in definition.nodes],
            "outputs": {port: word_to_json(word) for port, word in definition.drivers.items()},
            "care": [{"word": word_to_json(care.word), **care.allowed.to_json()} for care in definition.care],
            "carries": {
                str(number): bit if isinstance(bit, bool) else str(bit)
                for number, bit in definition.carries.items()
            },
        }
        for name, definition in circuit.definitions().items()
    ]


def circuit_from_json(data: Any) -> Circuit:
    """The inverse of `circuit_to_json`; raises ModelFileError on anything else."""
    known: dict[str, Circuit] = {}
    try:
        for item in data:
            circuit = Circuit(
                str(item["name"]),
                str(item["summary"]),
                tuple(Port(str(name), int(width)) for name, width in item["inputs"].items()),
                tuple(_node_from_json(node, known) for node in item["nodes"]),
                {str(port): word_from_json(word) for port, word in item["outputs"].items()},
                tuple(Care(word_from_json(care["word"]), care_from_json(care)) for care in item["care"]),
                {
                    int(number): bit if isinstance(bit, bool) else Slice.parse(bit)
                    for number, bit in item["carries"].items()
                },
            )
            if known.setdefault(circuit.name, circuit) is not circuit:
                raise ValueError(f"two circuits are called {circuit.name}")
        circuit.definitions()
        _ = circuit.latency
        return circuit
    except (KeyError, TypeError, ValueError, AttributeError, UnboundLocalError, OverflowError) as error:
        raise ModelFileError("not a circuit", value=error, hint="compile the model again") from error


def _node_to_json(node: Node) -> dict[str, Any]:
    data: dict[str, Any] = {"kind": node.kind, "name": node.name}
    match node:
        case Table(word=word, function=function):
            return data | {"word": word_to_json(word), _FORMS[type(function)]: function.to_json()}
        case Threshold(word=word, at_least=at_least):
            return data | {"word": word_to_json(word), "at_least": at_least}
        case Sum(word=word, weights=weights, offset=offset, modulus_bits=bits):
            added = {"weights": list(weights), "offset": offset, "modulus_bits": bits}
            return data | {"word": word_to_json(word)} | added
        case Match(word=word, other=other):
            return data | {"word": word_to_json(word), "other": word_to_json(other)}
        case ArgMax(words=words, tie=tie):
            return data | {"words": [word_to_json(word) for word in words], "tie": tie}
        case Register(word=word, cycles=cycles):
            return data | {"word": word_to_json(word), "cycles": cycles}
        case Instance(circuit=circuit, inputs=inputs):
            connections = {port: word_to_json(word) for port, word in inputs.items()}
            return data | {"circuit": circuit.name, "inputs": connections}


_FORMS: Mapping[type[Function], str] = {TruthTable: "table", LogicModel: "gates", LutNetwork: "network"}


def _table(data: Mapping[str, Any]) -> Table:
    (function,) = (form.from_json(data[key]) for form, key in _FORMS.items() if key in data)
    return Table(data["name"], word_from_json(data["word"]), function)


_READERS: Mapping[str, Callable[[Mapping[str, Any]], Node]] = {
    Table.kind: _table,
    Threshold.kind: lambda x: Threshold(x["name"], word_from_json(x["word"]), int(x["at_least"])),
    Sum.kind: lambda x: Sum(
        x["name"],
        word_from_json(x["word"]),
        tuple(map(int, x["weights"])),
        int(x["offset"]),
        None if x["modulus_bits"] is None else int(x["modulus_bits"]),
    ),
    Match.kind: lambda x: Match(x["name"], word_from_json(x["word"]), word_from_json(x["other"])),
    ArgMax.kind: lambda x: ArgMax(x["name"], tuple(map(word_from_json, x["words"])), x["tie"]),
    Register.kind: lambda x: Register(x["name"], word_from_json(x["word"]), int(x["cycles"])),
}


def _node_from_json(data: Mapping[str, Any], known: Mapping[str, Circuit]) -> Node:
    if not isinstance(data["name"], str):
        raise ValueError(f"{data['name']!r} is not a name of a node")
    if data["kind"] == Instance.kind:
        inputs = {port: word_from_json(word) for port, word in data["inputs"].items()}
        return Instance(data["name"], known[data["circuit"]], inputs)
    return _READERS[data["kind"]](data)
