"""Circuits from Python: compiled, looked at, verified, and run over pictures."""

import gc
from pathlib import Path

import numpy as np
import pytest

from wnn2hdl.api import (
    Build,
    CompileOptions,
    Model,
    compile,  # noqa: A004
    evaluate,
    open_build,
    scan,
    silent,
    train,
    verify,
)
from wnn2hdl.api.showing import MOST_PIXELS
from wnn2hdl.apps.deforestation.classify import Method
from wnn2hdl.apps.deforestation.options import ScanOptions
from wnn2hdl.errors import InputError
from wnn2hdl.samples import landscape
from wnn2hdl.samples.landscapes import write_landscapes


@pytest.fixture(scope="module")
def model() -> Model:
    scenes = [landscape(48, 48, seed) for seed in range(2)]
    pictures, masks = [scene.image for scene in scenes], [scene.deforested for scene in scenes]
    return train(pictures, masks, bits="R7,R6,R5,B7,B6,B5", rams=4, bleaching=5)


@pytest.fixture(scope="module")
def build(model: Model) -> Build:
    return compile(model, options=CompileOptions(target="pixel"))


def test_a_build_says_what_it_is(build: Build) -> None:
    assert build.proved
    assert build.luts["pixel"] == build.report["parts"]["pixel"]["luts"]
    assert build.accuracy is None
    assert "module circuit_pixel" in build.verilog
    assert build.design.target.name == "pixel"
    assert f"LUTs of pixel  {build.luts['pixel']}" in repr(build)
    assert "<caption>circuit: pixel, exact mode</caption>" in build._repr_html_()


def test_it_is_verified_and_a_changed_one_is_not(model: Model, tmp_path: Path) -> None:
    build = compile(model, tmp_path / "mine", CompileOptions(target="pixel"))
    assert verify(build)
    assert repr(verify(tmp_path / "mine")).endswith("mine: verified")
    text = build.verilog
    (tmp_path / "mine" / "mine.v").write_text(text.replace("wire R7", "wire  R7", 1))
    found = verify(open_build(tmp_path / "mine"))
    assert not found
    assert any("mine.v" in problem for problem in found.problems)
    assert "NOT verified" in found._repr_html_()


def test_files_without_a_name_go_with_the_build(model: Model) -> None:
    build = compile(model, options=CompileOptions(target="pixel"))
    folder = build.folder
    assert folder.is_dir()
    del build
    gc.collect()
    assert not folder.parent.exists()


def test_the_circuit_answers_as_the_model_does(model: Model, build: Build) -> None:
    scene = landscape(40, 64, 9)
    of_circuit, of_model = (scan(subject, scene.image) for subject in (build, model))
    assert of_circuit.classes is not None
    assert of_model.classes is not None
    np.testing.assert_array_equal(of_circuit.classes, of_model.classes)
    assert of_circuit.deforested == pytest.approx(float((of_circuit.classes == 1).mean()))
    one = evaluate(build, [scene.image], [scene.deforested])
    assert one.confusion.tolist() == evaluate(model, [scene.image], [scene.deforested]).confusion.tolist()
    assert one.interval is None


def test_a_file_is_mapped_as_its_array_is(model: Model, tmp_path: Path) -> None:
    pytest.importorskip("rasterio")
    write_landscapes(tmp_path, 1, 80, seed=3, progress=silent)
    (file,) = (tmp_path / "images").iterdir()
    options = ScanOptions(method=Method(square=8))
    of_file = scan(model, file, tmp_path / "map", options)
    of_array = scan(model, landscape(80, 80, 3).image, options=options)
    assert of_file.deforested == pytest.approx(of_array.deforested)
    assert of_file.known == pytest.approx(of_array.known)
    np.testing.assert_array_equal(of_file.overlay, of_array.overlay)
    assert (tmp_path / "map" / "classes.tif").is_file()
    assert "data:image/png;base64," in of_array._repr_html_()
    assert max(of_array.picture.shape) <= MOST_PIXELS


def test_a_map_of_a_file_needs_a_folder(model: Model) -> None:
    with pytest.raises(InputError, match="the map of a file is written as files"):
        scan(model, "photo.png")
    with pytest.raises(InputError, match="are for pictures from files"):
        scan(model, np.zeros((4, 4, 3), np.uint8), "folder")
    with pytest.raises(InputError, match=r"a picture is uint8 \[height, width, 3\]: bool"):
        scan(model, np.zeros((4, 4), np.bool_))
