"""The scripts in examples/ run as they are shown."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from wnn2hdl.dataset.tables import FeatureTable
from wnn2hdl.ir import Thermometer
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.ir.models import LutGroupModel, LutLayer

# The import of a DWN needs a checkpoint: it runs beside the tests of checkpoints.
EXAMPLES = sorted(
    path for path in (Path(__file__).parents[1] / "examples").glob("*.py") if path.stem != "import_a_dwn"
)


@pytest.mark.slow
@pytest.mark.parametrize("script", EXAMPLES, ids=lambda path: path.stem)
def test_the_script_runs(script: Path, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, script, tmp_path / "output"],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout


def test_the_pixels_of_a_class_are_those_that_its_tables_read_through_all_layers() -> None:
    spec = importlib.util.spec_from_file_location(
        "digits", EXAMPLES[0].with_name("digits_to_a_proved_circuit.py")
    )
    assert spec is not None
    assert spec.loader is not None
    digits = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(digits)
    ors = LutLayer(np.array([[0, 1], [2, 3]], np.int32), np.array([[0, 1, 1, 1]] * 2, np.bool_))
    votes = LutLayer(np.array([[0, 0], [0, 1], [1, 1]], np.int32), np.ones((3, 4), np.bool_))
    encoder = Thermometer(((128.0,), (), (64.0, 128.0), (128.0,)), input=FixedPoint.parse("UQ8.0"))
    model = LutGroupModel(encoder, ("left", "right"), (ors, votes), np.array([0, 0, 1], np.int32))
    assert digits.looked_at(model).tolist() == [[2, 0, 2, 1], [0, 0, 1, 1]]
    features = np.arange(0.0, 160, 10).reshape(4, 4)
    rows = FeatureTable(("a", "b", "c", "d"), features, ("left", "left", "right", "right"), (2, 2))
    sheet = digits.picture(model, rows)
    assert sheet.dtype == np.uint8
    assert sheet.shape == (2 * 4 * 56, 4 * 56, 3)
    left = sheet[56:168, 56:168][::56, ::56]
    assert left[0, 0].tolist() == [10, 255, 10]
    assert left[0, 1].tolist() == [15, 15, 15]
    assert left[1, 1].tolist() == [25, 127, 25]
