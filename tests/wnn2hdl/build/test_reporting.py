"""Pages made of what lies in build folders."""

import html
import json
import shlex
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from wnn2hdl.build.design import Design
from wnn2hdl.build.planning import CompileOptions
from wnn2hdl.build.reporting import (
    command,
    evaluation,
    open_entries,
    read_report,
    sample_picture,
    write_page,
)
from wnn2hdl.dataset import Dataset, LabelledImage, from_samples
from wnn2hdl.emit import check
from wnn2hdl.errors import InputError, ModelFileError
from wnn2hdl.images import read_rgb, write_png


def test_the_page_of_a_finished_build_is_made_of_its_files_alone(build: Path) -> None:
    page = (build / "report.html").read_bytes()
    assert write_page(build).read_bytes() == page
    assert check(build) == []
    assert len(page) < 1_000_000


def test_a_build_notes_confusion_model_and_command(build: Path) -> None:
    report = json.loads((build / "report.json").read_text())
    confusion = np.array(report["confusion"])
    assert confusion.sum() == 2 * 64 * 64
    assert np.trace(confusion) / confusion.sum() == report["accuracy"]
    model = Design.load(build).picture_model
    assert report["model"]["saturation"] == model.saturation.tolist()
    assert report["model"]["bits"] == list(model.encoder.names)
    assert report["care"]["of"] == 256
    words = shlex.split(report["command"])
    assert words[:4] == ["wnn2hdl", "compile", "block/model.json", "-o"]
    options = report["options"]
    images, masks = options["test_images"], options["test_masks"]
    assert words[5:9] == ["--mode", "domain", "--care", options["care"]]
    assert words[9:] == ["--test-images", images, "--test-masks", masks]
    assert shlex.split(report["evaluation"])[2:] == ["block", "--images", images, "--masks", masks]
    assert html.escape(report["evaluation"], quote=False).replace("'", "&#39;") in (
        (build / "report.html").read_text()
    )


def test_the_command_leaves_out_what_is_usual_and_quotes() -> None:
    assert command("x", CompileOptions()) == "wnn2hdl compile x/model.json -o x-again"
    options = CompileOptions(care=Path("/my imagery"), care_minimum=3, style="equations", sobel_threshold=99)
    assert command("x", options).endswith("--care '/my imagery' --care-min 3 --style equations")


