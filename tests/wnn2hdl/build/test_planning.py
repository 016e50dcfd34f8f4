"""From a model and the user's choices to a design."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.build.design import Design
from wnn2hdl.build.planning import CompileOptions, plan
from wnn2hdl.errors import InputError
from wnn2hdl.ir import EdgeFilter, WisardModel
from wnn2hdl.verify.specify import care_sets


def silent(step: str, done: int, total: int) -> None:
    pass


def edge_filter(design: Design) -> EdgeFilter:
    assert design.edges is not None
    return design.edges


def cared_codes(design: Design) -> NDArray[np.bool_]:
    assert design.care is not None
    return design.care.project(tuple(range(design.care.width)))


def test_exact_mode_cares_for_every_code(model: WisardModel) -> None:
    design = plan(model, "mine", CompileOptions(), silent).design
    assert {care.kind for care in care_sets(design.circuit).values()} == {"everything"}
    assert edge_filter(design).name == "boundary"


def test_a_pixel_alone_needs_no_edges(model: WisardModel) -> None:
    options = CompileOptions(target="pixel", edges="learned")
    assert plan(model, "mine", options, silent).design.edges is None


def test_domain_mode_cares_for_what_occurs_often_enough(model: WisardModel, imagery: Path) -> None:
    options = [CompileOptions(mode="domain", care=imagery, care_minimum=least) for least in (1, 50)]
    cared = [cared_codes(plan(model, "mine", chosen, silent).design) for chosen in options]
    assert 0 < cared[1].sum() < cared[0].sum() < 2**8
    assert (cared[1] <= cared[0]).all()


def test_the_networks_equal_the_model_where_it_is_cared_for(model: WisardModel, imagery: Path) -> None:
    planned = plan(model, "mine", CompileOptions(mode="domain", care=imagery), silent)
    care = cared_codes(planned.design)
    answers = planned.design.networks["pixel"].evaluate(np.arange(2**8))[:, 0]
    assert np.array_equal(answers[care], model.evaluate_all_codes()[care] != 0)
    assert len(planned.covers["pixel"].cover.cubes) <= planned.covers["pixel"].cubes_before
    assert planned.agreement is not None
    assert planned.agreement.f1 is not None


def test_edges_from_a_file_or_learned(model: WisardModel, imagery: Path, tmp_path: Path) -> None:
    path = tmp_path / "edges.json"
    path.write_text(json.dumps([16, 17]))
    design = plan(model, "mine", CompileOptions(edges=str(path)), silent).design
    assert np.flatnonzero(edge_filter(design).patterns).tolist() == [16, 17]
    options = CompileOptions(edges="learned", edge_images=imagery, edge_patterns=12)
    assert edge_filter(plan(model, "mine", options, silent).design).size == 12


def test_a_learned_filter_can_be_held_to_few_luts(model: WisardModel, imagery: Path) -> None:
    options = CompileOptions(edges="learned", edge_images=imagery, edge_luts=2, edge_patterns=75)
    design = plan(model, "mine", options, silent).design
    assert edge_filter(design).size == 75
    assert len(design.networks["edge"].luts) <= 2


def test_missing_imagery_is_asked_for(model: WisardModel) -> None:
    with pytest.raises(InputError, match="--care"):
        plan(model, "mine", CompileOptions(mode="domain"), silent)
    with pytest.raises(InputError, match="--edge-images"):
        plan(model, "mine", CompileOptions(edges="learned"), silent)


def test_a_pipeline_has_the_stages_that_are_asked_for(model: WisardModel) -> None:
    design = plan(model, "mine", CompileOptions(stages=2), silent).design
    assert (design.circuit.latency, design.top.latency) == (0, 2)
    assert design.header[2] == (
        "A pipeline of latency 2 cycles that takes a new input in each; its outputs are registers."
    )
    assert plan(model, "mine", CompileOptions(clock=1), silent).design.top.latency == 1


def test_stages_and_clock_exclude_each_other_and_a_clock_can_be_too_fast(model: WisardModel) -> None:
    with pytest.raises(InputError, match="the number of stages and the clock decide the same"):
        plan(model, "mine", CompileOptions(stages=2, clock=100), silent)
    with pytest.raises(InputError, match="no number of stages meets the clock: 1000 MHz, 1000 ps"):
        plan(model, "mine", CompileOptions(clock=1000), silent)
