import sys
from pathlib import Path

import pytest
from PIL import Image

from wnn2hdl.errors import ExtraMissingError
from wnn2hdl.report.plots import plot_pareto

POINTS = [(1, 0.93, "bit selection, 1 LUT"), (2, 0.94, "bit selection, 2 LUT"), (19, 0.87, "WiSARD, seed 15")]


def test_plot_is_a_picture_and_a_drawing(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    picture, drawing = plot_pareto(POINTS, POINTS[:2], tmp_path / "front")
    with Image.open(picture) as opened:
        assert opened.format == "PNG"
        assert opened.width > opened.height
    text = drawing.read_text()
    assert text.startswith("<?xml")
    assert {path.name for path in tmp_path.iterdir()} == {"front.png", "front.svg"}


def test_same_points_give_the_same_bytes(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    for name in ("one", "two"):
        plot_pareto(POINTS, POINTS[:2], tmp_path / name)
    for suffix in (".png", ".svg"):
        assert (tmp_path / f"one{suffix}").read_bytes() == (tmp_path / f"two{suffix}").read_bytes()


def test_missing_matplotlib_is_named_with_its_extra(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(
        ExtraMissingError, match=r"plots need Matplotlib; install it with: pip install 'wnn2hdl\[plot\]'"
    ):
        plot_pareto(POINTS, POINTS[:2], tmp_path / "front")
