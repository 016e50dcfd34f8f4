from pathlib import Path

import pytest

from wnn2hdl.apps.sweep.grid import Plan, grid
from wnn2hdl.apps.sweep.store import Results, write_table
from wnn2hdl.apps.sweep.trial import Record, failed
from wnn2hdl.errors import InputError


def record(plan: Plan, position: int, error: str = "x") -> Record:
    return failed(plan.trial(position), ValueError(error))


def opened(path: Path, plan: Plan) -> Results:
    return Results(path, len(plan), plan.position)


def test_results_come_back_in_the_order_of_the_plan(tmp_path: Path, plan: Plan) -> None:
    with opened(tmp_path / "r.jsonl", plan) as results:
        results.append([record(plan, 7), record(plan, 2)])
        results.append([record(plan, 4)])
        assert list(results) == [record(plan, x) for x in (2, 4, 7)]
        assert list(results.missing()) == [x for x in range(18) if x not in (2, 4, 7)]
    with opened(tmp_path / "r.jsonl", plan) as results:
        assert list(results) == [record(plan, x) for x in (2, 4, 7)]
        assert len(results) == 3
        assert results.has("n2-k3-t2")
        assert results.get("n2-k3-t2") == record(plan, 2)


def test_a_torn_line_is_dropped_wherever_it_was_cut(tmp_path: Path, plan: Plan) -> None:
    whole = tmp_path / "whole.jsonl"
    with opened(whole, plan) as results:
        results.append([record(plan, x) for x in range(3)])
    content = whole.read_bytes()
    second = content.index(b"\n") + 1
    third = content.index(b"\n", second) + 1
    for cut in range(third, len(content)):
        path = tmp_path / "torn.jsonl"
        path.write_bytes(content[:cut])
        with opened(path, plan) as results:
            assert len(results) == 2
            results.append([record(plan, 2)])
        assert path.read_bytes() == content


def test_damage_in_the_middle_costs_only_what_follows(tmp_path: Path, plan: Plan) -> None:
    path = tmp_path / "r.jsonl"
    with opened(path, plan) as results:
        results.append([record(plan, x) for x in range(3)])
    lines = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(lines[0] + b"\x00" * 40 + b"\n" + lines[2])
    with opened(path, plan) as results:
        assert list(results) == [record(plan, 0)]
    assert path.read_bytes() == lines[0]


def test_the_first_result_of_a_trial_stays(tmp_path: Path, plan: Plan) -> None:
    with opened(tmp_path / "r.jsonl", plan) as results:
        results.append([record(plan, 1, "first"), record(plan, 1, "second")])
        results.append([record(plan, 1, "third")])
        assert [x.error for x in results] == ["ValueError: first"]


def test_a_wider_plan_goes_on_with_what_is_there(tmp_path: Path, plan: Plan) -> None:
    with opened(tmp_path / "r.jsonl", plan) as results:
        results.append([record(plan, 0)])
    wider = grid(plan.recipe, (2, 3, 4, 5), (2, 3, 6), trials=5)
    with opened(tmp_path / "r.jsonl", wider) as results:
        assert [x.name for x in results] == ["n2-k3-t0"]
        results.append([record(wider, 0)])
    with opened(tmp_path / "r.jsonl", plan) as results:
        assert [x.name for x in results] == ["n2-k3-t0"]


def test_a_second_writer_is_refused(tmp_path: Path, plan: Plan) -> None:
    with (
        opened(tmp_path / "r.jsonl", plan),
        pytest.raises(InputError, match="another sweep is writing to the same folder"),
    ):
        opened(tmp_path / "r.jsonl", plan)
    opened(tmp_path / "r.jsonl", plan).__exit__(None, None, None)


def test_a_missing_folder_is_refused(tmp_path: Path, plan: Plan) -> None:
    with pytest.raises(InputError, match="cannot write the sweep"):
        opened(tmp_path / "none" / "r.jsonl", plan)


def test_the_table_has_a_row_a_trial(tmp_path: Path, plan: Plan) -> None:
    write_table([record(plan, 0), record(plan, 1)], tmp_path / "t.csv")
    lines = (tmp_path / "t.csv").read_text().splitlines()
    assert lines[0].startswith("name,address_bits,rams,seed,bits,care_minimum,status,")
    assert lines[1].startswith("n2-k3-t0,2,3,")
    assert lines[2].endswith(",ValueError: x")
    assert [x.name for x in tmp_path.iterdir()] == ["t.csv"]
