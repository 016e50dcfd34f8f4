"""What the circuits of a design have to compute, stated by the model alone.

Nothing here knows how a circuit was lowered, minimised or elaborated: a `Claim` names a circuit and its
ports, and says in NumPy and in Verilog what the model answers there.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.ir.care import CareSet
from wnn2hdl.ir.models import LogicModel
from wnn2hdl.ir.wires import Bits
from wnn2hdl.verify.composition import Composition

Samples = Mapping[str, Bits]
"""Values of ports by name, bool ``[samples, width]`` each."""


@dataclass(frozen=True)
class Mask:
    """An output that matters only where a module of the care set says so.

    Attributes:
        module: has the output ``cared`` and one input.
        port: the name of that input, and of the port of the circuit that it reads.
    """

    module: str
    port: str


def everything(inputs: Samples) -> NDArray[np.bool_]:
    """All samples are cared for: bool ``[samples, 1]``."""
    return np.ones((len(next(iter(inputs.values()))), 1), dtype=np.bool_)


@dataclass(frozen=True, eq=False)
class Claim:
    """One circuit is equal to the model on all inputs that are cared for.

    Attributes:
        part: the name of the circuit.
        inputs: width of each input port.
        outputs: width of each output port.
        module: the module of the reference.
        answers: the model's outputs for any inputs.
        stimulus: inputs on which the circuit is simulated, all of them cared for; None where all its outputs
            are compared in a circuit that it is part of.
        cared: which pixels of the inputs are cared for, bool ``[samples, pixels]``; of a circuit that reads
            one code, one column.
        hold: moves inputs into the care set; those inside stay as they are.
        held: input ports whose pixels pass the module ``care_pixel`` in a proof.
        masks: outputs that matter on a part of the cared-for inputs only, and by which module a proof knows
            it.
        matters: for these outputs, from the model's answers, on which samples they do: bool ``[samples]``.
        gates: of a gate network, the model: it is compared as a graph, without Verilog of its own.
    """

    part: str
    inputs: Mapping[str, int]
    outputs: Mapping[str, int]
    module: str
    answers: Callable[[Samples], dict[str, Bits]]
    stimulus: Callable[[], dict[str, Bits]] | None
    cared: Callable[[Samples], NDArray[np.bool_]] = everything
    hold: Callable[[Samples], dict[str, Bits]] = dict
    held: tuple[str, ...] = ()
    masks: Mapping[str, Mask] = field(default_factory=dict)
    matters: Mapping[str, Callable[[Samples], NDArray[np.bool_]]] = field(default_factory=dict)
    gates: LogicModel | None = None


@dataclass(frozen=True, eq=False)
class Specification:
    """What all circuits of a design have to compute.

    Attributes:
        claims: by circuit, innermost first.
        reference: Verilog of the reference modules.
        care: Verilog of the modules that know the care set.
        composition: how a circuit that is proved piece by piece is made of its pieces.
    """

    claims: Mapping[str, Claim]
    reference: str
    care: str
    composition: Composition | None = None

    @property
    def is_of_network(self) -> bool:
        """Whether it is of a network of features or gates, which may be large."""
        return self.composition is not None or any(claim.gates for claim in self.claims.values())


def flags_of(care: CareSet, width: int, what: str) -> NDArray[np.bool_]:
    """A care set of codes, bool ``[2**width]``.

    Args:
        care: the care set.
        width: bits of the codes.
        what: whose codes they are, for the errors.

    Raises:
        InputError: it has codes of another width, or is empty: any circuit would equal the model on no input
            at all.
    """
    if care.width != width:
        raise InputError(
            f"the care set of the {what} has other codes", value=f"{care.width} bits, not {width}"
        )
    flags = care.project(tuple(range(width)))
    if not flags.any():
        raise InputError(
            f"the care set of the {what} is empty, so there is nothing to prove",
            hint="give imagery that holds pixels",
        )
    return flags


def value_bits(value: int, width: int) -> Bits:
    """One sample of a word: bool ``[1, width]``."""
    packed = np.frombuffer(value.to_bytes(-(-width // 8), "little"), dtype=np.uint8)
    return np.unpackbits(packed, bitorder="little")[np.newaxis, :width].astype(np.bool_)


def show(values: Mapping[str, Any]) -> str:
    """Port values for a message."""
    return ", ".join(f"{port} {value:#x}" for port, value in values.items())
