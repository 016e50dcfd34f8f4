"""A network is proved piece by piece, and what is wrong in a piece or between pieces is found."""

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from tests.small_networks import bloom, lut_network, thermometer
from wnn2hdl.elaborate import component
from wnn2hdl.emit import verilog
from wnn2hdl.importers import ImportOptions, Source
from wnn2hdl.importers.bthowen import read
from wnn2hdl.ir.circuit import Circuit as Definition
from wnn2hdl.ir.models import NetworkModel
from wnn2hdl.lower.structural import network
from wnn2hdl.minimise.circuit import minimise
from wnn2hdl.verify.equivalence import UNDECIDED, Circuit, find_differences
from wnn2hdl.verify.network import network_specification
from wnn2hdl.verify.proof import WIRING, Proof, prove

MODEL = lut_network(7, layers=(10, 6))
HASHED = bloom(1)


def silent(step: str, done: int, total: int) -> None:
    pass


@pytest.fixture(scope="module")
def definition() -> Definition:
    return mapped(MODEL)[0]


@pytest.fixture(scope="module")
def text() -> str:
    return mapped(MODEL)[1]


def mapped(model: NetworkModel) -> tuple[Definition, str]:
    definition = minimise(network(model), 0, silent).circuit
    return definition, verilog(component(definition, style="cells"), prefix="x_", header=[])


def proofs(definition: Definition, text: str, model: NetworkModel = MODEL) -> dict[str, Proof]:
    emitted = {part: Circuit((text,), f"x_{part}") for part in definition.definitions()}
    return prove(network_specification(model, definition), emitted)


def test_the_pieces_and_their_wiring_prove_the_network(definition: Definition, text: str) -> None:
    found = proofs(definition, text)
    assert {proof.status for proof in found.values()} == {"proved"}
    assert found["network"].method == WIRING


def in_module(part: str, pattern: str, change: Callable[[re.Match[str]], str]) -> Callable[[str], str]:
    """Changes the first match inside the module of a part."""

    def changed(text: str) -> str:
        start = text.index(f"module x_{part} ")
        found = re.compile(pattern).search(text, start)
        assert found is not None
        return text[: found.start()] + change(found) + text[found.end() :]

    return changed


def inverted(found: re.Match[str]) -> str:
    digits = found[2]
    return f"{found[1]}{int(digits, 16) ^ (1 << 4 * len(digits)) - 1:0{len(digits)}x}"


def swapped(found: re.Match[str]) -> str:
    return f"response_0({found[2]}), .response_1({found[1]})"


CONTENTS = r"(INIT\(\d+'h)([0-9a-f]+)"


@pytest.mark.parametrize(
    "fault",
    [
        *(in_module(part, CONTENTS, inverted) for part in ("encoder", "tables", "sum_0", "winner")),
        in_module("core", r"response_0\((\w+)\), \.response_1\((\w+)\)", swapped),
    ],
    ids=["encoder", "table", "sum", "winner", "wiring"],
)
def test_a_fault_anywhere_is_found(definition: Definition, text: str, fault: Callable[[str], str]) -> None:
    found = proofs(definition, fault(text))["network"]
    assert found.status == "refuted"
    assert found.counterexample is not None
    assert found.counterexample.actual != found.counterexample.expected


@pytest.mark.parametrize(
    "model",
    [HASHED, bloom(1, entries=1024, density=0.1), bloom(5, encoder=thermometer(5, features=6))],
    ids=["hashed", "collapsed", "thermometer"],
)
def test_bloom_filters_are_proved_by_their_pieces(model: NetworkModel) -> None:
    found = proofs(*mapped(model), model)
    assert {proof.status for proof in found.values()} == {"proved"}
    assert found["network"].method == WIRING


@pytest.mark.parametrize("part", ["hashes", "tables"])
def test_a_fault_in_a_hash_or_a_look_up_is_found_on_an_input_that_occurs(part: str) -> None:
    definition, text = mapped(HASHED)
    found = proofs(definition, in_module(part, CONTENTS, inverted)(text), HASHED)["network"]
    assert found.status == "refuted"
    assert found.counterexample is not None
    features = found.counterexample.inputs["features"]
    assert HASHED.encoder.bits([[features >> place & 1 for place in range(24)]]).shape == (1, 24)


@pytest.mark.realdata
@pytest.mark.slow
def test_a_published_model_is_proved(realdata: Path) -> None:
    model = read(Source(realdata / "bthowen" / "wine.pickle.lzma"), ImportOptions())
    assert {proof.status for proof in proofs(*mapped(model), model).values()} == {"proved"}


def test_one_entry_of_one_filter_decides() -> None:
    contents = HASHED.contents.copy()
    contents[0, 0, 3] ^= True
    other = replace(HASHED, contents=contents)
    found = proofs(*mapped(other), HASHED)
    assert (found["hashes"].status, found["tables"].status) == ("proved", "refuted")


def adder(total: str) -> Circuit:
    return Circuit(
        (
            "module adder(input [2:0] bits, output [1:0] total);\n"
            "  wire odd = bits[0] ^ bits[1] ^ bits[2];\n"
            "  wire carry = bits[0] & bits[1] | bits[0] & bits[2] | bits[1] & bits[2];\n"
            f"  assign total = {total};\nendmodule\n",
        ),
        "adder",
    )


def test_a_diagram_that_grows_too_large_is_left_to_sat() -> None:
    pair = (adder("{carry, odd}"), adder("bits[0] + bits[1] + bits[2]"))
    assert find_differences([pair, pair], timeout=60, nodes=1) == [None, None]
    assert find_differences([pair], timeout=60, nodes=1000) == [None]
    wrong = adder("{odd, carry}")
    assert find_differences([(pair[0], wrong), pair], timeout=60, nodes=1000)[1] is None
    assert find_differences([(pair[0], wrong)], timeout=60, nodes=1000) not in ([None], [UNDECIDED])
