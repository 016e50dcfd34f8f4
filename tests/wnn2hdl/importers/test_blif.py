from contextlib import suppress
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from wnn2hdl.errors import InputError
from wnn2hdl.importers import ImportOptions, Source
from wnn2hdl.importers.blif import read, recognises
from wnn2hdl.ir.models import LogicModel

FULL_ADDER = """# a comment
.model adder
.inputs a b \\
  c  # continued
.outputs sum carry
.names x c sum
10 1
01 1
.names a b x   # read before it is defined: no fault
00 0
11 0
.names a b c carry
11- 1
1-1 1
-11 1
.default_input_arrival 0 0
.end
anything
"""


def imported(tmp_path: Path, text: str) -> LogicModel:
    path = tmp_path / "a.blif"
    path.write_text(text)
    return read(Source(path), ImportOptions())


def test_covers_list_where_a_node_is_1_or_where_it_is_0(tmp_path: Path) -> None:
    model = imported(tmp_path, FULL_ADDER)
    assert recognises(Source(tmp_path / "a.blif"))
    assert (model.inputs, model.outputs) == (("a", "b", "c"), ("sum", "carry"))
    rows = list(product([0, 1], repeat=3))
    assert model.evaluate(rows).tolist() == [[sum(row) % 2 == 1, sum(row) > 1] for row in rows]


def test_constants_and_inputs_that_are_outputs(tmp_path: Path) -> None:
    text = ".inputs a\n.outputs a zero one none\n.names zero\n.names one\n1\n.names none\n0\n"
    assert imported(tmp_path, text).evaluate([[False], [True]]).tolist() == [
        [False, False, True, False],
        [True, False, True, False],
    ]


covers = st.lists(st.text("01-", min_size=3, max_size=3), max_size=5)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(covers, st.sampled_from("01"))
def test_every_cover_is_what_it_lists(tmp_path: Path, cubes: list[str], answer: str) -> None:
    lines = [".inputs a b c", ".outputs y", ".names a b c y", *(f"{cube} {answer}" for cube in cubes)]
    model = imported(tmp_path, "\n".join(lines))
    rows = list(product("01", repeat=3))
    listed = [
        any(all(c in ("-", bit) for c, bit in zip(cube, row, strict=True)) for cube in cubes) for row in rows
    ]
    expected = listed if answer == "1" or not cubes else [not each for each in listed]
    bits = np.array([[bit == "1" for bit in row] for row in rows])
    assert model.evaluate(bits)[:, 0].tolist() == expected


HEAD = ".model m\n.inputs a b\n.outputs y\n"


@pytest.mark.parametrize(
    ("body", "reason"),
    [
        (".latch a y 2\n", "cannot be imported: .*it has latches; only combinational"),
        (".subckt other x=a y=y\n", "cannot be imported: .*flatten it first"),
        (".gate nand2 A=a O=y\n", "cannot be imported: .*cells of a library"),
        (".exdc\n", "cannot be imported: .*don't-cares"),
        (".model n\n", "holds several models"),
        (".names a y\n1 1\n.names b y\n1 1\n", "y is defined twice"),
        (".names b a\n1 1\n.names a y\n1 1\n", "an input is defined twice"),
        (".names c y\n1 1\n", "nothing defines c"),
        ("", "nothing defines y"),
        (".names a z y\n11 1\n.names y z\n1 1\n", "in a circle"),
        (".names a y\n1 1\n0 0\n", "both where it is 1 and where it is 0"),
        (".names a y\n11 1\n", "not a line of a cover of 1 inputs"),
        (".names a y\nx 1\n", "not a line of a cover"),
        (".names a y\n1 1 1\n", "not a line of a cover"),
        (".names\n", "has no name"),
        ("11 1\n", "neither a directive nor a line of a cover"),
        (".frobnicate\n", "there is no directive .frobnicate"),
        (".names a y \\", "continued by nothing"),
    ],
)
def test_a_file_that_contradicts_itself_gets_one_line(tmp_path: Path, body: str, reason: str) -> None:
    with pytest.raises(InputError, match=reason):
        imported(tmp_path, HEAD + body)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=200)
@given(st.data())
def test_any_damage_gives_a_network_or_one_line(tmp_path: Path, data: st.DataObject) -> None:
    at = data.draw(st.integers(0, len(FULL_ADDER) - 1))
    other = data.draw(st.text(".01- \n\\ab", max_size=2) | st.characters(codec="utf-8"))
    path = tmp_path / "a.blif"
    path.write_bytes((FULL_ADDER[:at] + other + FULL_ADDER[at + data.draw(st.integers(0, 9)) :]).encode())
    with suppress(InputError):
        read(Source(path), ImportOptions())
