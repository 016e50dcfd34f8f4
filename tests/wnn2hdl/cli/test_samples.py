"""`samples` writes what `train` reads, for two classes and for all kinds of ground."""

import json
from pathlib import Path

from click.testing import CliRunner

from wnn2hdl.cli.learn import train_command
from wnn2hdl.cli.samples import samples_command
from wnn2hdl.samples import CLASSES


def test_a_model_of_all_kinds_of_ground_from_the_written_files(tmp_path: Path) -> None:
    folder = tmp_path / "samples"
    done = CliRunner().invoke(samples_command, ["--images", "6", "--side", "96", "--json", "-o", str(folder)])
    assert json.loads(done.stdout)["images"] == 6
    options = [
        "--images",
        folder / "images",
        "--masks",
        folder / "kinds",
        "--palette",
        folder / "palette.json",
    ]
    model = tmp_path / "kinds.json"
    done = CliRunner().invoke(train_command, [*map(str, options), "--json", "-o", str(model)])
    assert json.loads(done.stdout)["classes"] == list(CLASSES)
