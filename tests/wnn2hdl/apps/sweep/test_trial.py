from dataclasses import replace

import numpy as np
import pytest

from wnn2hdl.apps.sweep import trial as trials
from wnn2hdl.apps.sweep.grid import Plan, Recipe
from wnn2hdl.apps.sweep.pixels import PixelSets, code_counts
from wnn2hdl.apps.sweep.trial import Record, answers_digest, rebuild, run_trial, table_and_network
from wnn2hdl.lower.table import pixel_table
from wnn2hdl.wisard import PixelClassifier


def test_a_record_holds_what_the_rebuilt_model_and_circuit_do(sets: PixelSets, recipe: Recipe) -> None:
    trial = recipe.trial((4, 16), 2)
    record = run_trial(sets, trial)
    model = rebuild(sets, trial)
    held_out = code_counts(sets, recipe.bits).held_out
    answers = PixelClassifier(model).table
    right = sum(int(held_out[label, answers == label].sum()) for label in range(2))
    assert record.status == "valid"
    assert record.accuracy == right / held_out.sum()
    assert record.bleaching == model.bleaching
    assert record.answers == answers_digest(pixel_table(model))
    assert 0.5 < right / held_out.sum() <= 1

    table, network = table_and_network(sets, trial)
    assert (record.luts, record.muxes) == (len(network.luts), len(network.muxes))
    circuit = network.evaluate(np.arange(len(answers)))[:, 0]
    right = sum(int(held_out[label, circuit == bool(label)].sum()) for label in range(2))
    assert record.circuit_accuracy == right / held_out.sum()
    assert (circuit == answers.astype(bool))[table.care].all()
    assert not table.care.all()
    # What is not cared for is the same in all tables: those that agree on the rest share a circuit.
    assert not table.values[~table.care].any()
    assert answers[~table.care].any()


def test_in_exact_mode_the_circuit_is_the_classifier(sets: PixelSets, recipe: Recipe) -> None:
    record = run_trial(sets, replace(recipe, care_minimum=None).trial((2, 6), 0))
    assert record.circuit_accuracy == record.accuracy


def test_equal_trials_are_equal_in_every_process_state(sets: PixelSets, recipe: Recipe) -> None:
    trial = recipe.trial((3, 8), 1)
    first = run_trial(sets, trial)
    trials._mapped.cache_clear()
    code_counts.cache_clear()
    assert run_trial(sets, trial) == first


def test_equal_tables_are_mapped_once(sets: PixelSets, recipe: Recipe) -> None:
    trials._mapped.cache_clear()
    run_trial(sets, recipe.trial((3, 8), 1))
    run_trial(sets, replace(recipe.trial((3, 8), 1), name="n3-k8-t9"))
    assert trials._mapped.cache_info().misses == 1


def test_saturated_trials_are_marked(sets: PixelSets, recipe: Recipe) -> None:
    # Four addresses and a threshold of one occurrence: every RAM says yes to everything.
    record = run_trial(sets, replace(recipe, bleaching=1).trial((2, 20), 0))
    assert record.status == "saturated"
    assert record.saturation is not None
    assert record.saturation > 0.9


def test_a_failing_trial_is_recorded_with_its_error(
    sets: PixelSets, recipe: Recipe, monkeypatch: pytest.MonkeyPatch
) -> None:
    record = run_trial(sets, replace(recipe, bits=("R7", "G7", "B7")).trial((4, 2), 0))
    assert record.status == "failed"
    assert record.accuracy is None
    assert record.error.startswith("a RAM has more address bits than the network has input bits: 4 of 3;")

    def broken(*_: object) -> None:
        raise ZeroDivisionError("a defect\nsomewhere")

    monkeypatch.setattr(trials, "draw_mapping", broken)
    assert run_trial(sets, recipe.trial((4, 2), 0)).error == "ZeroDivisionError: a defect somewhere"


def test_records_survive_json(sets: PixelSets, plan: Plan) -> None:
    for record in (run_trial(sets, plan.trial(0)), trials.failed(plan.trial(1), ValueError("no"))):
        assert Record.from_json(record.to_json()) == record


def test_three_classes_have_a_circuit_of_two_outputs(sets: PixelSets, recipe: Recipe) -> None:
    # A third class made of some of the second's colours, so that no data of three classes are needed.
    sample, held_out = sets.sample.copy(), np.vstack([sets.held_out, sets.held_out[2] // 2])
    sample[2, (sample[2] == 1) & (sample[0] % 2 == 1)] = 2
    held_out[2] -= held_out[3]
    three = replace(
        sets, classes=("forest", "field", "road"), digest="three", sample=sample, held_out=held_out
    )
    record = run_trial(three, recipe.trial((4, 8), 0))
    assert record.status == "valid", record.error
    assert len(table_and_network(three, recipe.trial((4, 8), 0))[1].outputs) == 2
