"""A circuit is checked where it was written and where it was counted; emitted text: beside `compile`."""

import re
from dataclasses import replace
from pathlib import Path

import pytest

from wnn2hdl.build import checking
from wnn2hdl.build.circuits import Circuits, emit
from wnn2hdl.build.design import Design
from wnn2hdl.build.planning import CompileOptions, plan
from wnn2hdl.ir import WisardModel
from wnn2hdl.synth import Job, Synthesis, synthesise_job

pytestmark = pytest.mark.slow

Emitted = tuple[Design, Circuits]


def silent(step: str, done: int, total: int) -> None:
    pass


@pytest.fixture
def emitted(model: WisardModel, tmp_path: Path) -> Emitted:
    design = plan(model, CompileOptions(target="pixel"), silent).design
    design.save(tmp_path)
    return design, emit(design, tmp_path, sobel_threshold=128, options=[])


def spoiled(job: Job) -> Synthesis:
    """One bit of the first LUT of the netlist is not what synthesis made of it."""
    made = synthesise_job(job)
    text = re.sub(
        r"'h([0-9a-f]+)",
        lambda digits: f"'h{int(digits[1], 16) ^ 1:0{len(digits[1])}x}",
        made.netlist_verilog,
        count=1,
    )
    assert text != made.netlist_verilog
    return replace(made, netlist_verilog=text)


def test_the_model_s_circuit_passes_and_all_is_timed(emitted: Emitted) -> None:
    checked = checking.check(*emitted, silent)
    assert (checked.status, checked.failure) == ("proved", None)
    assert set(checked.syntheses) == {"pixel", "sobel"}
    assert set(checked.seconds) == {"simulate pixel", "prove", "pixel", "sobel"}
    assert checked.vectors == {"pixel": 256}


def test_a_netlist_that_is_not_its_verilog_is_found(
    emitted: Emitted, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(checking, "synthesise_job", spoiled)
    checked = checking.check(*emitted, silent)
    assert checked.status == "failed"
    assert checked.failure is not None
    assert checked.failure.startswith("the mapped netlist of the pixel differs from the model ")
