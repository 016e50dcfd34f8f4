"""A compiled model: all files, proved, counted, or nothing."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from wnn2hdl.build.checking import Checked, check
from wnn2hdl.build.compile import Build, compile_model, require_luts
from wnn2hdl.build.design import Design
from wnn2hdl.build.emission import Files
from wnn2hdl.build.planning import CompileOptions
from wnn2hdl.errors import CheckError, InputError
from wnn2hdl.ir import WisardModel
from wnn2hdl.progress import Progress

pytestmark = pytest.mark.slow


def silent(step: str, done: int, total: int) -> None:
    pass


def test_a_build_holds_everything_and_says_what_it_costs(build: Path) -> None:
    assert {path.name for path in build.iterdir()} >= {
        "block.v",
        "block_block_match_tb.v",
        "block_block_match_vectors.hex",
        "design.json",
        "manifest.json",
        "model.json",
        "report.json",
        "report.md",
        "sobel.v",
        "xilinx_cells_sim.v",
    }
    report = json.loads((build / "report.json").read_text())
    assert report["proof"]["status"] == "proved"
    assert report["mode"] == "domain"
    parts = report["parts"]
    assert parts["match"]["luts"] == 10
    assert parts["match"]["carry4"] == 0
    assert parts["block"]["luts"] == 9 * parts["pixel"]["luts"] + parts["edge"]["luts"]
    assert parts["block"]["ffs"] == 0
    assert parts["sobel"]["luts"] > parts["pixel"]["luts"]
    assert 0.5 < report["accuracy"] <= 1
    assert 0 < report["care"]["coverage"] <= 1
    assert report["options"]["simulated_vectors"]["match"] == 2**18
    assert report["options"]["simulated_vectors"]["block_match"] >= 10_000


def test_the_same_inputs_give_the_same_bytes(
    pixel_build: Path, model: WisardModel, imagery: Path, tmp_path: Path
) -> None:
    options = CompileOptions(target="pixel", mode="domain", care=imagery)
    compile_model(model, tmp_path / "pixel", options, silent)
    for name in ("pixel.v", "pixel_pixel_tb.v", "pixel_pixel_vectors.hex", "design.json", "sobel.v"):
        assert (tmp_path / "pixel" / name).read_bytes() == (pixel_build / name).read_bytes()


@pytest.mark.parametrize("style", ["equations", "cells"])
def test_a_pixel_alone_in_both_styles(model: WisardModel, tmp_path: Path, style: str) -> None:
    options = CompileOptions(target="pixel", style=style)  # type: ignore[arg-type]
    reported: list[tuple[str, int]] = []
    built = compile_model(
        model, tmp_path / "pixel", options, lambda step, done, _: reported.append((step, done))
    )
    assert built.failure is None
    starts = [step for step, done in reported if done == 0]
    assert starts == [
        "minimising tables",
        "writing Verilog",
        "simulating, proving, counting",
    ]
    assert built.report["care"]["codes"] == 2**8
    text = (tmp_path / "pixel" / "pixel.v").read_text()
    assert ("DONT_TOUCH" in text) == (style == "cells")


def test_a_wrong_circuit_does_not_leave_unnoticed(
    model: WisardModel, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The emitted text is spoiled between writing and checking: one bit of one LUT.
    def spoil_then_check(design: Design, files: Files, progress: Progress, *, afresh: bool) -> Checked:
        path = files.verilog
        text = path.read_text()
        place = text.index("'h", text.index(".INIT")) + 2
        digit = format(int(text[place], 16) ^ 1, "x")
        path.write_text(text[:place] + digit + text[place + 1 :])
        return check(design, files, progress, afresh=afresh)

    monkeypatch.setattr("wnn2hdl.build.compile.check", spoil_then_check)
    built = compile_model(model, tmp_path / "pixel", CompileOptions(target="pixel"), silent)
    assert built.failure is not None
    assert "differs from the model" in built.failure
    assert (tmp_path / "pixel" / "FAILED").read_text() == built.failure + "\n"
    report = json.loads((tmp_path / "pixel" / "report.json").read_text())
    assert (report["proof"]["status"], report["proof"]["failure"]) == ("failed", built.failure)


def test_a_failing_compile_leaves_no_folder(model: WisardModel, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="--care"):
        compile_model(model, tmp_path / "block", CompileOptions(mode="domain"), silent)
    assert list(tmp_path.iterdir()) == []


def test_labels_of_other_classes_are_refused_before_the_work(
    model: WisardModel, tested: CompileOptions, tmp_path: Path
) -> None:
    steps: list[str] = []
    palette = tmp_path / "palette.json"
    palette.write_text('{"forest": "#000000", "burnt soil": "#ffffff"}')
    options = replace(tested, palette=palette)
    with pytest.raises(InputError, match="different classes: forest, deforested / forest, burnt soil"):
        compile_model(model, tmp_path / "block", options, lambda step, *_: steps.append(step))
    assert steps == []
    assert list(tmp_path.iterdir()) == [palette]


@pytest.mark.parametrize("target", ["edge", "match"])
def test_a_target_without_a_classifier_has_neither_accuracy_nor_codes(
    model: WisardModel, tested: CompileOptions, tmp_path: Path, target: str
) -> None:
    folder = tmp_path / target
    compile_model(model, folder, replace(tested, target=target), silent)
    report = json.loads((folder / "report.json").read_text())
    assert report["accuracy"] is report["model_accuracy"] is report["confusion"] is None
    assert report["evaluation"] is None
    assert set(report["care"].values()) == {None}
    tables = ["edge"] if target == "edge" else []
    assert list(report["minimised"]) == list(report["options"]["mapping"]) == tables
    assert report["edges"]["patterns"] == report["options"]["edge_patterns"] == (240 if tables else None)
    reported = (folder / "report.md").read_text() + (folder / "report.html").read_text()
    assert ("Edge patterns" in reported) == ("## Answers" in reported) == (target == "edge")
    for word in ("Accuracy of the circuit", "accuracy of the circuit", "odes cared for"):
        assert word not in reported


def test_a_pixel_alone_has_no_edge_filter(pixel_build: Path) -> None:
    report = json.loads((pixel_build / "report.json").read_text())
    assert list(report["minimised"]) == list(report["options"]["mapping"]) == ["pixel"]
    assert report["edges"]["name"] is None
    assert "Edge patterns" not in (pixel_build / "report.html").read_text()


def test_too_many_luts_fail() -> None:
    build = Build(Path("b"), {"target": "block", "parts": {"block": {"luts": 22}}}, None)
    require_luts(build, 22)
    with pytest.raises(CheckError, match="22, allowed are 21"):
        require_luts(build, 21)
