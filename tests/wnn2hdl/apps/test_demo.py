"""What a newcomer sees first; the sizes are smaller here, the stages the same."""

import json
import re
import shlex
import sys
from pathlib import Path

import pytest

from wnn2hdl.apps import demo
from wnn2hdl.apps.navigation import recording
from wnn2hdl.build.verification import open_build
from wnn2hdl.cli import main
from wnn2hdl.errors import InputError
from wnn2hdl.images import picture_size
from wnn2hdl.ir import WisardModel


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in {
        "SIDE": 96,
        "TRAINING_IMAGES": 4,
        "TEST_IMAGES": 2,
        "SCENE_SIDE": 128,
        "ADDRESS_BITS": (2, 3),
        "RAMS": (4,),
        "TRIALS": 2,
        "FINALIST_TRIALS": 3,
        "SWEEP_PIXELS": 500,
    }.items():
        monkeypatch.setattr(demo, name, value)
    monkeypatch.setattr(recording, "SAMPLE_MAP", (700, 700))


@pytest.mark.slow
@pytest.mark.usefixtures("small")
def test_every_stage_leaves_what_the_page_leads_to(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    steps: list[str] = []
    made = demo.run_demo(tmp_path, 0, lambda step, *_: steps.append(step))
    page = made.page.read_text(encoding="utf-8")
    links = re.findall(r'(?:href|src)="([^"#:?]+)(?:\?index=[^"]*)?"', page)
    pages = "reference/report.html", "smallest/report.html", "scan/summary.html", "flight/flight.html"
    assert {*pages, "sweep/index.html"} <= {*links}
    assert all((tmp_path / link).is_file() for link in links)
    assert made.reference.failure is made.smallest.failure is None
    assert made.smallest.report["parts"]["pixel"]["luts"] <= demo.LUTS_PER_PIXEL
    assert picture_size(tmp_path / demo.OVERVIEW) == (862, 1200)
    assert made.windows == (demo.SIDE - 2) ** 2
    assert made.flight is not None
    (*_, whole) = made.flight.result.searches
    fixes = made.flight.rows(whole)["perspective-weightless"].fixes
    assert len(fixes) == recording.SAMPLE_FRAMES - demo.CALIBRATION_FRAMES
    assert made.missing == ""
    assert steps[0] == "landscapes"
    for build in (made.reference, made.smallest):
        model = WisardModel.load(build.folder / "model.json")
        monkeypatch.setattr(
            "sys.argv", [*shlex.split(model.training["command"]), "-o", str(tmp_path / "m.json")]
        )
        assert main() == 0
        assert WisardModel.load(tmp_path / "m.json").digest() == model.digest()


@pytest.mark.usefixtures("small")
def test_another_seed_begins_the_sweep_anew(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def stop(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(demo, "train", stop)
    for seed in (0, 1):
        with pytest.raises(KeyboardInterrupt):
            demo.run_demo(tmp_path, seed, lambda *_: None)
    settings = json.loads((tmp_path / "sweep" / "sweep.json").read_text())
    assert settings["recipe"]["seed"] == 1


def test_a_folder_that_is_no_build_is_told_before_the_first_stage(tmp_path: Path) -> None:
    (tmp_path / "smallest").mkdir()
    (tmp_path / "smallest" / "notes.txt").write_text("mine")
    steps: list[str] = []
    with pytest.raises(InputError, match=r"the output exists and is not an earlier build: .*smallest"):
        demo.run_demo(tmp_path, 0, lambda step, *_: steps.append(step))
    assert steps == []
    assert [path.name for path in tmp_path.iterdir()] == ["smallest"]


@pytest.mark.slow
@pytest.mark.usefixtures("small")
def test_without_the_extra_map_and_flight_are_left_out_and_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("pyproj", "rasterio"):
        monkeypatch.setitem(sys.modules, name, None)
    made = demo.run_demo(tmp_path, 0, lambda *_: None)
    assert made.flight is None
    assert "pip install 'wnn2hdl[geo]'" in made.missing
    page = made.page.read_text(encoding="utf-8")
    assert "sweep/index.html" in page
    assert "flight" not in page
    assert (tmp_path / demo.OVERVIEW).is_file()
    assert open_build(tmp_path / "smallest")[0].mode == "exact"
