"""What a build says about itself is derived from it, and nothing that users name reaches the Verilog."""

import json
import re
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from wnn2hdl.build.design import Design
from wnn2hdl.build.emission import render
from wnn2hdl.build.planning import CompileOptions, plan
from wnn2hdl.build.statements import false_statements, foreign_circuit, foreign_files, foreign_text
from wnn2hdl.errors import InputError
from wnn2hdl.ir import WisardModel

HOSTILE = ["a'b\"c", "x\nmodule y; endmodule", "*/ synthesis translate_off", "</script>", "|=", "x" * 5000]


def silent(step: str, done: int, total: int) -> None:
    """No progress is shown."""


def verilog(model: WisardModel, options: CompileOptions) -> dict[str, str]:
    """The emitted files of a model, without its digest, which covers the names of classes."""
    files = render(plan(model, "m", options, silent).design, sobel_threshold=128)
    return {name: re.sub(r"\b[0-9a-f]{64}\b", "", text) for name, text in files.items()}


def test_names_of_classes_reach_no_emitted_file(model: WisardModel) -> None:
    options = CompileOptions(target="pixel", effort=0)
    named = [replace(model, classes=(name, f"{name}2")) for name in HOSTILE]
    plain = verilog(model, options)
    assert all(verilog(other, options) == plain for other in named)


def test_names_of_files_of_edge_patterns_reach_no_emitted_file(model: WisardModel, tmp_path: Path) -> None:
    texts = []
    for name in ("plain", "synthesis translate_off", "x\nmodule y; endmodule", "*)", "é\u2028"):
        path = tmp_path / f"{name}.json"
        path.write_text("[16, 56]")
        texts.append(verilog(model, CompileOptions(target="edge", effort=0, edges=str(path))))
    assert all(text == texts[0] for text in texts)


def test_a_file_of_edge_patterns_cannot_pose_as_a_rule(model: WisardModel, tmp_path: Path) -> None:
    path = tmp_path / "boundary.json"
    path.write_text("[16]")
    with pytest.raises(InputError, match="called like a rule: boundary"):
        plan(model, "m", CompileOptions(target="edge", edges=str(path)), silent)


@pytest.mark.parametrize("name", ["sobel", "Sobel", "xilinx_cells_sim"])
def test_a_design_cannot_be_called_like_another_file_of_a_build(model: WisardModel, name: str) -> None:
    design = plan(model, name, CompileOptions(target="pixel", effort=0), silent).design
    with pytest.raises(InputError, match="every build has a file of this name"):
        render(design, sobel_threshold=128)


@pytest.mark.slow
def test_nothing_of_a_build_is_foreign_to_it(pixel_build: Path) -> None:
    design = Design.load(pixel_build)
    report = json.loads((pixel_build / "report.json").read_text())
    assert foreign_files(design, pixel_build) == []
    assert foreign_circuit(design) == []
    assert foreign_text(design, report, pixel_build) == []
    contradictions = false_statements(design, report, {}, {"status": "proved"})
    assert contradictions == [
        f"report.json has parts.{part}, which is not a part of the build" for part in report["parts"]
    ]


@pytest.mark.slow
def test_sources_in_folders_of_a_build_are_foreign_too(pixel_build: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(pixel_build, tmp_path / "copy"))
    (folder / "lib").mkdir()
    (folder / "lib" / "LUT6.V").touch()
    (folder / "notes.txt").touch()
    (said,) = foreign_files(Design.load(folder), folder)
    assert said.endswith("is a source that the compiler does not write")
