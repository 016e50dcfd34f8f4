"""Circuits and references in a wrapper that holds their inputs in the care set, so that they can be compared.

Why the comparison is a proof. Both sides of a comparison stand in the same wrapper, whose pixels pass through
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

A pipeline is in the wrapper with its registers, and is equal to the reference its latency later
(`wnn2hdl.verify.equivalence`); a mask that reads an input passes as many registers as the pipeline has.

The care set is not empty (`wnn2hdl.verify.specification.flags_of` refuses that), so no claim holds vacuously.
"""

from wnn2hdl.ir import PIXEL_BITS
from wnn2hdl.verify.equivalence import CLOCK, Circuit
from wnn2hdl.verify.specification import Claim, Specification

_HELD = "proof__held"


def sides(specification: Specification, claim: Claim, circuit: Circuit) -> tuple[Circuit, Circuit]:
    """What a proof compares: a circuit and the reference of its claim, both held in the care set.

    Of a gate network, whose reference is no Verilog, the digest of the model stands for the reference.
    """
    if claim.gates is not None:
        return circuit, Circuit((claim.gates.digest(),), claim.module)
    reference = Circuit((specification.reference,), claim.module)
    return held_in_care(specification, claim, circuit), held_in_care(specification, claim, reference)


def held_in_care(specification: Specification, claim: Claim, circuit: Circuit) -> Circuit:
    """A circuit in the wrapper that holds its inputs inside the care set (see the top of this file)."""
    clocked = bool(circuit.latency)
    header = [f"input {CLOCK}"] if clocked else []
    header += [f"input [{width - 1}:0] {port}" for port, width in claim.inputs.items()]
    header += [f"output [{width - 1}:0] {port}" for port, width in claim.outputs.items()]
    nets = {port: port for port in (*claim.inputs, *claim.outputs)}
    lines = [f"module {_HELD}({', '.join(header)});"]
    for port in claim.held:
        nets[port] = f"held_{port}"
        lines.append(f"  wire [{claim.inputs[port] - 1}:0] held_{port};")
        for low in range(0, claim.inputs[port], PIXEL_BITS):
            bits = f"[{low + PIXEL_BITS - 1}:{low}]"
            lines.append(
                f"  proof__care_pixel care_{port}_{low} (.free({port}{bits}), .rgb(held_{port}{bits}));"
            )
    if clocked:
        nets[CLOCK] = CLOCK
    for port, mask in claim.masks.items():
        width = claim.outputs[port]
        # What an input says about an output comes out as much later as the output.
        delay = circuit.latency if mask.port in claim.inputs else 0
        nets[port] = f"any_{port}"
        lines += [
            f"  wire [{width - 1}:0] any_{port};",
            f"  wire cared_{port}_0;",
            f"  {mask.module} care_{port} (.{mask.port}({mask.port}), .cared(cared_{port}_0));",
            *(
                f"  reg cared_{port}_{cycle + 1}; always @(posedge {CLOCK}) "
                f"cared_{port}_{cycle + 1} <= cared_{port}_{cycle};"
                for cycle in range(delay)
            ),
            f"  assign {port} = any_{port} & {{{width}{{cared_{port}_{delay}}}}};",
        ]
    connections = ", ".join(f".{port}({net})" for port, net in nets.items())
    wrapper = "\n".join([*lines, f"  {circuit.top} circuit ({connections});", "endmodule", ""])
    return Circuit((wrapper, specification.care, *circuit.sources), _HELD, circuit.latency)
