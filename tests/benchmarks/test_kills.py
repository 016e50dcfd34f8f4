"""The bench that kills commands finds out those that lose something."""

import subprocess
import sys
from pathlib import Path

import pytest

BENCH = Path(__file__).parents[2] / "benchmarks" / "kills.py"

SOUND = """
import sys, time; from pathlib import Path; from wnn2hdl.files import output_folder, write_text
out = Path(sys.argv[1])
with output_folder(out, "test"):
    for name in "abc": write_text(out / name, name * 1000); time.sleep(0.2)
"""

CARELESS = """
import sys, time; from pathlib import Path
out = Path(sys.argv[1]); out.mkdir(exist_ok=True)
for name in "abc":
    if not (out / name).exists():
        with (out / name).open("w") as stream:
            for _ in range(4): stream.write(name); stream.flush(); time.sleep(0.1)
"""


@pytest.mark.slow
@pytest.mark.parametrize(("program", "status"), [(SOUND, 0), (CARELESS, 1)])
def test_half_written_files_that_are_taken_for_whole_are_found(program: str, status: int) -> None:
    words = [sys.executable, str(BENCH), "--kills", "6", "--", sys.executable, "-c", program, "{out}"]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == status, done.stderr
    assert "| 6 |" in done.stdout
