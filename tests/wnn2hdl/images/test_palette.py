"""The colours of classes."""

import json
from pathlib import Path

import pytest

from wnn2hdl.errors import InputError
from wnn2hdl.images import CLASS_COLOURS, Palette
from wnn2hdl.images.codes import code_of


def test_a_palette_file_names_classes_in_order(tmp_path: Path) -> None:
    (tmp_path / "p.json").write_text(json.dumps({"forest": "#000000", "river": "#0000ff", "road": "white"}))
    palette = Palette.read(tmp_path / "p.json")
    assert palette.names == ("forest", "river", "road")
    assert palette.colours == ((0, 0, 0), (0, 0, 255), (255, 255, 255))
    assert palette.mask_codes == Palette(palette.names, palette.colours).mask_codes


def test_a_palette_file_gives_the_numbers_of_land_cover_products(tmp_path: Path) -> None:
    entries = {"forest": [3, 4], "deforested": 15, "river": ["#0000ff", 33], "ignore": 0}
    (tmp_path / "p.json").write_text(json.dumps(entries))
    palette = Palette.read(tmp_path / "p.json")
    assert palette.names == ("forest", "deforested", "river")
    assert palette.mask_codes == ((3, 4), (15,), (code_of((0, 0, 255)), 33))
    assert palette.ignored == {0}
    assert palette.colours == (CLASS_COLOURS["forest"], CLASS_COLOURS["deforested"], (0, 0, 255))


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ({"forest": "#000"}, "2 to 255 classes"),
        ({"forest": "#000", "river": "wet"}, "gives 'river' no colour"),
        ({"forest": "#000", "river": 7.5}, "gives 'river' no colour"),
        ({"forest": "#000", "river": []}, "gives 'river' no colour"),
        ({"forest": "#000", "river": True}, "gives 'river' no colour"),
        ({"forest": 3, "river": [15, 3]}, "share a colour or a number"),
        ({"forest": 3, "ignore": 0}, "2 to 255 classes"),
        ({"forest": "#000", "river": "#000000"}, "share a colour"),
    ],
)
def test_bad_palettes_are_refused(tmp_path: Path, entries: dict[str, object], message: str) -> None:
    (tmp_path / "p.json").write_text(json.dumps(entries))
    with pytest.raises(InputError, match=message):
        Palette.read(tmp_path / "p.json")
