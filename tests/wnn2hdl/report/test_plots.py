import re
from pathlib import Path

from PIL import Image

from wnn2hdl.report.plots import plot_pareto

POINTS = [(1, 0.93, "bit selection, 1 LUT"), (2, 0.94, "bit selection, 2 LUT"), (19, 0.87, "WiSARD, seed 15")]


def test_plot_is_a_picture_and_a_drawing(tmp_path: Path) -> None:
    picture, drawing = plot_pareto(POINTS, POINTS[:2], tmp_path / "front")
    with Image.open(picture) as opened:
        assert opened.format == "PNG"
        assert opened.width > opened.height
    text = drawing.read_text()
    assert text.startswith("<?xml")
    assert {path.name for path in tmp_path.iterdir()} == {"front.png", "front.svg"}


def test_the_drawing_follows_the_theme_and_the_picture_is_white(tmp_path: Path) -> None:
    picture, drawing = plot_pareto(POINTS, POINTS[:2], tmp_path / "front")
    with Image.open(picture) as opened:
        assert opened.convert("RGB").getpixel((0, 0)) == (255, 255, 255)
    text = drawing.read_text()
    assert "@media (prefers-color-scheme: dark) { :root { color: #e6e9e6; background: #141716; } }" in text
    assert "fill: currentColor" in text
    assert "stroke: currentColor" in text
    assert not re.search(r"#(000000|000001|ffffff)", text)


def test_same_points_give_the_same_bytes(tmp_path: Path) -> None:
    for name in ("one", "two"):
        plot_pareto(POINTS, POINTS[:2], tmp_path / name)
    for suffix in (".png", ".svg"):
        assert (tmp_path / f"one{suffix}").read_bytes() == (tmp_path / f"two{suffix}").read_bytes()
