"""The reference of a network of sums of tables is its model, and refutes what is not."""

import pytest

from tests.small_sums import sum_network
from wnn2hdl.elaborate import component
from wnn2hdl.emit import verilog
from wnn2hdl.ir.wires import word_values
from wnn2hdl.lower.sums import network
from wnn2hdl.minimise.circuit import minimise
from wnn2hdl.verify.equivalence import Circuit, evaluate
from wnn2hdl.verify.proof import METHOD, method, prove
from wnn2hdl.verify.sums import sums_specification


def silent(step: str, done: int, total: int) -> None:
    pass


def test_the_reference_of_every_circuit_is_what_its_claim_answers() -> None:
    model = sum_network(3)
    specification = sums_specification(model)
    reference = (specification.reference,)
    layer, whole = (specification.claims[part] for part in ("layer_1", "network"))
    for claim in (layer, whole):
        assert claim.stimulus is not None
        inputs = {port: bits[:3] for port, bits in claim.stimulus().items()}
        expected = {port: word_values(bits) for port, bits in claim.answers(inputs).items()}
        for sample in range(3):
            values = {port: word_values(bits)[sample] for port, bits in inputs.items()}
            found = evaluate(Circuit(reference, claim.module), values, claim.inputs, tuple(claim.outputs))
            assert found == {port: numbers[sample] for port, numbers in expected.items()}


def test_the_method_says_that_sums_are_proved_another_way() -> None:
    assert method(sums_specification(sum_network(3))).startswith(f"{METHOD}; sums by substitution")


@pytest.mark.slow
def test_a_network_is_proved_and_each_wrong_circuit_of_it_refuted() -> None:
    model = sum_network(5, word_bits=4)
    circuit = minimise(network(model), 0, silent).circuit
    text = verilog(component(circuit, style="cells"), prefix="x_", header=[])
    specification = sums_specification(model)

    def refuted(changed: str) -> list[str]:
        emitted = {part: Circuit((changed,), f"x_{part}") for part in circuit.definitions()}
        return [part for part, proof in prove(specification, emitted).items() if proof.counterexample]

    assert refuted(text) == []
    for part in ("layer_0", "saturation_1", "network"):
        spoiled = inverted(text, text.index(f"module x_{part}"))
        assert refuted(spoiled) == [part]


def inverted(text: str, start: int) -> str:
    """The text with the first look-up table after ``start`` inverted."""
    place = text.index("'h", text.index(".INIT", start)) + 2
    end = text.index(")", place)
    contents = "".join(format(int(digit, 16) ^ 15, "x") for digit in text[place:end])
    return text[:place] + contents + text[end:]
