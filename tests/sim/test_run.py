"""The cocotb benches: they pass what equals the model, and fail on one wrong bit."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from sim.run import SimulatorName, run_bench
from wnn2hdl.ir import BitSelect, EdgeFilter, WisardModel, codes_to_bits
from wnn2hdl.verify.reference import reference_verilog
from wnn2hdl.verify.specification import Specification
from wnn2hdl.verify.vectors import stimulus

pytestmark = pytest.mark.simulator


@pytest.fixture(scope="module")
def specification() -> Specification:
    rng = np.random.default_rng(0)
    model = WisardModel(
        BitSelect(("R7", "R6", "G7", "G6", "B7")),
        ("forest", "deforested"),
        rng.integers(0, 5, (1, 4, 3)),
        rng.integers(0, 3, (2, 4, 8)),
        bleaching=2,
    )
    windows = codes_to_bits(np.arange(512), 9)
    return Specification.exact(model, EdgeFilter("boundary", windows[:, 4] & ~windows.all(axis=1)))


def written(specification: Specification, folder: Path, wrong: str = "") -> Path:
    """The reference under the name of the emitted block."""
    path = folder / "block.v"
    text = reference_verilog(specification).replace("module reference_block_match", "module block_match")
    path.write_text(text.replace("|class_4", f"|class_4{wrong}"), encoding="utf-8")
    return path


@pytest.mark.parametrize("simulator", ["icarus", pytest.param("verilator", marks=pytest.mark.slow)])
def test_directed_and_random_windows_agree_with_the_model(
    specification: Specification, tmp_path: Path, simulator: SimulatorName
) -> None:
    source = written(specification, tmp_path)
    samples = stimulus(specification, "block_match")
    vectors = run_bench(specification, "block_match", [source], samples, simulator, tmp_path / simulator)
    assert vectors == len(samples["reference"])


@pytest.mark.realdata
def test_windows_of_a_real_chip_agree_with_the_model(
    specification: Specification, realdata: Path, tmp_path: Path
) -> None:
    chip = sorted((realdata / "paper" / "chips").glob("*.jpg"))[0]
    pixels = np.asarray(Image.open(chip).convert("RGB"))
    rng = np.random.default_rng(0)
    corners = rng.integers(0, min(pixels.shape[:2]) - 3, (200, 2))
    windows = np.stack([pixels[y : y + 3, x : x + 3].reshape(9, 3) for y, x in corners])
    samples = {"window": windows, "reference": rng.integers(0, 512, 200)}
    source = written(specification, tmp_path)
    assert run_bench(specification, "block_match", [source], samples, "icarus", tmp_path / "icarus") == 200


@pytest.mark.parametrize("wrong", [" ^ window[0]", " | 1'bx"])
def test_a_wrong_or_undefined_output_fails(specification: Specification, tmp_path: Path, wrong: str) -> None:
    source = written(specification, tmp_path, wrong)
    samples = stimulus(specification, "block_match")
    with pytest.raises(AssertionError, match="differs from the model in icarus"):
        run_bench(specification, "block_match", [source], samples, "icarus", tmp_path / "icarus")
