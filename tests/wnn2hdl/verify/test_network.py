"""The reference of a whole network is its model, and refutes what is not."""

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.small_networks import WORDS, bloom, encoder_of, lut_network, thermometer, wisard
from wnn2hdl.elaborate import component
from wnn2hdl.emit import verilog
from wnn2hdl.ir.models import NetworkModel
from wnn2hdl.ir.wires import word_values
from wnn2hdl.lower.structural import network
from wnn2hdl.minimise.circuit import minimise
from wnn2hdl.verify.equivalence import Circuit, evaluate, find_differences
from wnn2hdl.verify.network import network_specification
from wnn2hdl.verify.network_lines import at_least
from wnn2hdl.verify.proof import prove


def silent(step: str, done: int, total: int) -> None:
    pass


def emitted(model: NetworkModel) -> str:
    circuit = minimise(network(model), 0, silent).circuit
    return verilog(component(circuit, style="cells"), prefix="x_", header=[])


@pytest.mark.parametrize(
    "model",
    [
        lut_network(3),
        wisard(3),
        wisard(4, ties="first"),
        bloom(3),
        bloom(4, encoder=thermometer(4, features=6)),
    ],
)
def test_the_reference_is_the_model(model: NetworkModel) -> None:
    specification = network_specification(model)
    claim = specification.claims["network"]
    assert claim.stimulus is not None
    inputs = {port: bits[:: len(bits) // 5] for port, bits in claim.stimulus().items()}
    expected = word_values(claim.answers(inputs)["class_bits"])
    reference = Circuit((specification.reference,), claim.module)
    for sample, answer in zip(word_values(inputs["features"]), expected, strict=True):
        found = evaluate(reference, {"features": sample}, claim.inputs, ("class_bits",))
        assert found == {"class_bits": answer}


def test_every_threshold_is_looked_at_from_both_sides() -> None:
    model = lut_network(5)
    claim = network_specification(model).claims["network"]
    assert claim.stimulus is not None
    encoder = encoder_of(model)
    bits = encoder.bits_of_words(words_of(claim.stimulus()["features"]))
    constant = bits.all(axis=0) | ~bits.any(axis=0)
    beyond = [not WORDS.lowest < level <= WORDS.highest for levels in encoder.levels for level in levels]
    assert constant.tolist() == beyond


def words_of(features: NDArray[np.bool_]) -> NDArray[np.int64]:
    digits = features.reshape(len(features), -1, 6).astype(np.int64)
    return np.asarray(digits @ np.array([1, 2, 4, 8, 16, -32]))


@pytest.mark.slow
def test_a_network_is_proved_and_a_wrong_one_refuted() -> None:
    model = lut_network(7, layers=(10, 6))
    text = emitted(model)
    specification = network_specification(model)
    proof = prove(specification, {"network": Circuit((text,), "x_network")})["network"]
    assert proof.status == "proved"
    place = text.index("'h", text.index(".INIT")) + 2
    spoiled = text[:place] + format(int(text[place], 16) ^ 15, "x") + text[place + 1 :]
    found = prove(specification, {"network": Circuit((spoiled,), "x_network")})["network"].counterexample
    assert found is not None
    assert found.expected != found.actual


def test_a_threshold_bit_by_bit_is_a_comparison() -> None:
    def circuit(sides: list[str]) -> Circuit:
        lines = "".join(f"assign y[{least}] = {side};\n" for least, side in enumerate(sides))
        return Circuit((f"module x(input [5:0] w, output [15:0] y);\n{lines}endmodule\n",), "x")

    plain = circuit([f"w[5:2] >= 4'd{least}" for least in range(16)])
    bitwise = circuit([at_least("w", least, 4, low=2) for least in range(16)])
    assert find_differences([(plain, bitwise)], timeout=60) == [None]
    assert at_least("w", -1, 4) == "1'b1"
    assert at_least("w", 16, 4) == "1'b0"


def test_large_networks_are_simulated_on_fewer_vectors() -> None:
    def vectors(tables: int) -> int:
        draw = network_specification(lut_network(3, layers=(tables,))).claims["network"].stimulus
        assert draw is not None
        return len(draw()["features"])

    assert [vectors(tables) for tables in (12, 200, 3000)] == [10_240, (1 << 20) // 212, 512]
