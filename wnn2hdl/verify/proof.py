"""The formal proof that emitted Verilog is the model, and that the mapped netlist is the emitted Verilog.

Why the proof is sound. Both sides of a comparison stand in the same wrapper, whose pixels pass through
``care_pixel``: a function *h* with *h(p) = p* on each cared-for pixel, and whose every value is a cared-for
pixel. Circuit and reference agree on *h(p)* for all *p* exactly if they agree on all cared-for pixels. So
"for all inputs of the wrapper" is "for all cared-for inputs of the circuit", and nothing weaker. Inside the
wrapper the nine pixel circuits equal their references on every input, which lets the checker merge them one
by one; with the care set as a side condition of the miter they would not, and nothing could be merged. Where
every code is cared for, *h* is the identity.

The edge bit of a side is masked by ``care_window`` of that side's own bits. If the proof succeeds, the bits
of both sides are equal, hence so are the masks, and the edge bits are equal wherever the window is cared for.

A neighbourhood's window is not held: the class bits of both sides are masked by ``care_neighbourhood`` of it.
The mask is one function of the inputs on both sides, so masked outputs are equal for all windows exactly if
the outputs are equal for the cared-for ones.

The care set is not empty (`Specification` refuses that), so no claim holds vacuously.
"""

import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import ToolError
from wnn2hdl.verify.equivalence import Circuit, evaluate, find_differences
from wnn2hdl.verify.reference import care_verilog, reference_name, reference_verilog
from wnn2hdl.verify.specification import (
    AnySpecification,
    NeighbourhoodSpecification,
    PartName,
    Samples,
    Specification,
    pixels_to_word,
    word_to_pixels,
)

METHOD = "ABC &cec on the miter of Yosys's and-inverter graphs"

_SECONDS = 600.0


@dataclass(frozen=True)
class Counterexample:
    """A cared-for input on which a circuit and the model differ.

    Attributes:
        part: the circuit.
        inputs: values of its input ports; pixels as in `Specification.evaluate`, for one sample.
        expected: the model's outputs.
        actual: the circuit's outputs.
    """

    part: PartName
    inputs: Samples
    expected: dict[str, int]
    actual: dict[str, int]

    def __str__(self) -> str:
        given = ", ".join(f"{port} {_show(value)}" for port, value in self.inputs.items())
        answers = ", ".join(
            f"{port} is {self.actual[port]:#b} (the model says {value:#b})"
            for port, value in self.expected.items()
            if self.actual[port] != value
        )
        return f"for {given}: {answers}"


@dataclass(frozen=True)
class Proof:
    """The outcome of a proof.

    Attributes:
        method: what decided it.
        seconds: wall-clock time of the call that proved it, together with all that it proved beside it.
        counterexample: None if the circuit is proved.
    """

    method: str
    seconds: float
    counterexample: Counterexample | None

    @property
    def status(self) -> str:
        """``proved`` or ``refuted``."""
        return "refuted" if self.counterexample else "proved"


def prove(specification: AnySpecification, verilog: Mapping[PartName, Path]) -> dict[PartName, Proof]:
    """Prove emitted circuits equal to the model, on every cared-for input.

    Args:
        specification: the model and its care set.
        verilog: for each circuit the file that was written; it is read back from there.

    Returns:
        The outcome for each circuit.

    Raises:
        CheckError: a circuit has registers or reads undefined values.
        ToolError: a file cannot be read as a circuit with these ports, or a tool is missing or gave up.
    """
    started = time.perf_counter()
    reference = reference_verilog(specification)
    emitted = {part: path.read_text(encoding="utf-8") for part, path in verilog.items()}
    differences = find_differences(
        [
            (
                held_in_care(specification, part, text, specification.part(part).module),
                held_in_care(specification, part, reference, reference_name(part)),
            )
            for part, text in emitted.items()
        ],
        timeout=_SECONDS,
    )
    counterexamples = {
        part: None if values is None else _against_model(specification, part, emitted[part], values)
        for part, values in zip(emitted, differences, strict=True)
    }
    seconds = time.perf_counter() - started
    return {part: Proof(METHOD, seconds, found) for part, found in counterexamples.items()}


