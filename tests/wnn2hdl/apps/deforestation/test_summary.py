"""What a summary counts as deforested, and what it warns of."""

from wnn2hdl.apps.deforestation.areas import ClassArea
from wnn2hdl.apps.deforestation.mapping import Coverage
from wnn2hdl.apps.deforestation.summary import (
    Totals,
    class_figures,
    coverage_figures,
    overlap_figures,
    summed,
    warnings,
)

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


def test_areas_add_up_and_one_without_a_place_hides_the_sum() -> None:
    assert summed([ClassArea("a", 2, 0.5), ClassArea("b", 3, 1.0)]) == ClassArea("a", 5, 1.5)
    assert summed([ClassArea("a", 2, 0.5), ClassArea("b", 3, None)]) == ClassArea("a", 5, None)


def test_what_pictures_share_is_what_all_show_less_what_is_counted() -> None:
    totals = Totals(AREAS, ClassArea("forest", 1500, 15.0), sharing=2)
    assert overlap_figures(totals) == {"pictures": 2, "pixels": 500, "hectares": 5.0}
    (warning,) = totals.warnings(3)
    assert warning.startswith("2 of 3 pictures share ground with later ones (by name): 5.00 ha are counted")
    apart = Totals(AREAS, summed(AREAS), sharing=0)
    assert overlap_figures(apart) == {"pictures": 0, "pixels": 0, "hectares": 0.0}
    assert apart.warnings(3) == []


def test_foreign_imagery_is_warned_of() -> None:
    assert warnings("", Coverage(100, 90)) == []
    (warning,) = warnings("", Coverage(1000, 899))
    assert "colours of 89.9% of the pixels" in warning
    assert warnings("a note", Coverage(100, 100)) == ["a note"]
