"""From a model and the user's choices to a design."""

import json
from pathlib import Path

import numpy as np
import pytest

from wnn2hdl.build.design import Design
from wnn2hdl.build.planning import CompileOptions, plan
from wnn2hdl.errors import InputError
from wnn2hdl.ir import EdgeFilter, WisardModel
from wnn2hdl.verify.specification import Specification


def silent(step: str, done: int, total: int) -> None:
    pass


def edge_filter(design: Design) -> EdgeFilter:
    assert isinstance(design.specification, Specification)
    return design.specification.edge_filter


def test_exact_mode_cares_for_every_code(model: WisardModel) -> None:
    specification = plan(model, CompileOptions(), silent).design.specification
    assert isinstance(specification, Specification)
    assert specification.care.all()
    assert specification.window_care.all()
    assert specification.edge_filter.name == "boundary"


def test_domain_mode_cares_for_what_occurs_often_enough(model: WisardModel, imagery: Path) -> None:
    cared = [
        plan(
            model, CompileOptions(mode="domain", care=imagery, care_minimum=minimum), silent
        ).design.specification
        for minimum in (1, 50)
    ]
    assert 0 < cared[1].care.sum() < cared[0].care.sum() < 2**8
    assert (cared[1].care <= cared[0].care).all()


def test_the_networks_equal_the_model_where_it_is_cared_for(model: WisardModel, imagery: Path) -> None:
    planned = plan(model, CompileOptions(mode="domain", care=imagery), silent)
    specification = planned.design.specification
    answers = planned.design.decision.evaluate(np.arange(2**8))[:, 0]
    assert np.array_equal(answers[specification.care], model.evaluate_all_codes()[specification.care] != 0)
    assert len(planned.covers["pixel"].cover.cubes) <= planned.covers["pixel"].cubes_before
    assert planned.agreement is not None
    assert planned.agreement.f1 is not None


def test_edges_from_a_file_or_learned(model: WisardModel, imagery: Path, tmp_path: Path) -> None:
    path = tmp_path / "edges.json"
    path.write_text(json.dumps([16, 17]))
    design = plan(model, CompileOptions(edges=str(path)), silent).design
    assert np.flatnonzero(edge_filter(design).patterns).tolist() == [16, 17]
    options = CompileOptions(edges="learned", edge_images=imagery, edge_patterns=12)
    assert edge_filter(plan(model, options, silent).design).size == 12


def test_a_learned_filter_can_be_held_to_few_luts(model: WisardModel, imagery: Path) -> None:
    options = CompileOptions(edges="learned", edge_images=imagery, edge_luts=2, edge_patterns=75)
    design = plan(model, options, silent).design
    assert edge_filter(design).size == 75
    assert len(design.networks["edge"].luts) <= 2


def test_missing_imagery_is_asked_for(model: WisardModel) -> None:
    with pytest.raises(InputError, match="--care"):
        plan(model, CompileOptions(mode="domain"), silent)
    with pytest.raises(InputError, match="--edge-images"):
        plan(model, CompileOptions(edges="learned"), silent)
