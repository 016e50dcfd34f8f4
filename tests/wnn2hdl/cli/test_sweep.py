import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from wnn2hdl.apps.sweep import PixelSets, draw
from wnn2hdl.apps.sweep import run_sweep as real_sweep
from wnn2hdl.apps.sweep.trial import answers_digest, run_trials
from wnn2hdl.dataset import from_samples
from wnn2hdl.ir import WisardModel
from wnn2hdl.lower.table import pixel_table

Run = Callable[..., Any]

GRID = ("--address-bits", "3..4", "--rams", "5..6", "--trials", "2")


@pytest.fixture(scope="module")
def sets() -> PixelSets:
    """2,000 training pixels of four small landscapes."""
    return draw(from_samples(4, 64, seed=3), pixels=2_000, seed=0, progress=lambda *_: None)


@pytest.fixture(autouse=True)
def small(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, sets: PixelSets) -> None:
    """Few small landscapes, few finalist trials, one process, and its own folder."""

    def quick(*arguments: Any, **options: Any) -> Any:
        return real_sweep(*arguments, finalist_trials=3, **options)

    monkeypatch.setattr("wnn2hdl.cli.sweep.draw", lambda *_, **__: sets)
    monkeypatch.setattr("wnn2hdl.cli.sweep.run_sweep", quick)
    monkeypatch.setattr(
        "wnn2hdl.cli.sweep.run_locally", lambda sets, trials: iter([run_trials(sets, trials)])
    )
    monkeypatch.chdir(tmp_path)


def test_json_tells_how_many_trials_there_were(run: Run) -> None:
    status, out, _ = run("sweep", *GRID, "-o", "out", "--json")
    assert status == 0
    assert json.loads(out)["trials"] == 8
    assert len(Path("out/trials.csv").read_text().splitlines()) == 9


def test_pictures_and_page_lie_in_the_folder(run: Run) -> None:
    status, out, _ = run("sweep", *GRID)
    assert status == 0
    assert out.startswith("build/sweep: 8 trials")
    names = {path.name for path in Path("build/sweep").iterdir()}
    assert {"index.html", "surface.svg", "surface.png", "pareto.svg", "finalists.png"} <= names


def test_best_writes_the_model_of_the_best_trial_of_the_chosen_architecture(run: Run) -> None:
    run("sweep", *GRID, "-o", "out")
    status, out, _ = run("sweep", *GRID, "--results", "out", "--best", "-o", "m.json", "--json")
    assert status == 0
    best = json.loads(Path("out/summary.json").read_text())["best"]
    assert json.loads(out)["name"] == best["name"]
    assert answers_digest(pixel_table(WisardModel.load(Path("m.json")))) == best["answers"]


def test_any_trial_is_rebuilt_without_a_sweep(run: Run) -> None:
    status, out, _ = run("sweep", "--trial", "n4-k16-t7", "-o", "m.json", "--json")
    assert status == 0
    model = WisardModel.load(Path("m.json"))
    assert (model.address_bits, model.rams) == (4, 16)
    assert answers_digest(pixel_table(model)) == json.loads(out)["answers"]
    assert not Path("build").exists()


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (("--best",), "the model has no file to go to; name its file with -o MODEL.json"),
        (("--best", "--trial", "n4-k16-t7", "-o", "m"), "--best and --trial name different models"),
        (("--results", "out"), "--results goes with --best or --trial"),
        (("--trial", "n4", "-o", "m.json"), "no such trial: 'n4'"),
        (("--trial", "s3", "-o", "m.json"), "no such trial: 's3'; run the sweep with --beyond-grid first"),
        (("--address-bits", "12..2"), "'12..2' is not a range of whole numbers from 1, as in 2..12"),
        (("--rams", "0"), "'0' is not a range of whole numbers"),
    ],
)
def test_bad_options_are_one_line_and_status_2(run: Run, arguments: tuple[str, ...], complaint: str) -> None:
    assert complaint in run("sweep", *arguments).complaint()
