"""A table is minimised once; what the cache holds for it is checked against the table."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from wnn2hdl.build import minimising
from wnn2hdl.build.minimising import minimise_once
from wnn2hdl.ir import TruthTable
from wnn2hdl.minimise.circuit import MinimisedTable, minimise_table
from wnn2hdl.synth import cache


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(cache.FOLDER, str(tmp_path / "cache"))


@pytest.fixture
def table() -> TruthTable:
    """Seven inputs, two outputs, a third of the codes free."""
    rng = np.random.default_rng(0)
    names = tuple(f"x{i}" for i in range(7))
    return TruthTable(names, ("a", "b"), rng.random((128, 2)) < 0.5, rng.random(128) < 0.66)


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The efforts of all calls of the minimiser."""
    efforts: list[int] = []

    def counted(table: TruthTable, effort: int, lut_inputs: int) -> MinimisedTable:
        efforts.append(effort)
        return minimise_table(table, effort, lut_inputs)

    monkeypatch.setattr(minimising, "minimise_table", counted)
    return efforts


def test_what_is_remembered_equals_what_was_found(table: TruthTable, calls: list[int]) -> None:
    first = minimise_once(table, 0)
    assert first == minimise_table(table, 0) == minimise_once(table, 0)
    assert calls == [0]


def test_another_table_another_effort_and_another_program_are_minimised(
    table: TruthTable, calls: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    minimise_once(table, 0)
    minimise_once(table, 1)
    minimise_once(table.with_care(np.ones(128, dtype=np.bool_)), 0)
    monkeypatch.setattr(minimising, "code_digest", lambda: "another")
    minimise_once(table, 0)
    monkeypatch.setattr(minimising, "generators", lambda: {"numpy": "another"})
    minimise_once(table, 0)
    assert calls == [0, 1, 0, 0, 0]


def wrong_lut(result: dict[str, Any]) -> None:
    cell = result["network"]["cells"][0]
    cell["init"] = f"{int(cell['init'], 16) ^ (1 << (1 << len(cell['inputs']))) - 1:x}"


def wrong_cover(result: dict[str, Any]) -> None:
    result["cover"] = result["cover"][1:]


def renamed_output(result: dict[str, Any]) -> None:
    result["network"]["outputs"][0][0] = "c"


def no_network(result: dict[str, Any]) -> None:
    del result["network"]


def no_cubes(result: dict[str, Any]) -> None:
    result["cover"] = [["many"]]


@pytest.mark.parametrize("spoil", [wrong_lut, wrong_cover, renamed_output, no_network, no_cubes])
def test_a_wrong_entry_changes_no_answer(
    table: TruthTable,
    calls: list[int],
    monkeypatch: pytest.MonkeyPatch,
    spoil: Callable[[dict[str, Any]], None],
) -> None:
    first = minimise_once(table, 0)
    load = cache.load

    def spoiled(kind: str, key: dict[str, str]) -> dict[str, Any] | None:
        result = load(kind, key)
        if result is not None:
            spoil(result)
        return result

    monkeypatch.setattr(cache, "load", spoiled)
    assert minimise_once(table, 0) == first
    assert calls == [0, 0]


def test_luts_of_another_size_are_not_taken_for_these(table: TruthTable) -> None:
    six = minimise_once(table, 0).network
    four = minimise_once(table, 0, lut_inputs=4).network
    assert max(len(lut.inputs) for lut in four.luts) <= 4 < max(len(lut.inputs) for lut in six.luts)
    assert minimise_once(table, 0).network == six
