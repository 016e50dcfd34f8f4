"""The pictures that README and these pages show, from what the demo made.

Run it as ``python docs/pictures.py DEMO OUTPUT``.

Pages are photographed by the system's Chromium; plots are made as wide as a page of text.
"""

import io
import shutil
import sys
from pathlib import Path

from PIL import Image
from playwright.sync_api import sync_playwright

PAGES = {
    "page_of_builds": "index.html",
    "page_of_a_build": "smallest/report.html",
    "page_of_a_sweep": "sweep/index.html",
}
PLOTS = {
    "sweep_front": "sweep/pareto.png",
    "sweep_surface": "sweep/surface.png",
    "flight_errors": "flight/errors.png",
    "flight_tracks": "flight/tracks_map.png",
    "map": "scan/overlay.png",
}
OVERVIEW = "overview.jpg"

WIDTH, HEIGHT = 1180, 1000
"""Of the window, in CSS pixels."""

SHOWN_WIDTH, QUALITY = 900, 78
"""Of the pictures; a JPEG of a page then takes about 80 kB."""


def main(demo: Path, output: Path) -> None:
    """Make all pictures; a file that the demo did not make ends it with that file's name."""
    output.mkdir(parents=True, exist_ok=True)
    shutil.copy(demo / OVERVIEW, output / OVERVIEW)
    for name, plot in PLOTS.items():
        save(Image.open(demo / plot), output / f"{name}.jpg")
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox", "--disable-gpu"])
        for name, page in PAGES.items():
            shown = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})
            shown.goto((demo / page).resolve(strict=True).as_uri())
            save(Image.open(io.BytesIO(shown.screenshot())), output / f"{name}.jpg")
        browser.close()


def save(picture: Image.Image, path: Path) -> None:
    """Write a JPEG of at most the shown width."""
    picture = picture.convert("RGB")
    width = min(SHOWN_WIDTH, picture.width)
    size = (width, round(picture.height * width / picture.width))
    picture.resize(size, Image.Resampling.LANCZOS).save(path, quality=QUALITY, optimize=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
