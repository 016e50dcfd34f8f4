"""A design in its files: whole, or refused in one line."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from wnn2hdl.build.design import Design
from wnn2hdl.errors import ModelFileError
from wnn2hdl.ir import LutNetwork, TruthTable
from wnn2hdl.lower.targets import Ingredients
from wnn2hdl.verify.specify import care_sets

pytestmark = pytest.mark.slow


def test_a_design_survives_its_file(build: Path, tmp_path: Path) -> None:
    design = Design.load(build)
    design.save(tmp_path)
    for name in ("design.json", "model.json"):
        assert (tmp_path / name).read_bytes() == (build / name).read_bytes()
    assert all(isinstance(network, LutNetwork) for network in design.networks.values())


def test_each_network_is_its_table_where_that_is_cared_for(build: Path) -> None:
    design = Design.load(build)
    lowered = design.target.lower(Ingredients(design.model, design.edges, care_sets(design.circuit)))
    for name, node in lowered.tables().items():
        table = node.function
        assert isinstance(table, TruthTable)
        codes = np.flatnonzero(table.care)
        assert 0 < codes.size < table.care.size, "a build in domain mode leaves codes out"
        answers = design.networks[name].evaluate(codes)
        np.testing.assert_array_equal(answers, table.values[codes])


def lost(data: dict[str, Any]) -> None:
    del data["circuit"]


def beyond(data: dict[str, Any]) -> None:
    data["circuit"][0]["care"][0]["codes"].append(1 << 20)


def twisted(data: dict[str, Any]) -> None:
    data["circuit"][0]["nodes"][0]["network"] = "a network"


def unknown(data: dict[str, Any]) -> None:
    data["circuit"][-1]["name"] = "sobel"


def aimed(data: dict[str, Any]) -> None:
    data["target"] = "neighbourhood"


def exact(data: dict[str, Any]) -> None:
    data["mode"] = "exact"


def commented(data: dict[str, Any]) -> None:
    data["header"].append("a comment\nmodule LUT6; endmodule")


def newer(data: dict[str, Any]) -> None:
    data["version"] = 99


def foreign(data: dict[str, Any]) -> None:
    data["model_sha256"] = "0" * 64


@pytest.mark.parametrize(
    ("damage", "fault"),
    [
        (lost, "the design is damaged"),
        (beyond, "the design is damaged"),
        (twisted, "the design is damaged"),
        (aimed, "the model cannot be the target neighbourhood"),
        (unknown, "nothing is known about the circuits .*sobel"),
        (exact, "pixel has don't-cares in exact mode"),
        (commented, "is not a line of a comment"),
        (newer, "not a design of this wnn2hdl"),
        (foreign, "the design was made from another model"),
    ],
)
def test_a_damaged_file_is_refused(
    pixel_build: Path, tmp_path: Path, damage: Callable[[dict[str, Any]], None], fault: str
) -> None:
    folder = Path(shutil.copytree(pixel_build, tmp_path / "copy"))
    path = folder / "design.json"
    data = json.loads(path.read_text())
    damage(data)
    path.write_text(json.dumps(data))
    with pytest.raises(ModelFileError, match=fault):
        Design.load(folder)
