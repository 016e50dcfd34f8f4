"""From a design to its files."""

from pathlib import Path

import pytest

from wnn2hdl.build.emission import emit, render
from wnn2hdl.build.planning import CompileOptions, plan
from wnn2hdl.errors import InputError
from wnn2hdl.ir import WisardModel


def silent(step: str, done: int, total: int) -> None:
    pass


@pytest.mark.parametrize("target", ["edge", "match"])
def test_each_target_has_its_verilog_testbench_and_vectors(
    model: WisardModel, tmp_path: Path, target: str
) -> None:
    design = plan(model, "mine", CompileOptions(target=target), silent).design
    files = emit(design, tmp_path, sobel_threshold=128)
    assert files.verilog == tmp_path / "mine.v"
    text = files.verilog.read_text()
    assert text.startswith(f"// mine_{target}: made by wnn2hdl from the model {design.model.digest()}.\n")
    assert f"module mine_{target} (" in text
    assert f"module mine_{target}_tb;" in files.testbench.read_text()
    assert files.vectors.stat().st_size > 0
    assert "module mine_sobel (" in files.sobel.read_text()
    assert "module LUT6 " in files.cells.read_text()


def test_the_models_of_cells_are_the_same_whatever_is_built(model: WisardModel) -> None:
    texts = [
        render(plan(model, name, CompileOptions(target="pixel"), silent).design, sobel_threshold=128)
        for name in ("one", "two")
    ]
    assert texts[0]["xilinx_cells_sim.v"] == texts[1]["xilinx_cells_sim.v"]
    assert "module LUT" not in texts[0]["one.v"]


def test_a_module_is_never_called_like_a_reserved_word(model: WisardModel) -> None:
    with pytest.raises(InputError, match="called like a reserved word: first_match; choose another --name"):
        plan(model, "first", CompileOptions(target="match"), silent)
