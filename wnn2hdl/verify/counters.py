"""Sums proved by arithmetic: a network of counters adds up if every counter does.

A counter takes bits and gives bits, and keeps their weighted sum: of a full adder, ``a + b + c = s + 2 *
carry``. The proof starts with the sum of the output bits by their weights. From the outputs to the inputs,
it replaces the outputs of one counter after the other by what that counter takes, and ends with a sum of
weighted inputs. These weights have to be the ones that were claimed.

Why it is sound. Each step replaces terms by others that are equal for all values of the wires that the
counter reads, as its truth table shows. All steps are modulo ``2**w`` for an output of ``w`` bits, so that a
carry out of the highest bit weighs nothing; output and claimed sum are both below ``2**w``, so they are
equal if they are equal modulo ``2**w``. Where wires have names is only a hint: where no counter is found,
nothing is shown.

In a pipeline a wire stands for its value when it arrives, and all ways from inputs to outputs have to pass as
many registers as the pipeline has cycles.
"""

from collections.abc import Mapping, Sequence

from wnn2hdl.verify.equivalence import Circuit
from wnn2hdl.verify.gates import CONSTANTS, MAX_READ, Gates, Wire, all_values


def adds_up(circuit: Circuit, port: str, weights: Sequence[int], offset: int, output: str) -> bool:
    """Whether arithmetic shows that an output is the sum of the weights of the input bits that are set.

    Args:
        circuit: the sum; what drives its declared wires are counters.
        port: the input.
        weights: of each bit of it.
        offset: is added to the sum.
        output: as many bits as the largest sum needs.

    Returns:
        True if it is shown; False says nothing.

    Raises:
        ToolError: Yosys cannot read the circuit.
    """
    gates = Gates.read(circuit)
    bits, total = gates.ports[port], gates.ports[output]
    modulus = 1 << len(total)
    if len(bits) != len(weights) or offset + sum(weights) >= modulus:
        return False
    if any(not gates.arrivals(wire) <= {circuit.latency} for wire in total):
        return False
    found = _reduced(gates, {wire: 1 << place for place, wire in enumerate(total)}, modulus)
    wanted: dict[Wire, int] = {wire: weight % modulus for wire, weight in zip(bits, weights, strict=True)}
    return found is not None and found.pop("1", 0) == offset and found == wanted


def _reduced(gates: Gates, form: dict[Wire, int], modulus: int) -> dict[Wire, int] | None:
    """A sum of wires as one of inputs, whose constant is the weight of ``1``; None if none is found."""
    form = _added({}, form, modulus)
    while made := sorted((wire for wire in form if wire in gates.cut), key=gates.level, reverse=True):
        for wire in made:
            inputs = gates.reads(wire)
            group = [other for other in made if set(gates.reads(other)) <= set(inputs)]
            replaced = _linear(gates, {other: form[other] for other in group}, inputs, modulus)
            if replaced is not None:
                form = _added({x: w for x, w in form.items() if x not in group}, replaced, modulus)
                break
        else:
            return None
    return form


def _linear(
    gates: Gates, part: Mapping[Wire, int], inputs: Sequence[Wire], modulus: int
) -> dict[Wire, int] | None:
    """A weighted sum of wires as one of the wires that they read, if it is one for all values of these."""
    if len(inputs) > MAX_READ:
        return None
    columns = all_values(inputs)
    # Python's own numbers, since a weight may leave no room for sums in an int64.
    values = [0] * (1 << len(inputs))
    for wire, weight in part.items():
        values = [x + weight * int(bit) for x, bit in zip(values, gates.table(wire, columns), strict=True)]
    weights = [(values[1 << place] - values[0]) % modulus for place in range(len(inputs))]
    for code, value in enumerate(values):
        expected = values[0] + sum(w for place, w in enumerate(weights) if code >> place & 1)
        if (value - expected) % modulus:
            return None
    return {"1": values[0], **dict(zip(inputs, weights, strict=True))}


def _added(left: Mapping[Wire, int], right: Mapping[Wire, int], modulus: int) -> dict[Wire, int]:
    """The sum of two weighted sums, without terms that weigh nothing."""
    total = dict(left)
    for wire, weight in right.items():
        total[wire] = (total.get(wire, 0) + weight) % modulus
    return {wire: weight for wire, weight in total.items() if weight and wire != CONSTANTS[0]}
