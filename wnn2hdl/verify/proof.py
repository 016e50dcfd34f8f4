"""The formal proof that emitted Verilog is the model, and that the mapped netlist is the emitted Verilog.

`wnn2hdl.verify.holding` says why comparing circuits that are held in the care set proves a claim.

A network is proved piece by piece (`wnn2hdl.verify.composition` says why that is sound), its sums by
substitution (`wnn2hdl.verify.addition`). Where a piece is not what is claimed of it, the network may still be
the model: it is then compared as a whole.
"""

import time
from collections.abc import Callable, Container, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Literal

import numpy as np

from wnn2hdl.errors import CheckError, ToolError
from wnn2hdl.ir.wires import word_values
from wnn2hdl.verify.addition import is_sum_of_tables, is_wrong_on_samples
from wnn2hdl.verify.composition import Composition, Piece, wrong_wire
from wnn2hdl.verify.equivalence import (
    UNDECIDED,
    Circuit,
    Difference,
    evaluate,
    find_differences,
)
from wnn2hdl.verify.graphs import difference_of_graphs, graph_of, graph_of_model
from wnn2hdl.verify.holding import sides
from wnn2hdl.verify.signals import Signals, read_signals
from wnn2hdl.verify.specification import Claim, Samples, Specification, show, value_bits

METHOD = "ABC &cec on the miter of Yosys's and-inverter graphs"
SUBSTITUTION = "substitution of signals by those they read, on all their values"
SAMPLES = "a vector on which they differ"
GRAPHS = "ABC &cec of the graph of the circuit's tables and the gates of the model"
WIRING = "the claims of its pieces and its wiring, bit by bit"

Status = Literal["proved", "refuted", "undecided"]

MODEL = "the Verilog equals the model, on all inputs that are cared for"
NETLIST = "the mapped netlist equals the Verilog, on all inputs"

Widths = Mapping[str, int]
"""Width of each port by name, in bits."""

_SECONDS = 600.0
"""The last resort, which ends in an error: what is decided must not depend on how fast the machine is."""

_CONFLICTS = 100_000
_NODES = 200_000


@dataclass(frozen=True)
class Counterexample:
    """A cared-for input on which a circuit and the model differ.

    Attributes:
        part: the circuit.
        inputs: values of its input ports.
        expected: the model's outputs.
        actual: the circuit's outputs; of a pipeline, for inputs that stand still.
    """

    part: str
    inputs: Mapping[str, int]
    expected: Mapping[str, int]
    actual: Mapping[str, int]

    def __str__(self) -> str:
        if self.actual == self.expected:
            return f"for {show(self.inputs)}: the outputs depend on registers or inputs of another time"
        answers = ", ".join(
            f"{port} is {self.actual[port]:#x} (the model says {value:#x})"
            for port, value in self.expected.items()
            if self.actual[port] != value
        )
        return f"for {show(self.inputs)}: {answers}"


@dataclass(frozen=True)
class Proof:
    """The outcome of a proof.

    Attributes:
        statement: what was to be proved.
        method: what decided it.
        seconds: wall-clock time of the call that proved it, together with all that it proved beside it.
        status: ``undecided`` where a limit was reached, or where a claim that it rests on is not proved.
        counterexample: of a circuit that is refuted; None of a piece of one.
    """

    statement: str
    method: str
    seconds: float
    status: Status
    counterexample: Counterexample | None = None


def prove(specification: Specification, emitted: Mapping[str, Circuit]) -> dict[str, Proof]:
    """Prove emitted circuits equal to the model, on every cared-for input.

    Args:
        specification: what the model answers, and where it matters.
        emitted: the Verilog of each circuit by its part; all that there are claims about are proved.

    Returns:
        The outcome for each circuit, and for the pieces of one that is proved piece by piece ahead of it.

    Raises:
        CheckError: a circuit has registers or reads undefined values.
        ToolError: a text cannot be read as a circuit with these ports, or a tool is missing or gave up.
    """
    composition = specification.composition
    if composition is not None and composition.part in emitted:
        return _prove_pieces(specification, composition, emitted)
    return _prove_whole(specification, emitted)


