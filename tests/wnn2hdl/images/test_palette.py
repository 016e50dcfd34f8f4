"""The colours of classes."""

import json
from pathlib import Path

import pytest

from wnn2hdl.errors import InputError
from wnn2hdl.images import Palette


def test_a_palette_file_names_classes_in_order(tmp_path: Path) -> None:
    (tmp_path / "p.json").write_text(json.dumps({"forest": "#000000", "river": "#0000ff", "road": "white"}))
    palette = Palette.read(tmp_path / "p.json")
    assert palette == Palette(("forest", "river", "road"), ((0, 0, 0), (0, 0, 255), (255, 255, 255)))


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ({"forest": "#000"}, "2 to 256 classes"),
        ({"forest": "#000", "river": "wet"}, "gives 'river' no colour"),
        ({"forest": "#000", "river": 7}, "gives 'river' no colour"),
        ({"forest": "#000", "river": "#000000"}, "share a colour"),
    ],
)
def test_bad_palettes_are_refused(tmp_path: Path, entries: dict[str, object], message: str) -> None:
    (tmp_path / "p.json").write_text(json.dumps(entries))
    with pytest.raises(InputError, match=message):
        Palette.read(tmp_path / "p.json")
