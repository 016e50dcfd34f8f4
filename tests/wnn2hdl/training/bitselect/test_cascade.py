import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wnn2hdl.ir import codes_to_bits
from wnn2hdl.training.bitselect.cascade import STARTS, Cascade, Table, find_cascade
from wnn2hdl.training.bitselect.single import best_subset

WIDTH = 12
CODES = np.arange(1 << WIDTH)
BITS = codes_to_bits(CODES, WIDTH)


def score(cascade: Cascade, mass: np.ndarray[tuple[int], np.dtype[np.int64]]) -> int:
    return int(np.where(cascade.evaluate(CODES), mass, -mass).sum())


def test_tables_read_bits_and_the_tables_before_them() -> None:
    conjunction, exclusive = np.array([0, 0, 0, 1], bool), np.array([0, 1, 1, 0], bool)
    cascade = Cascade(3, (Table((0, 2), conjunction), Table((1, 3), exclusive)))
    assert cascade.bits == (0, 1, 2)
    assert cascade.evaluate(np.arange(8)).tolist() == [((c & 5) == 5) ^ (c >> 1 & 1) for c in range(8)]


def test_one_lut_is_the_best_choice_of_six_bits() -> None:
    mass = np.random.default_rng(1).integers(-9, 10, 1 << WIDTH)
    cascade = find_cascade(mass, 1, seed=0)
    assert len(cascade.bits) == 6
    assert score(cascade, mass) == best_subset(mass, 6).score


@pytest.mark.parametrize("luts", [2, 3])
def test_a_function_that_decomposes_is_found_whole(luts: int) -> None:
    level = BITS[:, [0, 3, 5, 7, 8, 11]].sum(axis=1)
    inner = level >= 3 if luts == 2 else np.where(BITS[:, 2], level >= 4, level >= 2)
    mass = np.where(inner & BITS[:, 1] | BITS[:, 4], 3, -2)
    cascade = find_cascade(mass, luts, seed=0)
    assert len(cascade.tables) == luts
    assert score(cascade, mass) == np.abs(mass).sum()


@settings(max_examples=5, deadline=None)
@given(st.integers(0, 1000))
def test_more_luts_never_lose_what_one_has(seed: int) -> None:
    rng = np.random.default_rng(seed)
    mass = rng.integers(-99, 100, 1 << WIDTH) + 60 * BITS[:, rng.permutation(WIDTH)[:3]].sum(axis=1) - 90
    one, two = (score(find_cascade(mass, luts, seed=0), mass) for luts in (1, 2))
    assert two >= one


def test_no_table_reads_more_than_six_inputs() -> None:
    mass = np.random.default_rng(2).integers(-9, 10, 1 << WIDTH)
    for luts in (2, 3):
        assert {len(table.inputs) for table in find_cascade(mass, luts, seed=0).tables} == {6}


def test_progress_counts_the_starts_and_the_result_depends_on_the_seed_alone() -> None:
    mass = np.random.default_rng(3).integers(-9, 10, 1 << WIDTH)
    reported: list[tuple[int, int]] = []
    first = find_cascade(mass, 2, seed=5, progress=lambda done, total: reported.append((done, total)))
    second = find_cascade(mass, 2, seed=5)
    assert reported == [(done, STARTS) for done in range(1, STARTS + 1)]
    assert [table.inputs for table in first.tables] == [table.inputs for table in second.tables]
    assert (first.evaluate(CODES) == second.evaluate(CODES)).all()
