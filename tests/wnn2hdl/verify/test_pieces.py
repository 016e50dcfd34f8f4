"""A network is proved piece by piece, and what is wrong in a piece or between pieces is found."""

import re
from collections.abc import Callable

import pytest

from tests.small_networks import lut_network
from wnn2hdl.elaborate import component
from wnn2hdl.emit import verilog
from wnn2hdl.ir.circuit import Circuit as Definition
from wnn2hdl.lower.structural import network
from wnn2hdl.minimise.circuit import minimise
from wnn2hdl.verify.equivalence import UNDECIDED, Circuit, find_differences
from wnn2hdl.verify.network import network_specification
from wnn2hdl.verify.proof import WIRING, Proof, prove

MODEL = lut_network(7, layers=(10, 6))


def silent(step: str, done: int, total: int) -> None:
    pass


@pytest.fixture(scope="module")
def definition() -> Definition:
    return minimise(network(MODEL), 0, silent).circuit


@pytest.fixture(scope="module")
def text(definition: Definition) -> str:
    return verilog(component(definition, style="cells"), prefix="x_", header=[])


def proofs(definition: Definition, text: str) -> dict[str, Proof]:
    emitted = {part: Circuit((text,), f"x_{part}") for part in definition.definitions()}
    return prove(network_specification(MODEL, definition), emitted)


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