def test_the_command_finds_its_imagery_from_the_folder_that_it_is_run_in(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    line = command("x", CompileOptions(care=Path("imagery"), edges="patterns.txt"))
    assert line.endswith(f"--care {tmp_path}/imagery --edges {tmp_path}/patterns.txt")
    assert command("x", CompileOptions(edges="learned")).endswith("--edges learned")
    options = CompileOptions(test_images=Path("a b"), test_masks=Path("c"), palette=Path("p.json"))
    assert evaluation("x", options) == (
        f"wnn2hdl evaluate x --images '{tmp_path}/a b' --masks {tmp_path}/c --palette {tmp_path}/p.json"
    )
    assert command("x", options).endswith(
        f"--test-images '{tmp_path}/a b' --test-masks {tmp_path}/c --palette {tmp_path}/p.json"
    )


def test_the_commands_read_pictures_in_the_same_way(tmp_path: Path) -> None:
    options = CompileOptions(
        test_images=tmp_path,
        test_masks=tmp_path,
        ignore=(255, -1),
        bands=(3, 2, 1),
        scale=(0, 0.3),
        alpha="data",
    )
    said = "--ignore 255,-1 --bands 3,2,1 --scale 0..0.3 --alpha data"
    assert command("x", options).endswith(said)
    assert evaluation("x", options).endswith(said)


def test_the_sample_is_the_middle_of_the_first_test_image() -> None:
    pixels = np.arange(300 * 400 * 3, dtype=np.uint32).astype(np.uint8).reshape(300, 400, 3)
    image = LabelledImage("a", pixels.reshape(-1, 3), np.zeros(300 * 400, dtype=np.uint8), (300, 400))
    sample = sample_picture(Dataset(("x", "y"), ("a",), lambda _: image))
    assert np.array_equal(sample, pixels[22:278, 72:328])
    small = sample_picture(from_samples(1, 32, seed=0))
    assert small.shape == (32, 32, 3)


def test_without_whole_images_the_sample_is_a_landscape() -> None:
    part = LabelledImage("a", np.zeros((5, 3), dtype=np.uint8), np.zeros(5, dtype=np.uint8))
    for dataset in (None, Dataset(("x", "y"), ("a",), lambda _: part)):
        assert sample_picture(dataset).shape == (256, 256, 3)


def test_the_picture_in_the_folder_is_shown(write_build: Callable[..., Path], tmp_path: Path) -> None:
    folder = write_build(tmp_path / "a")
    write_png(folder / "sample.png", np.zeros((20, 30, 3), dtype=np.uint8))
    page = write_page(folder).read_text()
    assert page.count('width="30" height="20"') == 3
    assert read_rgb(folder / "sample.png").shape == (20, 30, 3)


def test_entries_are_named_after_their_folders_and_linked_from_the_index(
    write_build: Callable[..., Path], tmp_path: Path
) -> None:
    folders = [write_build(tmp_path / "some builds" / "a"), write_build(tmp_path / "b")]
    entries = open_entries(folders, tmp_path / "pages" / "index.html")
    assert [(entry.name, entry.link) for entry in entries] == [
        ("a", "../some%20builds/a/report.html?index=../../pages/index.html"),
        ("b", "../b/report.html?index=../pages/index.html"),
    ]
    assert all((folder / "report.html").is_file() for folder in folders)


def test_folders_of_one_name_are_told_apart_by_their_paths(
    write_build: Callable[..., Path], tmp_path: Path
) -> None:
    folders = [write_build(tmp_path / x / "a") for x in ("old", "new")]
    assert [entry.name for entry in open_entries(folders, tmp_path / "i.html")] == list(map(str, folders))


@pytest.mark.parametrize("spelling", ["a", "b/../a", "link"])
def test_a_build_is_given_once_however_its_path_is_spelled(
    write_build: Callable[..., Path], tmp_path: Path, spelling: str
) -> None:
    folder = write_build(tmp_path / "a")
    (tmp_path / "b").mkdir()
    (tmp_path / "link").symlink_to(folder)
    with pytest.raises(InputError, match=r"a build is given twice: .*; name it once"):
        open_entries([folder, tmp_path / spelling], tmp_path / "i.html")


def test_a_name_that_is_no_utf8_is_refused(write_build: Callable[..., Path], tmp_path: Path) -> None:
    folder = write_build(tmp_path / "b\udcff", name="b")
    with pytest.raises(InputError, match=r"the name of a folder is not UTF-8: .*/b\\xff; rename it"):
        open_entries([folder], tmp_path / "i.html")


def test_changes_after_the_proof_are_noted_but_not_those_of_the_page(build: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(build, tmp_path / "x"))
    (folder / "report.html").unlink()
    (entry,) = open_entries([folder], tmp_path / "i.html")
    assert entry.changes == ()
    (folder / "report.html").write_text("of another version")
    with (folder / "block.v").open("a") as verilog:
        verilog.write("module foo; endmodule")
    (entry,) = open_entries([folder], tmp_path / "i.html")
    assert entry.changes == ("block.v was changed",)


def test_a_page_that_is_there_is_kept(write_build: Callable[..., Path], tmp_path: Path) -> None:
    folder = write_build(tmp_path / "a")
    (folder / "report.html").write_text("mine")
    open_entries([folder], tmp_path / "index.html")
    assert (folder / "report.html").read_text() == "mine"


def test_a_marked_build_is_not_proved_whatever_its_report_says(
    write_build: Callable[..., Path], tmp_path: Path
) -> None:
    folder = write_build(tmp_path / "a")
    assert read_report(folder)["proof"]["status"] == "proved"
    (folder / "FAILED").write_text("a counterexample\n")
    assert (
        read_report(folder)["proof"] | {"status": "failed", "failure": "a counterexample"}
        == (read_report(folder)["proof"])
    )
    assert "This build failed" in write_page(folder).read_text()


def test_damaged_builds_get_one_line(write_build: Callable[..., Path], tmp_path: Path) -> None:
    folder = write_build(tmp_path / "a")
    (folder / "report.json").write_text("{}")
    with pytest.raises(ModelFileError, match="not a report"):
        open_entries([folder], tmp_path / "index.html")
    other = write_build(tmp_path / "b")
    (other / "manifest.json").write_text("{]")
    with pytest.raises(ModelFileError, match="not a manifest, or a damaged one"):
        open_entries([other], tmp_path / "index.html")
    with pytest.raises(InputError, match="not a build folder"):
        open_entries([tmp_path], tmp_path / "index.html")
