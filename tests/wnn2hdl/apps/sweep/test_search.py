import sys
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from wnn2hdl.apps.sweep.grid import Recipe, Trial
from wnn2hdl.apps.sweep.pixels import PixelSets
from wnn2hdl.apps.sweep.search import MAX_BITS, POPULATION, SEARCHED_BITS, position, search
from wnn2hdl.apps.sweep.store import Results
from wnn2hdl.apps.sweep.trial import Record, failed
from wnn2hdl.errors import ExtraMissingError

TRIALS = 6 * POPULATION


def rewarding(sets: PixelSets, trials: Iterable[Trial]) -> Iterator[list[Record]]:
    """A made-up landscape: blue bits and few RAMs are good, everything else costs."""
    for trial in trials:
        blue = sum(bit.startswith("B") for bit in trial.bits) / len(trial.bits)
        record = failed(trial, ValueError())
        yield [
            replace(record, status="valid", error="", accuracy=blue, circuit_accuracy=blue, luts=trial.rams)
        ]


def searched(sets: PixelSets, recipe: Recipe, path: Path, run: Any = rewarding) -> list[Record]:
    pytest.importorskip("optuna")
    with Results(path, {}, TRIALS, position) as results:
        search(sets, recipe, ((2, 12), (2, 20)), results, run, lambda *_: None)
        return list(results)


def test_later_generations_are_better_than_the_random_first(
    sets: PixelSets, recipe: Recipe, tmp_path: Path
) -> None:
    found = searched(sets, recipe, tmp_path / "s.journal")
    assert len(found) == TRIALS
    first, last = found[:POPULATION], found[-POPULATION:]
    assert sum(x.luts or 0 for x in last) < sum(x.luts or 0 for x in first) * 0.6
    assert sum(x.accuracy or 0 for x in last) > sum(x.accuracy or 0 for x in first)


def test_trials_are_within_what_can_be_built(sets: PixelSets, recipe: Recipe, tmp_path: Path) -> None:
    found = searched(sets, recipe, tmp_path / "s.journal")
    for record in found:
        assert set(record.bits) <= set(SEARCHED_BITS)
        assert 1 <= len(record.bits) <= MAX_BITS
        assert 1 <= record.address_bits <= min(12, len(record.bits))
        assert 2 <= record.rams <= 20
    assert len({record.care_minimum for record in found}) > 20


def test_exact_mode_searches_no_care_threshold(sets: PixelSets, recipe: Recipe, tmp_path: Path) -> None:
    exact = searched(sets, replace(recipe, care_minimum=None), tmp_path / "s.journal")
    assert {record.care_minimum for record in exact} == {None}


def test_an_interrupted_search_goes_the_same_way(sets: PixelSets, recipe: Recipe, tmp_path: Path) -> None:
    whole = searched(sets, recipe, tmp_path / "whole.journal")
    lines = (tmp_path / "whole.journal").read_bytes().splitlines(keepends=True)
    (tmp_path / "part.journal").write_bytes(b"".join(lines[: 1 + 2 * 120]))
    assert searched(sets, recipe, tmp_path / "part.journal") == whole


def test_failed_trials_do_not_stop_the_search(sets: PixelSets, recipe: Recipe, tmp_path: Path) -> None:
    def failing(sets: PixelSets, trials: Iterable[Trial]) -> Iterator[list[Record]]:
        for number, records in enumerate(rewarding(sets, trials)):
            yield records if number % 3 else [replace(records[0], status="failed", accuracy=None)]

    assert len(searched(sets, recipe, tmp_path / "s.journal", failing)) == TRIALS


def test_the_extra_is_named_where_it_is_missing(
    sets: PixelSets, recipe: Recipe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "optuna", None)
    with (
        Results(tmp_path / "s.journal", {}, TRIALS, position) as results,
        pytest.raises(ExtraMissingError, match=r"wnn2hdl\[search\]"),
    ):
        search(sets, recipe, ((2, 3), (2, 3)), results, rewarding, lambda *_: None)
