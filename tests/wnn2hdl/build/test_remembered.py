"""A check is remembered under everything that decides its outcome."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from wnn2hdl.build import remembered
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.lower import deforestation
from wnn2hdl.synth import cache
from wnn2hdl.verify import equivalence
from wnn2hdl.verify.stimulus import edge

LEFT = equivalence.Circuit(("module a(input x, output y); assign y = x; endmodule",), "a")
RIGHT = equivalence.Circuit(("module b(input x, output y); assign y = !(!x); endmodule",), "b")


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(cache.FOLDER, str(tmp_path / "cache"))


def test_a_check_has_passed_once_that_is_noted() -> None:
    key = remembered.proof_key(LEFT, RIGHT)
    assert not remembered.passed(key)
    remembered.remember(key)
    assert remembered.passed(key)
    assert not remembered.passed(remembered.proof_key(RIGHT, LEFT))


@pytest.mark.parametrize(
    "content", ['{"passed": false}', "", '{"key": {}, "result": {"passed": true}}', "\n{}"]
)
def test_an_entry_that_is_damaged_or_says_something_else_counts_for_nothing(content: str) -> None:
    key = remembered.proof_key(LEFT, RIGHT)
    remembered.remember(key)
    path = cache.location(key["check"], key)
    whole = path.read_text()
    path.write_text(whole[:-10])
    assert not remembered.passed(key)
    path.write_text(f"{cache.digest(content)}\n{content}")
    assert not remembered.passed(key)
    cache.store(key["check"], key, {"passed": False})
    assert not remembered.passed(key)


@pytest.mark.parametrize(
    "other",
    [
        replace(LEFT, top="b"),
        replace(LEFT, latency=1),
        replace(LEFT, sources=(LEFT.sources[0].replace("x;", "!x;"),)),
        replace(LEFT, sources=(*LEFT.sources, "")),
        replace(LEFT, sources=(LEFT.sources[0][:5], LEFT.sources[0][5:])),
    ],
    ids=["top", "latency", "text", "one more text", "texts split elsewhere"],
)
def test_a_proof_is_of_these_texts_alone(other: equivalence.Circuit) -> None:
    assert remembered.proof_key(other, RIGHT) != remembered.proof_key(LEFT, RIGHT)
    assert remembered.proof_key(RIGHT, other) != remembered.proof_key(RIGHT, LEFT)


def test_tools_and_this_program_are_part_of_a_proof(monkeypatch: pytest.MonkeyPatch) -> None:
    key = remembered.proof_key(LEFT, RIGHT)
    monkeypatch.setattr(remembered, "abc_version", lambda: "another")
    other_abc = remembered.proof_key(LEFT, RIGHT)
    monkeypatch.setattr(remembered, "code_digest", lambda: "another")
    assert len({frozenset(x.items()) for x in (key, other_abc, remembered.proof_key(LEFT, RIGHT))}) == 3


def test_a_simulation_is_of_this_circuit_on_these_vectors_alone() -> None:
    circuit = deforestation.match()
    inputs = edge(np.ones(512, dtype=np.bool_))
    answers = {"edge_bit": inputs["bits"][:, :1]}
    renamed = Circuit("other", circuit.summary, circuit.inputs, circuit.nodes, circuit.drivers)
    keys = [
        remembered.simulation_key(circuit, "cells", inputs, answers),
        remembered.simulation_key(renamed, "cells", inputs, answers),
        remembered.simulation_key(circuit, "equations", inputs, answers),
        remembered.simulation_key(circuit, "cells", {"bits": ~inputs["bits"]}, answers),
        remembered.simulation_key(circuit, "cells", {"bit": inputs["bits"]}, answers),
        remembered.simulation_key(circuit, "cells", inputs, {"edge_bit": ~answers["edge_bit"]}),
    ]
    assert len({frozenset(key.items()) for key in keys}) == len(keys)
