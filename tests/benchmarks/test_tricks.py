"""`verify` refuses what deceives, and says where; what does no harm passes."""

import json
from pathlib import Path

import pytest

from benchmarks.tricks import TRICKS, Trick, findings, sign_again
from wnn2hdl.build.compile import compile_model
from wnn2hdl.build.planning import CompileOptions
from wnn2hdl.dataset import from_samples
from wnn2hdl.encode import parse_bits
from wnn2hdl.images import write_png
from wnn2hdl.samples import landscape
from wnn2hdl.training.discriminators import train

pytestmark = pytest.mark.slow

SAMPLE = {
    "`ifdef SYNTHESIS": "px.v is not what the compiler writes, from line ",
    "/* synthesis translate_off */": "translate_off",
    "a local defparam": "defparam t0_cell.INIT",
    "a delay of a wire": "wire #1000 ",
    "a second cell model at the end": "module LUT6",
    "LUT6_2 in place of LUT6": "LUT6_2",
    "a form feed for the end of a line": r"\x0cmodule",
    "a line that ends by CR": r"\r",
    "xilinx_cells_sim.v changed": "xilinx_cells_sim.v is not what the compiler writes",
    "vectors changed": "px_pixel_vectors.hex is not what the compiler writes, from line 1",
    "a file extra.v more": "'extra.v' is a source that the compiler does not write",
    "a link to the same bytes": "",
    "model.json changed, its digests repaired": "the circuit differs from the model",
    "fewer LUTs": "report.json says that parts.pixel.luts is 0; it is ",
    "a part that is none": "report.json has parts.x",
    "wrong contents of a LUT, Verilog and all": "the circuit differs from the model",
    "a cell that nothing reads, Verilog and all": "nothing reads copy in the pixel",
    "exact mode for domain mode": "don't-cares in exact mode",
    "a smaller care set": "The care set of the pixel holds",
    "impossible bits that are possible": "The care set of the pixel holds",
    "a smaller care set that is stated everywhere": "",
    "the comment 'synthesis translate_off'": "is a command to a tool",
    "the summary 'Proved.'": "design.json has other comments of the pixel than its target",
    "the cell 'always'": "reserved word",
    "the node 'end'": "reserved word",
}
"""Some tricks of each kind, and what is said of them; nothing of harmless ones."""


def silent(step: str, done: int, total: int) -> None:
    """No progress is shown."""


@pytest.fixture(scope="module")
def build(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A pixel in domain mode."""
    bits = parse_bits("R7,R6,R5,G7,G6,G5,B6,B5")
    model = train(
        from_samples(3, 64, seed=1), bits, address_bits=3, rams=6, bleaching=None, seed=0, progress=silent
    )
    folder = tmp_path_factory.mktemp("tricks")
    (folder / "care").mkdir()
    write_png(folder / "care" / "landscape.png", landscape(64, 64, 7).image)
    options = CompileOptions(target="pixel", mode="domain", care=folder / "care")
    assert compile_model(model, folder / "px", options, silent).failure is None
    return folder / "px"


def trick(name: str) -> Trick:
    (found,) = [trick for tricks in TRICKS.values() for trick in tricks if trick.name == name]
    return found


@pytest.mark.parametrize("name", SAMPLE)
def test_a_trick_is_refused_or_does_no_harm(build: Path, name: str) -> None:
    said = findings(trick(name), build)
    assert said is not None
    assert bool(said) != bool(trick(name).harmless)
    assert SAMPLE[name] in "\n".join(said)


def test_signing_a_build_again_changes_nothing_that_counts(build: Path) -> None:
    assert findings(Trick("nothing", sign_again), build) == []


def test_a_build_says_for_how_many_codes_it_is_proved(build: Path) -> None:
    report = json.loads((build / "report.json").read_text())
    stated = f"// The care set of the pixel holds {report['care']['codes']} of 256 codes.\n"
    assert stated in (build / "px.v").read_text()
