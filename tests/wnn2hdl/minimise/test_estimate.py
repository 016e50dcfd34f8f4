"""Estimates are near what the minimiser finds, on tables with few codes and with many."""

import numpy as np
import pytest

from tests.small_networks import bloom, lut_network
from wnn2hdl.ir import LutNetwork, TruthTable
from wnn2hdl.lower.structural import network
from wnn2hdl.minimise.circuit import minimise
from wnn2hdl.minimise.estimate import estimated_luts, table_luts, xor_luts
from wnn2hdl.minimise.portfolio import map_luts


@pytest.mark.parametrize(("inputs", "on"), [(7, 40), (8, 64), (9, 128), (10, 200), (12, 30)])
def test_a_table_takes_about_as_many(inputs: int, on: int) -> None:
    values = np.zeros(1 << inputs, dtype=np.bool_)
    values[np.random.default_rng(0).permutation(1 << inputs)[:on]] = True
    names = tuple(f"i{place}" for place in range(inputs))
    found = len(map_luts(TruthTable.exact(names, ("o",), values[:, np.newaxis]), effort=0).network.luts)
    assert found / 2 <= table_luts(inputs, on) <= found * 1.5


def test_small_tables_and_exclusive_ors_are_known_exactly() -> None:
    assert [table_luts(inputs, 1) for inputs in (0, 1, 2, 6)] == [0, 0, 1, 1]
    assert table_luts(6, 0) == 0
    assert [xor_luts(inputs) for inputs in (1, 2, 6, 7, 11, 12)] == [0, 1, 1, 2, 2, 3]


@pytest.mark.parametrize("model", [bloom(1), lut_network(1, layers=(10, 6))])
def test_a_mapped_circuit_counts_its_luts(model: object) -> None:
    lowered = network(model)  # type: ignore[arg-type]
    mapped = minimise(lowered, 0, lambda *_: None).circuit
    tables = [table.function for table in mapped.tables().values()]
    luts = sum(len(function.luts) for function in tables if isinstance(function, LutNetwork))
    assert estimated_luts(mapped) > luts
    assert estimated_luts(lowered) == pytest.approx(estimated_luts(mapped), rel=0.35)
