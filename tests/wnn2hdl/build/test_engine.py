"""Match engines: compiled, proved, and the emitted Verilog in a simulator."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from wnn2hdl.build.compile import compile_model
from wnn2hdl.build.placing import place_build
from wnn2hdl.build.planning import CompileOptions, plan
from wnn2hdl.build.verification import open_build, verify_build
from wnn2hdl.errors import InputError, ToolError
from wnn2hdl.ir import WisardModel
from wnn2hdl.tools import run_icarus

OPTIONS = CompileOptions(
    target="engine", template=(6, 8), segment=(14, 20), clock=100.0, frames_per_second=150_000
)


def silent(step: str, done: int, total: int) -> None:
    pass


@pytest.fixture(scope="module")
def engine(model: WisardModel, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("builds") / "found"
    assert compile_model(model, folder, OPTIONS, silent).failure is None
    return folder


def test_lanes_are_proved_and_the_engine_around_them_is_counted(engine: Path) -> None:
    design, _, report = open_build(engine)
    assert list(report["parts"]) == ["agreement", "lane", "engine", "ip", "sobel"]
    assert report["proof"]["status"] == "proved"
    assert "simulated" in report["proof"]["method"]
    assert design.engine is not None
    assert report["latency"] == design.engine.cycles(design.top.latency) <= 100e6 / 150_000
    assert report["parts"]["engine"]["bram36"] > 0


def test_a_build_of_an_engine_passes_its_checks_again(engine: Path) -> None:
    problems, checked = verify_build(engine, silent)
    assert not problems
    assert checked is not None
    assert checked.vectors["engine"] == 3


def test_an_engine_is_not_placed_on_other_fpgas(engine: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="match engines are not placed"):
        place_build(engine, "ecp5-25k", tmp_path / "bitstream", None, silent)
    assert not (tmp_path / "bitstream").exists()


@pytest.mark.simulator
def test_the_testbench_passes_and_finds_scores_that_are_not_the_best(engine: Path, tmp_path: Path) -> None:
    _, files, _ = open_build(engine)
    (tmp_path / files.vectors.name).write_text(files.vectors.read_text())
    top = files.testbench.stem
    sources = [files.cells, files.verilog, files.testbench]
    assert "PASS" in run_icarus(sources, top, cwd=tmp_path, timeout=120).output
    text = files.verilog.read_text()
    wrong = text.replace("count_0};", "~count_0};")
    assert wrong != text
    (tmp_path / "wrong.v").write_text(wrong)
    with pytest.raises(ToolError) as failed:
        run_icarus([files.cells, tmp_path / "wrong.v", files.testbench], top, cwd=tmp_path, timeout=120)
    assert "FAIL" in failed.value.output


def test_a_rate_of_next_to_nothing_is_met(model: WisardModel) -> None:
    engine = plan(model, "x", replace(OPTIONS, frames_per_second=1e-305), silent).design.engine
    assert engine is not None
    assert engine.lanes == 1


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"segment": None}, "--segment missing"),
        ({"frames_per_second": 1e9}, "at least"),
        ({"template": (20, 20)}, "does not move"),
        ({"mode": "domain"}, "--mode domain"),
    ],
)
def test_an_engine_that_cannot_be_is_refused(
    model: WisardModel, imagery: Path, changed: dict[str, Any], message: str
) -> None:
    options = CompileOptions(**{**vars(OPTIONS), "care": imagery, **changed})
    with pytest.raises(InputError) as refused:
        plan(model, "x", options, silent)
    assert message in refused.value.line()
