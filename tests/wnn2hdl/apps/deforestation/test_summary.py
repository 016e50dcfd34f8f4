"""What a summary counts as deforested, and what it warns of."""

import pytest

from wnn2hdl.apps.deforestation.areas import ClassArea
from wnn2hdl.apps.deforestation.mapping import Coverage
from wnn2hdl.apps.deforestation.summary import class_figures, coverage_figures, total_figures, warnings

AREAS = (
    ClassArea("forest", 600, 6.0),
    ClassArea("pasture", 250, 2.5),
    ClassArea("river", 100, 1.0),
    ClassArea("road", 50, 0.5),
)


def test_rivers_were_never_felled() -> None:
    figures = class_figures(AREAS)
    assert figures["classified_pixels"] == 1000
    assert figures["deforested"] == {
        "class": "deforested",
        "pixels": 300,
        "share": 0.3,
        "hectares": 3.0,
        "classes": ["pasture", "road"],
    }
    assert [entry["share"] for entry in figures["classes"]] == [0.6, 0.25, 0.1, 0.05]


def test_without_a_georeference_there_are_no_areas() -> None:
    figures = class_figures([ClassArea("forest", 3, None), ClassArea("deforested", 1, None)])
    assert figures["deforested"]["hectares"] is None
    assert figures["deforested"]["share"] == 0.25


def test_nothing_classified_has_no_share() -> None:
    figures = class_figures([ClassArea("forest", 0, None), ClassArea("deforested", 0, None)])
    assert figures["deforested"]["share"] is None
    assert coverage_figures(Coverage(0, 0)) == {"share": None, "threshold": 0.9, "foreign": False}


def test_pictures_add_up_and_one_without_a_place_hides_the_area() -> None:
    one, other = class_figures(AREAS), class_figures(AREAS)
    assert total_figures([one, other])["deforested"]["pixels"] == 600
    assert total_figures([one, other])["deforested"]["hectares"] == pytest.approx(6)
    other["classes"][1]["hectares"] = None
    assert total_figures([one, other])["deforested"]["hectares"] is None


def test_foreign_imagery_is_warned_of() -> None:
    assert warnings("", Coverage(100, 90)) == []
    (warning,) = warnings("", Coverage(1000, 899))
    assert "colours of 89.9% of the pixels" in warning
    assert warnings("a note", Coverage(100, 100)) == ["a note"]