def _prove_whole(specification: Specification, emitted: Mapping[str, Circuit]) -> dict[str, Proof]:
    started = time.perf_counter()
    stated = {part: claim for part, claim in specification.claims.items() if part in emitted}
    proofs = {part: _prove_gates(claim, emitted[part]) for part, claim in stated.items() if claim.gates}
    claims = {part: claim for part, claim in stated.items() if part not in proofs}
    pairs = [sides(specification, claim, emitted[part]) for part, claim in claims.items()]
    differences = find_differences(pairs, timeout=_SECONDS) if pairs else []
    seconds = time.perf_counter() - started
    return proofs | {
        part: _proof(MODEL, seconds, values, partial(_against_model, claim, emitted[part]))
        for (part, claim), values in zip(claims.items(), differences, strict=True)
    }


def _prove_gates(claim: Claim, circuit: Circuit) -> Proof:
    """A circuit against a gate network: on samples, which find most faults soonest, then as graphs."""
    started = time.perf_counter()
    assert claim.gates is not None
    (signals,) = read_signals([circuit])
    if signals is None or signals.latencies - {circuit.latency}:
        raise CheckError("the circuit is not a function of its inputs at one time", value=circuit.top)
    found = _on_samples(claim, signals)
    if found is not None:
        return Proof(MODEL, SAMPLES, time.perf_counter() - started, "refuted", found)
    difference = difference_of_graphs(graph_of(signals), graph_of_model(claim.gates))
    counterexample = None
    if isinstance(difference, list):
        (port,) = claim.inputs
        samples = {port: np.array([difference], dtype=np.bool_)}
        counterexample = _differing(claim, signals, samples)
        if counterexample is None:
            raise ToolError("ABC's counterexample is wrong: circuit and model agree on it", value=claim.part)
    seconds = time.perf_counter() - started
    status: Status = "undecided" if difference == UNDECIDED else "refuted" if counterexample else "proved"
    return Proof(MODEL, GRAPHS, seconds, status, counterexample)


def method(specification: Specification) -> str:
    """What decides the claims of a specification."""
    if any(claim.gates for claim in specification.claims.values()):
        return GRAPHS
    if specification.composition is not None:
        return f"binary decision diagrams and {METHOD}, piece by piece; sums by {SUBSTITUTION}"
    return METHOD


def _prove_pieces(
    specification: Specification, composition: Composition, emitted: Mapping[str, Circuit]
) -> dict[str, Proof]:
    """The pieces of a circuit, its wiring, and with that the circuit."""
    started = time.perf_counter()
    pieces = composition.pieces
    statuses = _prove_sums(pieces, emitted)
    pairs = {
        part: (
            piece.framed(emitted[part], composition.reference),
            Circuit((composition.reference,), piece.module),
        )
        for part, piece in pieces.items()
        if part not in statuses and piece.module is not None
    }
    differences = find_differences(list(pairs.values()), timeout=_SECONDS, conflicts=_CONFLICTS, nodes=_NODES)
    statuses |= {part: (METHOD, _status(values)) for part, values in zip(pairs, differences, strict=True)}
    whole = emitted[composition.part]
    fault = wrong_wire(composition, whole, emitted)
    seconds = time.perf_counter() - started
    proofs = {
        part: Proof(piece.statement, statuses[part][0], seconds, statuses[part][1])
        for part, piece in pieces.items()
    }
    found = {proof.status for proof in proofs.values()}
    if fault is not None or "refuted" in found:
        claim = specification.claims[composition.part]
        (signals,) = read_signals([whole])
        counterexample = _on_samples(claim, signals)
        if counterexample is None:
            return proofs | _prove_whole(specification, {composition.part: whole})
        return proofs | {composition.part: Proof(MODEL, SAMPLES, seconds, "refuted", counterexample)}
    status: Status = "undecided" if "undecided" in found else "proved"
    return proofs | {composition.part: Proof(MODEL, WIRING, seconds, status)}


def _prove_sums(pieces: Mapping[str, Piece], emitted: Mapping[str, Circuit]) -> dict[str, tuple[str, Status]]:
    """What decided which pieces that add, and how; without those that are left to be compared."""
    claims = {part: piece.sums for part, piece in pieces.items() if piece.sums is not None}
    found: dict[str, tuple[str, Status]] = {}
    modules = read_signals([emitted[part] for part in claims])
    for (part, sums), signals in zip(claims.items(), modules, strict=True):
        if signals is not None and is_sum_of_tables(signals, sums, emitted[part].latency):
            found[part] = SUBSTITUTION, "proved"
        elif pieces[part].module is None:
            is_wrong = signals is not None and is_wrong_on_samples(signals, sums)
            found[part] = (SAMPLES, "refuted") if is_wrong else (SUBSTITUTION, "undecided")
    return found


