"""The cocotb benches: they pass what equals the model, and fail on one wrong bit."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from sim.run import SimulatorName, run_bench
from wnn2hdl.ir import BitSelect, EdgeFilter, WisardModel, codes_to_bits
from wnn2hdl.ir.care import Codes
from wnn2hdl.ir.pixels import pixel_bits
from wnn2hdl.verify.specification import Specification
from wnn2hdl.verify.specify import specify

pytestmark = pytest.mark.simulator

MODEL = WisardModel(
    BitSelect(("R7", "R6", "G7", "G6", "B7")),
    ("forest", "deforested"),
    np.random.default_rng(0).integers(0, 5, (1, 4, 3)),
    np.random.default_rng(1).integers(0, 3, (2, 4, 8)),
    bleaching=2,
)
WINDOWS = codes_to_bits(np.arange(512), 9)
EDGES = EdgeFilter("boundary", WINDOWS[:, 4] & ~WINDOWS.all(axis=1))
MODULE = "block_match"


@pytest.fixture(scope="module")
def specification() -> Specification:
    return specify(MODEL, EDGES, {})


def written(specification: Specification, folder: Path, wrong: str = "") -> Path:
    """The reference under the name of the emitted block."""
    path = folder / "block.v"
    text = specification.reference.replace("module proof__block_match", f"module {MODULE}")
    changed = text.replace("|class_4", f"|class_4{wrong}")
    assert not wrong or changed != text
    path.write_text(changed, encoding="utf-8")
    return path


@pytest.mark.parametrize("simulator", ["icarus", pytest.param("verilator", marks=pytest.mark.slow)])
def test_directed_and_random_windows_agree_with_the_model(
    specification: Specification, tmp_path: Path, simulator: SimulatorName
) -> None:
    claim = specification.claims["block_match"]
    assert claim.stimulus is not None
    samples = {port: bits[:2000] for port, bits in claim.stimulus().items()}
    source = written(specification, tmp_path)
    assert run_bench(claim, MODULE, [source], samples, simulator, tmp_path / simulator) == 2000


def test_samples_outside_the_care_set_are_moved_into_it(specification: Specification, tmp_path: Path) -> None:
    cared = np.arange(32) % 3 == 0
    claim = specify(MODEL, EDGES, {"pixel": Codes(cared)}).claims["block_match"]
    rng = np.random.default_rng(0)
    samples = {"window": rng.random((200, 216)) < 0.5, "reference_bits": rng.random((200, 9)) < 0.5}
    assert not claim.cared(samples).all()
    # Where pixels are cared for, the circuit may be that of a model without don't-cares.
    source = written(specification, tmp_path)
    assert run_bench(claim, MODULE, [source], samples, "icarus", tmp_path / "icarus") == 200


@pytest.mark.realdata
def test_windows_of_a_real_chip_agree_with_the_model(
    specification: Specification, realdata: Path, tmp_path: Path
) -> None:
    chip = sorted((realdata / "paper" / "chips").glob("*.jpg"))[0]
    pixels = np.asarray(Image.open(chip).convert("RGB"))
    rng = np.random.default_rng(0)
    corners = rng.integers(0, min(pixels.shape[:2]) - 3, (200, 2))
    windows = np.stack([pixels[y : y + 3, x : x + 3].reshape(9, 3) for y, x in corners])
    samples = {"window": pixel_bits(windows), "reference_bits": rng.random((200, 9)) < 0.5}
    source, claim = written(specification, tmp_path), specification.claims["block_match"]
    assert run_bench(claim, MODULE, [source], samples, "icarus", tmp_path / "icarus") == 200


@pytest.mark.parametrize("wrong", [" ^ window[0]", " | 1'bx"])
def test_a_wrong_or_undefined_output_fails(specification: Specification, tmp_path: Path, wrong: str) -> None:
    source, claim = written(specification, tmp_path, wrong), specification.claims["block_match"]
    assert claim.stimulus is not None
    samples = {port: bits[:500] for port, bits in claim.stimulus().items()}
    with pytest.raises(AssertionError, match="differs from the model in icarus"):
        run_bench(claim, MODULE, [source], samples, "icarus", tmp_path / "icarus")


def test_a_pipeline_answers_its_latency_later(specification: Specification, tmp_path: Path) -> None:
    source, claim = written(specification, tmp_path), specification.claims["block_match"]
    ports = [f"input [{width - 1}:0] {port}" for port, width in claim.inputs.items()]
    wires, late = [], []
    for port, width in claim.outputs.items():
        ports.append(f"output reg [{width - 1}:0] {port}")
        wires.append(f"wire [{width - 1}:0] now_{port}; reg [{width - 1}:0] then_{port};")
        late.append(f"then_{port} <= now_{port}; {port} <= then_{port};")
    pins = [f".{port}({port})" for port in claim.inputs] + [f".{port}(now_{port})" for port in claim.outputs]
    piped = tmp_path / "piped.v"
    piped.write_text(
        f"module piped(input clk, {', '.join(ports)});\n{' '.join(wires)}\n"
        f"{MODULE} block ({', '.join(pins)});\nalways @(posedge clk) begin {' '.join(late)} end\nendmodule\n",
        encoding="utf-8",
    )
    assert claim.stimulus is not None
    samples = {port: bits[:100] for port, bits in claim.stimulus().items()}
    sources, folder = [source, piped], tmp_path / "icarus"
    assert run_bench(claim, "piped", sources, samples, "icarus", folder, latency=2) == 100
    with pytest.raises(AssertionError, match="differs from the model in icarus"):
        run_bench(claim, "piped", sources, samples, "icarus", folder, latency=1)
