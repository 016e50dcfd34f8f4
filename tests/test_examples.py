"""The scripts in examples/ run as they are shown."""

import subprocess
import sys
from pathlib import Path

import pytest

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
