"""The script that makes the pictures of README and documentation runs."""

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from wnn2hdl.images import picture_size, write_png

DOCS = Path(__file__).parents[1] / "docs"


@pytest.mark.browser
@pytest.mark.slow
def test_each_page_and_plot_of_a_demo_gets_a_small_picture(tmp_path: Path) -> None:
    if not (shutil.which("chromium") or shutil.which("chromium-browser")):
        pytest.skip("Chromium is not installed")
    demo = tmp_path / "demo"
    for page in ("index.html", "smallest/report.html", "sweep/index.html"):
        (demo / page).parent.mkdir(parents=True, exist_ok=True)
        (demo / page).write_text("<!doctype html><title>page</title><p>A page.</p>")
    noise = np.random.default_rng(0).integers(0, 256, (1200, 1800, 3), dtype=np.uint8)
    plots = ("sweep/pareto", "sweep/surface", "flight/errors", "flight/tracks_map", "scan/overlay")
    for plot in plots:
        (demo / plot).parent.mkdir(parents=True, exist_ok=True)
        write_png(demo / f"{plot}.png", noise)
    Image.fromarray(noise).save(demo / "overview.jpg")
    script = [sys.executable, str(DOCS / "pictures.py"), str(demo), str(tmp_path / "out")]
    done = subprocess.run(script, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    made = {path.name for path in (tmp_path / "out").iterdir()}
    assert made == {path.name for path in (DOCS / "pictures").glob("*.jpg")}
    assert picture_size(tmp_path / "out" / "map.jpg") == (600, 900)


def test_pictures_of_the_documentation_are_small() -> None:
    sizes = [path.stat().st_size for path in (DOCS / "pictures").iterdir()]
    assert max(sizes) <= 250_000
    assert sum(sizes) <= 1_000_000
