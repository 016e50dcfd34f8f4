from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.importers import ImportOptions, Source
from wnn2hdl.importers.aiger import read, recognises
from wnn2hdl.ir.models import LogicModel

HALF_ADDER = """aag 7 2 0 2 3
2
4
6
12
6 13 15
12 2 4
14 3 5
i0 x
i1 y
o0 s
o1 c
c
half adder
"""
"""Of the format's description; its gates are not in order."""


def imported(tmp_path: Path, content: str | bytes) -> LogicModel:
    path = tmp_path / "a.aig"
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    assert recognises(Source(path))
    return read(Source(path), ImportOptions())


def binary(model: LogicModel, symbols: str = "") -> bytes:
    """A network in binary AIGER, as the format's description has it."""
    inputs, gates = model.width, len(model.gates)
    content = f"aig {inputs + gates} {inputs} 0 {len(model.outputs)} {gates}\n".encode()
    content += "".join(f"{literal}\n" for literal in model.literals).encode()
    for index, (left, right) in enumerate(model.gates.tolist()):
        own, high, low = 2 * (1 + inputs + index), max(left, right), min(left, right)
        for delta in (own - high, high - low):
            while delta > 0x7F:
                content += bytes([delta & 0x7F | 0x80])
                delta >>= 7
            content += bytes([delta])
    return content + symbols.encode()


def shuffled(model: LogicModel, seed: int) -> str:
    """A network in ASCII AIGER, with other numbers for its variables and its gates in any order."""
    rng = np.random.default_rng(seed)
    count = 1 + model.width + len(model.gates)
    number = np.concatenate([[0], 1 + rng.permutation(count - 1)])

    def literal(value: int) -> int:
        return int(2 * number[value >> 1] + (value & 1))

    own = [2 * (1 + model.width + index) for index in range(len(model.gates))]
    gates = [
        f"{literal(o)} {literal(a)} {literal(b)}" for o, (a, b) in zip(own, model.gates.tolist(), strict=True)
    ]
    lines = [f"aag {count - 1} {model.width} 0 {len(model.outputs)} {len(gates)}"]
    lines += [str(literal(2 * (1 + index))) for index in range(model.width)]
    lines += [str(literal(value)) for value in model.literals.tolist()]
    lines += [gates[index] for index in rng.permutation(len(gates))]
    return "\n".join(lines) + "\n"


@st.composite
def networks(draw: st.DrawFn) -> LogicModel:
    inputs, gates, outputs = draw(st.integers(1, 5)), draw(st.integers(0, 90)), draw(st.integers(1, 4))
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    reads = [rng.integers(0, 2 * (1 + inputs + index), 2) for index in range(gates)]
    return LogicModel(
        inputs=tuple(f"i{index}" for index in range(inputs)),
        outputs=tuple(f"o{index}" for index in range(outputs)),
        gates=np.array(reads, dtype=np.uint32).reshape(-1, 2),
        literals=rng.integers(0, 2 * (1 + inputs + gates), outputs, dtype=np.uint32),
    )


def every_input(model: LogicModel) -> NDArray[np.bool_]:
    return (np.arange(1 << model.width)[:, np.newaxis] >> np.arange(model.width) & 1).astype(np.bool_)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(networks(), st.integers(0, 99))
def test_both_forms_answer_as_the_network_that_was_written(
    tmp_path: Path, model: LogicModel, seed: int
) -> None:
    bits = every_input(model)
    for content in (binary(model), shuffled(model, seed)):
        again = imported(tmp_path, content)
        assert (again.inputs, again.outputs) == (model.inputs, model.outputs)
        assert np.array_equal(again.evaluate(bits), model.evaluate(bits))


def test_the_symbol_table_names_inputs_and_outputs(tmp_path: Path) -> None:
    model = imported(tmp_path, HALF_ADDER)
    assert (model.inputs, model.outputs) == (("x", "y"), ("s", "c"))
    assert model.evaluate([[0, 0], [1, 0], [1, 1]]).tolist() == [[False, False], [True, False], [False, True]]
    again = imported(tmp_path, binary(model, "o1 a long name\nc\nanything\ni9 here\n"))
    assert (again.inputs, again.outputs) == (("i0", "i1"), ("o0", "a long name"))


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        ("aag 1 0 1 0 0\n2 3\n", r"only combinational ones can be imported: .*1 latches"),
        ("aig 1 1 0 1 0 1\n2\n2\n", r"only combinational ones .*0 latches, 1 properties"),
        ("aag 1 1\n", "the first line is not a header"),
        ("aag 1 0 0 1 0\n0\n", "0 inputs and 1 outputs"),
        ("aag 999999999 1 0 1 0\n2\n2\n", "999999999 variables"),
        ("aig 999999 1 0 1 999998\n2\n", "999999 variables"),
        ("aag 2 2 0 1 0\n2\n2\n2\n", "defined twice"),
        ("aag 1 1 0 1 0\n3\n2\n", "a literal that is not a variable"),
        ("aag 1 1 0 1 0\n2\n4\n", "literal 4 is of a variable that does not exist"),
        ("aag 3 1 0 1 1\n2\n4\n4 6 2\n", "nothing defines"),
        ("aag 3 1 0 1 2\n2\n4\n4 6 2\n6 4 2\n", "in a circle"),
        ("aag 1 1 0 1 0\n2\nx\n", "do not hold 1 numbers"),
        ("aag 1 1 0 1 0\n2\n", "ends too early"),
        ("aig 2 1 0 1 1\n2\n\x81\x81", "the gates end too early"),
        ("aig 2 1 0 1 1\n2\n\x00\x00", "a gate reads itself"),
        ("aig 2 1 0 1 1\n2\n\x02\x7f", "a gate reads itself"),
        ("aig 3 1 0 1 1\n2\n\x02\x00", "3 variables for 1 inputs and 1 gates"),
        (HALF_ADDER.replace("o1 c", "o2 c"), "'o2 c' names nothing"),
        (HALF_ADDER.replace("i1 y", "i1 x"), "its own name"),
    ],
)
def test_a_file_that_contradicts_itself_gets_one_line(tmp_path: Path, content: str, reason: str) -> None:
    with pytest.raises(InputError, match=reason):
        imported(tmp_path, content.encode("latin-1"))


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=200)
@given(networks(), st.data())
def test_any_damage_gives_a_network_or_one_line(
    tmp_path: Path, model: LogicModel, data: st.DataObject
) -> None:
    content = bytearray(data.draw(st.sampled_from([binary(model), shuffled(model, 0).encode()])))
    content[data.draw(st.integers(4, len(content) - 1))] = data.draw(st.integers(0, 255))
    cut = data.draw(st.none() | st.integers(4, len(content)))
    with suppress(InputError):
        imported(tmp_path, bytes(content[:cut]))
