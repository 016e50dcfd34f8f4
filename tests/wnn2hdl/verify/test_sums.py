"""The reference of a network of sums of tables is its model, and refutes what is not."""

import pytest

from tests.small_sums import sum_network
from wnn2hdl.elaborate import component
from wnn2hdl.emit import verilog
from wnn2hdl.ir.wires import word_values
from wnn2hdl.lower.sums import network
from wnn2hdl.minimise.circuit import minimise
from wnn2hdl.verify.equivalence import Circuit, evaluate
from wnn2hdl.verify.proof import Proof, method, prove
from wnn2hdl.verify.sums import sums_specification


def silent(step: str, done: int, total: int) -> None:
    pass


def test_the_reference_of_the_network_is_what_its_claim_answers() -> None:
    specification = sums_specification(sum_network(3))
    claim = specification.claims["network"]
    assert claim.stimulus is not None
    inputs = {port: bits[:3] for port, bits in claim.stimulus().items()}
    expected = word_values(claim.answers(inputs)["class_bits"])
    for features, wanted in zip(word_values(inputs["features"]), expected, strict=True):
        whole = Circuit((specification.reference,), claim.module)
        found = evaluate(whole, {"features": features}, claim.inputs, tuple(claim.outputs))
        assert found == {"class_bits": wanted}


def test_the_method_says_that_sums_are_proved_another_way() -> None:
    assert "sums by substitution" in method(sums_specification(sum_network(3)))


@pytest.mark.slow
def test_a_network_is_proved_and_each_wrong_circuit_of_it_refuted() -> None:
    model = sum_network(5, word_bits=4)
    circuit = minimise(network(model), 0, silent).circuit
    text = verilog(component(circuit, style="cells"), prefix="x_", header=[])
    specification = sums_specification(model)

    def proofs(changed: str) -> dict[str, Proof]:
        emitted = {part: Circuit((changed,), f"x_{part}") for part in circuit.definitions()}
        return prove(specification, emitted)

    assert {proof.status for proof in proofs(text).values()} == {"proved"}
    for part in ("layer_0", "saturation_1", "winner"):
        found = proofs(inverted(text, text.index(f"module x_{part}")))
        assert [name for name, proof in found.items() if proof.status == "refuted"] == [part, "network"]
        counterexample = found["network"].counterexample
        assert counterexample is not None
        assert counterexample.actual != counterexample.expected
    swapped = (
        text.replace(".total_0(", ".total_x(").replace(".total_1(", ".total_0(").replace("total_x", "total_1")
    )
    assert proofs(swapped)["network"].counterexample is not None


def test_a_sum_that_is_neither_proved_nor_refuted_is_undecided() -> None:
    model = sum_network(5, word_bits=4)
    circuit = minimise(network(model), 0, silent).circuit
    text = verilog(component(circuit, style="cells"), prefix="x_", header=[])
    specification = sums_specification(model)
    assert specification.composition is not None
    outputs = specification.composition.pieces["layer_0"].outputs
    nets = "".join(f", output [{width - 1}:0] {port}" for port, width in outputs.items())
    pins = ", ".join(f".{port}({port})" for port in outputs if port != "total_0")
    # It is wrong for one word of 65,536, which no sample has.
    rare = (
        f"module x_layer_0(input [15:0] words{nets}); wire [{outputs['total_0'] - 1}:0] right;\n"
        f"x_right it (.words(words), .total_0(right), {pins}); assign total_0 = right ^ &words; endmodule\n"
    )
    changed = text.replace("module x_layer_0 ", "module x_right ") + rare
    emitted = {part: Circuit((changed,), f"x_{part}") for part in circuit.definitions()}
    found = {part: proof.status for part, proof in prove(specification, emitted).items()}
    assert {part for part, status in found.items() if status == "undecided"} == {"layer_0", "network"}


def inverted(text: str, start: int) -> str:
    """The text with the first look-up table after ``start`` inverted."""
    place = text.index("'h", text.index(".INIT", start)) + 2
    end = text.index(")", place)
    contents = "".join(format(int(digit, 16) ^ 15, "x") for digit in text[place:end])
    return text[:place] + contents + text[end:]
