"""From a design to its files."""

from pathlib import Path

import numpy as np
import pytest

from wnn2hdl.build.circuits import COUNTED, PARTS, emit, port_arrays
from wnn2hdl.build.design import Target
from wnn2hdl.build.planning import CompileOptions, plan
from wnn2hdl.ir import WisardModel


def silent(step: str, done: int, total: int) -> None:
    pass


@pytest.mark.parametrize(("target", "top"), [("edge", "edge_filter"), ("match", "bit_match")])
def test_each_target_has_its_verilog_testbench_and_vectors(
    model: WisardModel, tmp_path: Path, target: Target, top: str
) -> None:
    design = plan(model, CompileOptions(target=target), silent).design
    circuits = emit(design, tmp_path, sobel_threshold=128, options=["An option."])
    assert circuits.top == top
    assert circuits.verilog == tmp_path / f"{target}.v"
    text = circuits.verilog.read_text()
    assert text.startswith(
        f"// {top}: made by wnn2hdl from the model {design.model.digest()}.\n// An option."
    )
    assert f"module {top} (" in text
    assert f"module {top}_tb;" in (tmp_path / f"{top}_tb.v").read_text()
    assert (tmp_path / f"{top}_vectors.hex").stat().st_size > 0
    assert "module sobel (" in circuits.sobel.read_text()


def test_a_pixel_is_a_word_with_red_in_its_high_byte() -> None:
    words = port_arrays({"rgb": np.array([[1, 2, 3]], dtype=np.uint8), "reference": np.array([5])})
    assert words["rgb"].tolist() == [0x010203]
    assert words["reference"].tolist() == [5]


def test_all_that_is_counted_is_proved_by_itself_or_within_the_whole() -> None:
    for target, parts in PARTS.items():
        within = {"block", "match"} if "block_match" in parts else set()
        assert set(COUNTED[target]) <= set(parts) | within
