"""`verify` finds every change of a build, from its files alone."""

import json
import shutil
from pathlib import Path

import pytest

from wnn2hdl.build.verification import verify_build
from wnn2hdl.emit import write_manifest
from wnn2hdl.errors import InputError

pytestmark = pytest.mark.slow


def silent(step: str, done: int, total: int) -> None:
    pass


@pytest.fixture
def copy(pixel_build: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(pixel_build, tmp_path / "copy"))


def sign_again(folder: Path) -> None:
    """Make the manifest fit the files, as somebody who wants to deceive would."""
    (folder / "manifest.json").unlink()
    write_manifest(folder, sorted(path.name for path in folder.iterdir()), versions={}, options={})


def test_an_untouched_build_is_verified(build: Path) -> None:
    problems, checked = verify_build(build, silent)
    assert problems == []
    assert checked is not None
    assert checked.status == "proved"


def test_a_flipped_bit_is_noticed_by_its_hash_and_by_the_proof(copy: Path) -> None:
    path = copy / "pixel.v"
    text = path.read_text()
    place = text.index("'h", text.index(".INIT")) + 2
    path.write_text(text[:place] + format(int(text[place], 16) ^ 1, "x") + text[place + 1 :])
    problems, _ = verify_build(copy, silent)
    assert "pixel.v was changed" in problems
    sign_again(copy)
    problems, _ = verify_build(copy, silent)
    assert problems[0].startswith("pixel.v is not what the compiler writes, from line ")
    assert any("differs from the model" in problem for problem in problems)


def test_a_changed_model_is_noticed(copy: Path) -> None:
    path = copy / "model.json"
    data = json.loads(path.read_text())
    data["bleaching"] += 1
    path.write_text(json.dumps(data))
    assert verify_build(copy, silent)[0][0] == "model.json was changed"
    sign_again(copy)
    problems, checked = verify_build(copy, silent)
    assert len(problems) == 1
    assert problems[0].startswith("the design was made from another model")
    assert checked is None


def test_verilog_that_no_tool_can_read_is_a_finding(copy: Path) -> None:
    path = copy / "pixel.v"
    path.write_text(path.read_text().replace("endmodule", "endmodul", 1))
    problems, checked = verify_build(copy, silent)
    assert problems[0] == "pixel.v was changed"
    assert problems[1].startswith("pixel.v is not what the compiler writes, from line ")
    assert "syntax error" in problems[2]
    assert checked is None


def test_a_missing_file_is_noticed(copy: Path) -> None:
    (copy / "pixel.v").unlink()
    problems, checked = verify_build(copy, silent)
    assert problems == ["pixel.v is missing"]
    assert checked is None


def test_the_report_of_another_build_is_noticed(copy: Path) -> None:
    path = copy / "report.json"
    report = json.loads(path.read_text())
    report["hashes"]["model"] = "0" * 64
    report["parts"]["pixel"]["luts"] -= 1
    path.write_text(json.dumps(report))
    sign_again(copy)
    problems, _ = verify_build(copy, silent)
    assert any(problem.startswith("report.json says that hashes.model is") for problem in problems)
    assert any(problem.startswith("report.json says that parts.pixel.luts is") for problem in problems)


def test_the_reason_of_a_failure_is_told(copy: Path) -> None:
    (copy / "FAILED").write_text("the pixel differs\n")
    assert "the build is marked as failed: the pixel differs" in verify_build(copy, silent)[0]


def test_another_folder_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="not a build folder"):
        verify_build(tmp_path, silent)


def test_an_emitted_file_that_is_no_text_is_a_finding(copy: Path) -> None:
    (copy / "sobel.v").write_bytes(b"module \xff\xfe")
    problems, checked = verify_build(copy, silent)
    assert checked is None
    assert problems[0] == "sobel.v was changed"
    assert problems[-1].startswith("not Verilog, or a damaged one")
