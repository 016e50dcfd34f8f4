"""Gate networks from model to checked build, and what is refused."""

from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from benchmarks.gates import multiplier
from wnn2hdl.build import planning, simulating
from wnn2hdl.build.capacity import require_capacity
from wnn2hdl.build.compile import compile_model
from wnn2hdl.build.planning import CompileOptions
from wnn2hdl.build.verification import verify_build
from wnn2hdl.errors import InputError
from wnn2hdl.ir.models import LogicModel
from wnn2hdl.ir.wires import word_values
from wnn2hdl.synth import XC7Z020


def silent(step: str, done: int, total: int) -> None:
    pass


def test_the_network_used_here_multiplies() -> None:
    answers = multiplier(4).evaluate([[n >> place & 1 for place in range(8)] for n in range(256)])
    assert word_values(answers) == [(n & 15) * (n >> 4) for n in range(256)]


def test_a_multiplier_compiles_proved_and_is_verified_again(tmp_path: Path) -> None:
    build = compile_model(multiplier(4), tmp_path / "product", CompileOptions(), silent)
    report = build.report
    assert build.failure is None
    assert report["proof"]["status"] == "proved"
    assert report["options"]["simulated_vectors"] == {"network": 256}
    assert 8 <= report["parts"]["network"]["luts"] <= 20
    assert (report["latency"], report["parts"]["network"]["ffs"]) == (0, 0)
    problems, checked = verify_build(build.folder, silent)
    assert not problems
    assert checked is not None
    assert checked.status == "proved"


def test_a_pipeline_of_gates_is_proved_with_its_registers(tmp_path: Path) -> None:
    options = CompileOptions(stages=2, style="equations", effort=0)
    build = compile_model(multiplier(3), tmp_path / "product", options, silent)
    assert build.report["proof"]["status"] == "proved"
    assert build.report["latency"] == 2
    assert build.report["parts"]["network"]["ffs"] > 0


def test_what_is_too_large_to_simulate_is_said_to_be_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(simulating, "_MOST_CELLS", 3)
    build = compile_model(multiplier(3), tmp_path / "product", CompileOptions(effort=0), silent)
    assert build.report["proof"]["status"] == "proved"
    assert build.report["proof"]["method"].endswith(
        "too large to be simulated, so evaluated on samples instead"
    )
    assert build.report["options"]["simulated_vectors"] == {}


def test_a_network_that_cannot_fit_is_refused_before_synthesis(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    small = replace(XC7Z020, name="small", luts=3)
    monkeypatch.setattr(planning, "require_capacity", partial(require_capacity, device=small))
    with pytest.raises(InputError, match=r"more LUTs than the device has: about \d+ of the 3 of an small"):
        compile_model(multiplier(3), tmp_path / "product", CompileOptions(), silent)
    assert not (tmp_path / "product").exists()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (CompileOptions(mode="domain"), "domain mode is for models of pictures"),
        (CompileOptions(target="pixel"), "the model reads bits"),
        (CompileOptions(input="Q3.12"), "the model reads no numbers"),
        (CompileOptions(prune=True), "prune"),
    ],
)
def test_options_that_make_no_sense_for_gates_are_refused(
    options: CompileOptions, message: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=message):
        compile_model(multiplier(2), tmp_path / "product", options, silent)


def test_wires_and_constants_compile_without_a_table(tmp_path: Path) -> None:
    """An input, its inverse, both constants, and an input that nothing reads."""
    literals = np.array([2, 3, 0, 1, 2], dtype=np.uint32)
    none = np.zeros((0, 2), dtype=np.uint32)
    model = LogicModel(("a", "b"), tuple("uvwxy"), none, literals)
    build = compile_model(model, tmp_path / "wires", CompileOptions(effort=0), silent)
    assert build.report["proof"]["status"] == "proved"
    assert build.report["parts"]["network"]["luts"] <= 1