def _on_samples(claim: Claim, signals: Signals | None) -> Counterexample | None:
    """A vector of the stimulus of a claim on which a circuit is not the model; None if there is none."""
    if signals is None or claim.stimulus is None:
        return None
    return _differing(claim, signals, claim.stimulus())


def _differing(claim: Claim, signals: Signals, inputs: Samples) -> Counterexample | None:
    """The first of some inputs on which a circuit is not the model."""
    found, expected = signals.answers(inputs), claim.answers(inputs)
    wrong = np.any([(found[port] != bits).any(axis=1) for port, bits in expected.items()], axis=0)
    if not wrong.any():
        return None
    sample = slice(int(wrong.argmax()), int(wrong.argmax()) + 1)
    shown = (
        {port: word_values(bits[sample])[0] for port, bits in values.items()}
        for values in (inputs, expected, found)
    )
    return Counterexample(claim.part, *shown)


def _status(difference: Difference) -> Status:
    if difference is None:
        return "proved"
    return "undecided" if difference == UNDECIDED else "refuted"


def _proof(
    statement: str,
    seconds: float,
    difference: Difference,
    counterexample: Callable[[Mapping[str, int]], Counterexample],
) -> Proof:
    found = counterexample(difference) if isinstance(difference, dict) else None
    return Proof(statement, METHOD, seconds, _status(difference), found)


def prove_netlists(
    netlists: Mapping[str, tuple[Circuit, Circuit]],
    ports: Mapping[str, tuple[Widths, Widths]],
    as_graphs: Container[str] = (),
) -> dict[str, Proof]:
    """Prove mapped netlists equal to the Verilog they were mapped from, on every input.

    Args:
        netlists: for each circuit the emitted Verilog and the netlist of 7-series cells.
        ports: for each circuit the widths of its input and of its output ports, in bits.
        as_graphs: the circuits that are compared as graphs of their tables, which takes a quarter of the time
            (measured on a network of 500 tables) and leaves what is not equal undecided if it is large.

    Returns, raises: as `prove`; what a counterexample expects is the emitted Verilog's answer.
    """
    started = time.perf_counter()
    graphs = {part: _difference_of_graphs(*pair) for part, pair in netlists.items() if part in as_graphs}
    compared = {part: pair for part, pair in netlists.items() if part not in graphs}
    found = find_differences(list(compared.values()), timeout=_SECONDS) if compared else []
    differences = graphs | dict(zip(compared, found, strict=True))
    seconds = time.perf_counter() - started

    def counterexample(part: str, values: Mapping[str, int]) -> Counterexample:
        inputs, outputs = ports[part]
        expected, actual = (evaluate(x, values, inputs, tuple(outputs)) for x in netlists[part])
        return Counterexample(part, values, expected, actual)

    return {
        part: _proof(NETLIST, seconds, differences[part], partial(counterexample, part)) for part in netlists
    }


def _difference_of_graphs(left: Circuit, right: Circuit) -> Difference:
    """Inputs on which a circuit and its netlist differ, compared as graphs of their tables."""
    first, second = read_signals([left, right])
    if first is None or second is None or (first.latencies | second.latencies) - {left.latency}:
        raise CheckError("the netlist is not a function of its inputs at one time", value=right.top)
    if first.ports != second.ports:
        raise ToolError("two circuits to compare have different ports", value=(left.top, right.top))
    found = difference_of_graphs(graph_of(first), graph_of(second))
    if not isinstance(found, list):
        return found
    bits = iter(found)
    return {port: sum(next(bits) << place for place in range(len(x))) for port, x in first.inputs.items()}


def _against_model(claim: Claim, circuit: Circuit, values: Mapping[str, int]) -> Counterexample:
    """The counterexample of the wrapper, as the circuit inside it sees it."""
    samples = claim.hold({port: value_bits(values[port], width) for port, width in claim.inputs.items()})
    held = {port: word_values(bits)[0] for port, bits in samples.items()}
    expected = {port: word_values(bits)[0] for port, bits in claim.answers(samples).items()}
    actual = _answers(claim, circuit, held)
    if actual == expected and not circuit.latency:
        raise ToolError("ABC's counterexample is wrong: circuit and model agree on it", value=held)
    return Counterexample(claim.part, held, expected, actual)


def _answers(claim: Claim, circuit: Circuit, values: Mapping[str, int]) -> dict[str, int]:
    return evaluate(circuit, values, claim.inputs, tuple(claim.outputs))
