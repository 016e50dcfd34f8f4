"""A circuit is checked where it was written and where it was counted; emitted text: beside `compile`."""

import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest

from wnn2hdl.build import checking
from wnn2hdl.build.design import Design
from wnn2hdl.build.emission import Files, emit
from wnn2hdl.build.planning import CompileOptions, plan
from wnn2hdl.ir import WisardModel
from wnn2hdl.synth import Job, Synthesis, synthesise_all

pytestmark = pytest.mark.slow

Emitted = tuple[Design, Files]


def silent(step: str, done: int, total: int) -> None:
    pass


@pytest.fixture
def emitted(model: WisardModel, tmp_path: Path) -> Emitted:
    design = plan(model, "mine", CompileOptions(target="pixel"), silent).design
    return design, emit(design, tmp_path, sobel_threshold=128)


def spoiled(jobs: Mapping[str, Job]) -> dict[str, Synthesis]:
    """One bit of the first LUT of each netlist is not what synthesis made of it."""
    return {
        name: replace(made, netlist_verilog=flipped(made.netlist_verilog))
        for name, made in synthesise_all(jobs).items()
    }


def flipped(netlist: str) -> str:
    text = re.sub(
        r"'h([0-9a-f]+)",
        lambda digits: f"'h{int(digits[1], 16) ^ 1:0{len(digits[1])}x}",
        netlist,
        count=1,
    )
    assert text != netlist
    return text


def test_the_model_s_circuit_passes_and_all_is_timed(emitted: Emitted) -> None:
    checked = checking.check(*emitted, silent, afresh=True)
    assert (checked.status, checked.failure) == ("proved", None)
    assert set(checked.syntheses) == {"pixel", "sobel"}
    assert set(checked.seconds) == {"simulate", "prove", "synthesise"}
    assert checked.vectors == {"pixel": 256}


def test_a_netlist_that_is_not_its_verilog_is_found(
    emitted: Emitted, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(checking, "synthesise_all", spoiled)
    checked = checking.check(*emitted, silent, afresh=True)
    assert checked.status == "failed"
    assert checked.failure is not None
    assert checked.failure.startswith("the mapped netlist of the pixel differs from the model ")


@pytest.fixture
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("WNN2HDL_CACHE", str(tmp_path / "cache"))


@pytest.mark.usefixtures("own_cache")
def test_the_matcher_is_simulated_once_and_remembered(model: WisardModel, tmp_path: Path) -> None:
    design = plan(model, "mine", CompileOptions(target="match"), silent).design
    files = emit(design, tmp_path, sobel_threshold=128)
    first, second = (checking.check(design, files, silent, afresh=False) for _ in range(2))
    assert first.simulated_before == ()
    assert second.simulated_before == ("match",)
    assert first.vectors == second.vectors == {"match": 2**18}


@pytest.mark.usefixtures("own_cache")
def test_what_passed_is_not_done_again_unless_it_is_asked_for(
    emitted: Emitted, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = checking.check(*emitted, silent, afresh=False)
    assert (first.simulated_before, first.proved_before) == ((), ())
    refuse(monkeypatch)
    second = checking.check(*emitted, silent, afresh=False)
    assert (second.simulated_before, second.proved_before) == (("pixel",), ("pixel",))
    assert (second.vectors, second.status) == (first.vectors, "proved")
    with pytest.raises(AssertionError, match="done again"):
        checking.check(*emitted, silent, afresh=True)


@pytest.mark.usefixtures("own_cache")
def test_a_refutation_is_not_remembered(emitted: Emitted, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as spoiling:
        spoiling.setattr(checking, "synthesise_all", spoiled)
        for _ in range(2):
            checked = checking.check(*emitted, silent, afresh=False)
            assert checked.failure is not None
            assert checked.proved_before == ()
    assert checking.check(*emitted, silent, afresh=False).status == "proved"


@pytest.mark.usefixtures("own_cache")
def test_other_verilog_is_proved_although_the_former_was(emitted: Emitted) -> None:
    design, files = emitted
    assert checking.check(design, files, silent, afresh=False).status == "proved"
    files.verilog.write_text(flipped(files.verilog.read_text()))
    checked = checking.check(design, files, silent, afresh=False)
    assert checked.failure is not None
    assert checked.failure.startswith("the Verilog of the pixel differs from the model ")
    assert checked.proved_before == ()


def refuse(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let proofs and simulations fail the test."""

    def again(*arguments: object) -> None:
        raise AssertionError("done again")

    for name in ("prove", "prove_netlists", "simulate_parts"):
        monkeypatch.setattr(checking, name, again)
