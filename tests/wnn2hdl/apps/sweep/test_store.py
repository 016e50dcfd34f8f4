import csv
from dataclasses import replace
from pathlib import Path

from wnn2hdl.apps.sweep.grid import Plan, grid
from wnn2hdl.apps.sweep.store import Results, write_table
from wnn2hdl.apps.sweep.trial import Record, failed


def record(plan: Plan, position: int, error: str = "x") -> Record:
    return failed(plan.trial(position), ValueError(error))


def opened(path: Path, plan: Plan) -> Results:
    return Results(path, {}, len(plan), plan.position)


def test_results_come_back_in_the_order_of_the_plan(tmp_path: Path, plan: Plan) -> None:
    with opened(tmp_path / "r.journal", plan) as results:
        results.append([record(plan, 7), record(plan, 2)])
        results.append([record(plan, 4)])
        assert list(results) == [record(plan, x) for x in (2, 4, 7)]
        assert list(results.missing()) == [x for x in range(18) if x not in (2, 4, 7)]
    with opened(tmp_path / "r.journal", plan) as results:
        assert list(results) == [record(plan, x) for x in (2, 4, 7)]
        assert len(results) == 3
        assert results.has("n2-k3-t2")
        assert results.get("n2-k3-t2") == record(plan, 2)


def test_the_first_result_of_a_trial_stays(tmp_path: Path, plan: Plan) -> None:
    with opened(tmp_path / "r.journal", plan) as results:
        results.append([record(plan, 1, "first"), record(plan, 1, "second")])
        results.append([record(plan, 1, "third")])
        assert [x.error for x in results] == ["ValueError: first"]


def test_a_wider_plan_goes_on_with_what_is_there(tmp_path: Path, plan: Plan) -> None:
    with opened(tmp_path / "r.journal", plan) as results:
        results.append([record(plan, 0)])
    wider = grid(plan.recipe, (2, 3, 4, 5), (2, 3, 6), trials=5)
    with opened(tmp_path / "r.journal", wider) as results:
        assert [x.name for x in results] == ["n2-k3-t0"]
        results.append([record(wider, 0)])
    with opened(tmp_path / "r.journal", plan) as results:
        assert [x.name for x in results] == ["n2-k3-t0"]


def test_results_of_other_settings_are_not_seen(tmp_path: Path, plan: Plan) -> None:
    with opened(tmp_path / "r.journal", plan) as results:
        results.append([record(plan, 0)])
    with Results(tmp_path / "r.journal", {"seed": 1}, len(plan), plan.position) as results:
        assert len(results) == 0


def test_the_table_has_a_row_a_trial(tmp_path: Path, plan: Plan) -> None:
    write_table([record(plan, 0), record(plan, 1)], tmp_path / "t.csv")
    lines = (tmp_path / "t.csv").read_text().splitlines()
    assert lines[0].startswith("name,address_bits,rams,seed,bits,care_minimum,status,")
    assert lines[1].startswith("n2-k3-t0,2,3,")
    assert lines[2].endswith(",ValueError: x")
    assert [x.name for x in tmp_path.iterdir()] == ["t.csv"]


def test_no_error_of_a_trial_is_a_formula_or_breaks_a_row(tmp_path: Path, plan: Plan) -> None:
    hostile = replace(record(plan, 0), error='=HYPERLINK("x")\n,"a"')
    write_table([hostile], tmp_path / "t.csv")
    rows = list(csv.reader((tmp_path / "t.csv").read_text().splitlines()))
    assert len(rows) == 2
    assert rows[1][-1] == '\'=HYPERLINK("x") ,"a"'