def prove_netlists(
    specification: AnySpecification, netlists: Mapping[PartName, tuple[Path, Path]]
) -> dict[PartName, Proof]:
    """Prove mapped netlists equal to the Verilog they were mapped from, on every input.

    Args:
        specification: the model, for the ports.
        netlists: for each circuit the emitted Verilog and the netlist of 7-series cells.

    Returns, raises: as `prove`; what a counterexample expects is the emitted Verilog's answer.
    """
    started = time.perf_counter()
    pairs = {
        part: tuple(
            Circuit((path.read_text(encoding="utf-8"),), specification.part(part).module) for path in paths
        )
        for part, paths in netlists.items()
    }
    differences = find_differences([(left, right) for left, right in pairs.values()], timeout=_SECONDS)
    counterexamples: dict[PartName, Counterexample | None] = {}
    for (part, (source, netlist)), values in zip(pairs.items(), differences, strict=True):
        if values is None:
            counterexamples[part] = None
        else:
            counterexamples[part] = Counterexample(
                part,
                _samples(specification, part, values),
                _answers(specification, part, source, values),
                _answers(specification, part, netlist, values),
            )
    seconds = time.perf_counter() - started
    return {part: Proof(METHOD, seconds, found) for part, found in counterexamples.items()}


def held_in_care(specification: AnySpecification, part: PartName, source: str, module: str) -> Circuit:
    """A circuit in the wrapper that holds its inputs inside the care set (see the top of this file)."""
    ports = specification.part(part)
    header = [f"input [{width - 1}:0] {port}" for port, width in ports.inputs.items()]
    header += [f"output [{width - 1}:0] {port}" for port, width in ports.outputs.items()]
    nets = {port: port for port in (*ports.inputs, *ports.outputs)}
    lines = [f"module held({', '.join(header)});"]
    if isinstance(specification, NeighbourhoodSpecification):
        nets["class_bits"] = "any_class_bits"
        width = specification.class_width
        lines += [
            f"  wire [{width - 1}:0] any_class_bits;",
            "  wire cared;",
            "  care_neighbourhood care (.window(window), .cared(cared));",
            f"  assign class_bits = any_class_bits & {{{width}{{cared}}}};",
        ]
        return _wrapped(specification, lines, module, nets, source)
    for port, width in ports.inputs.items():
        if port in ("rgb", "window"):
            nets[port] = "held_pixels"
            lines.append(f"  wire [{width - 1}:0] held_pixels;")
            for low in range(0, width, 24):
                bits = f"[{low + 23}:{low}]"
                lines.append(f"  care_pixel care_{low} (.free({port}{bits}), .rgb(held_pixels{bits}));")
    if "edge_bit" in ports.outputs:
        nets["edge_bit"] = "any_edge_bit"
        lines += [
            "  wire any_edge_bit, cared;",
            "  care_window care_window (.bits(bits), .cared(cared));",
            "  assign edge_bit = any_edge_bit & cared;",
        ]
    return _wrapped(specification, lines, module, nets, source)


def _wrapped(
    specification: AnySpecification, lines: list[str], module: str, nets: dict[str, str], source: str
) -> Circuit:
    connections = ", ".join(f".{port}({net})" for port, net in nets.items())
    wrapper = "\n".join([*lines, f"  {module} circuit ({connections});", "endmodule", ""])
    return Circuit((wrapper, care_verilog(specification), source), "held")


def _against_model(
    specification: AnySpecification, part: PartName, source: str, values: dict[str, int]
) -> Counterexample:
    """The counterexample of the wrapper, as the circuit inside it sees it."""
    held = dict(values)
    if isinstance(specification, Specification):
        for port in {"rgb", "window"} & held.keys():
            pixels = word_to_pixels(held[port], specification.part(part).inputs[port] // 24)
            held[port] = pixels_to_word(specification.nearest_cared(pixels))
    samples = _samples(specification, part, held)
    expected = {port: int(column[0]) for port, column in specification.evaluate(part, samples).items()}
    actual = _answers(specification, part, Circuit((source,), specification.part(part).module), held)
    if actual == expected:
        raise ToolError("ABC's counterexample is none: circuit and model agree on it", value=held)
    return Counterexample(part, samples, expected, actual)


def _answers(
    specification: AnySpecification, part: PartName, circuit: Circuit, values: dict[str, int]
) -> dict[str, int]:
    ports = specification.part(part)
    return evaluate(circuit, values, ports.inputs, tuple(ports.outputs))


def _samples(specification: AnySpecification, part: PartName, values: dict[str, int]) -> Samples:
    """Port values as arrays of one sample."""
    samples: Samples = {}
    for port, width in specification.part(part).inputs.items():
        if port == "rgb":
            samples[port] = word_to_pixels(values[port], 1)
        elif port == "window":
            samples[port] = word_to_pixels(values[port], width // 24)[np.newaxis]
        else:
            samples[port] = np.array([values[port]])
    return samples


def _show(value: NDArray[Any]) -> str:
    if value.ndim == 1:
        return f"{int(value[0]):#b}"
    pixels = value.reshape(-1, 3).tolist()
    return " ".join(f"({red},{green},{blue})" for red, green, blue in pixels)
