"""What a scan found, for programs and for people."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from wnn2hdl.apps.deforestation.areas import ClassArea
from wnn2hdl.apps.deforestation.change import Change
from wnn2hdl.apps.deforestation.mapping import Coverage
from wnn2hdl.dataset import cleared_classes
from wnn2hdl.markdown import MISSING, escaped, table

FAMILIAR_SHARE = 0.9
"""Imagery with a smaller share of pixels whose colours the classifier knows is foreign to it.

Measured with the 4-bit codes that occur in 20 Sentinel-2 scenes, or in 60 Planet chips: of every other scene
of the Amazon by Sentinel-2 they cover at least 0.91; of a view from another camera 0.84, of a Chinese town
from the air 0.53 to 0.69, of farmland in near-infrared false colour 0.04 to 0.79.
"""


def class_figures(areas: Sequence[ClassArea]) -> dict[str, Any]:
    """Pixels, share and hectares of each class and of all that is deforested.

    Shares are of the classified pixels, None where there are none; hectares are None without a georeference.
    """
    valid = sum(area.pixels for area in areas)
    cleared = [areas[index] for index in cleared_classes([area.name for area in areas])]
    whole = ClassArea(
        "deforested", sum(area.pixels for area in cleared), _sum(area.hectares for area in cleared)
    )
    return {
        "classified_pixels": valid,
        "classes": [_figures(area, valid) for area in areas],
        "deforested": {
            **_figures(whole, valid),
            "classes": [area.name for area in cleared],
        },
    }


def coverage_figures(coverage: Coverage) -> dict[str, Any]:
    """How familiar the imagery is to the classifier, and a warning if it is foreign."""
    share = coverage.share
    return {
        "share": share,
        "threshold": FAMILIAR_SHARE,
        "foreign": share is not None and share < FAMILIAR_SHARE,
    }


def warnings(note: str, coverage: Coverage) -> list[str]:
    """What a reader must know before believing the figures."""
    found = [note] if note else []
    share = coverage.share
    if share is None:
        found.append("no pixel is valid, so nothing was classified")
    elif share < FAMILIAR_SHARE:
        found.append(
            f"the imagery is foreign to the model: it knows the colours of {share:.1%} of the pixels, "
            f"of familiar imagery at least {FAMILIAR_SHARE:.0%}; train on imagery of this kind"
        )
    return found


def change_figures(change: Change) -> dict[str, Any]:
    """What was cleared and has regrown between two dates."""
    return {
        "compared_pixels": change.compared_pixels,
        "newly_cleared": _figures(change.newly_cleared, change.compared_pixels),
        "regrown": _figures(change.regrown, change.compared_pixels),
    }


@dataclass(frozen=True)
class Totals:
    """What several pictures show together.

    Attributes:
        areas: of each class, ground that several pictures show counted once.
        pictures_added: all classes of all pictures added up, that ground counted as often as it is shown.
        sharing: how many pictures share ground with one that comes after them.
    """

    areas: Sequence[ClassArea]
    pictures_added: ClassArea
    sharing: int

    @property
    def overlap(self) -> ClassArea:
        """What is left out of the totals, because a later picture shows it as well."""
        once = summed(self.areas)
        hectares = None
        if once.hectares is not None and self.pictures_added.hectares is not None:
            hectares = self.pictures_added.hectares - once.hectares if self.sharing else 0.0
        return ClassArea("overlap", self.pictures_added.pixels - once.pixels, hectares)

    def warnings(self, pictures: int) -> list[str]:
        """What a reader must know of them."""
        if not self.sharing:
            return []
        shared = self.overlap
        size = f"{shared.pixels:,} pixels" if shared.hectares is None else f"{_area(shared.hectares)} ha"
        return [
            f"{self.sharing} of {pictures} pictures share ground with later ones (by name): {size} are "
            "counted once, as the last picture shows them"
        ]


def overlap_figures(totals: Totals) -> dict[str, Any]:
    """The ground that several pictures show; pictures without a georeference are taken to lie apart."""
    shared = totals.overlap
    return {"pictures": totals.sharing, "pixels": shared.pixels, "hectares": shared.hectares}


def summed(areas: Sequence[ClassArea]) -> ClassArea:
    """The sum of areas under the first one's name; there is one at least."""
    return ClassArea(areas[0].name, sum(area.pixels for area in areas), _sum(area.hectares for area in areas))


def page(summary: Mapping[str, Any]) -> str:
    """The summary of one picture, or of a folder of them, in Markdown."""
    cleared = summary["deforested"]
    # The total of one class would only repeat it.
    totals = [cleared] if len(cleared["classes"]) != 1 else []
    sections = [
        f"# Scan of {escaped(summary['input'])}",
        "\n".join(f"**Warning:** {escaped(warning)}." for warning in summary["warnings"]),
        _sentence(summary),
        table(
            ["class", "pixels", "share", "hectares"],
            (
                [entry["class"], f"{entry['pixels']:,}", _percent(entry["share"]), _area(entry["hectares"])]
                for entry in [*summary["classes"], *totals]
            ),
        ),
        _deforested(cleared["classes"]) if len(summary["classes"]) > 2 else "",
    ]
    if "change" in summary:
        sections += ["## Change", f"Against {escaped(summary['before'])}.", _change(summary["change"])]
    if "pictures" in summary:
        rows = (
            [
                x["input"],
                _percent(x["deforested"]["share"]),
                _area(x["deforested"]["hectares"]),
                _percent(x["coverage"]["share"]),
            ]
            for x in summary["pictures"]
        )
        sections += ["## Pictures", table(["picture", "deforested", "hectares", "familiar"], rows)]
    sections += ["## How", table(["", ""], how(summary).items())]
    return "\n\n".join(section for section in sections if section) + "\n"


def _sentence(summary: Mapping[str, Any]) -> str:
    cleared, coverage = summary["deforested"], summary["coverage"]
    hectares = f", {_area(cleared['hectares'])} ha" if cleared["hectares"] is not None else ""
    return (
        f"{_percent(cleared['share'])} of {summary['classified_pixels']:,} classified pixels are deforested"
        f"{hectares}. The model knows the colours of {_percent(coverage['share'])} of them."
    )


def _deforested(names: Sequence[str]) -> str:
    return f"Deforested are the classes {escaped(', '.join(names))}."


def _change(change: Mapping[str, Any]) -> str:
    return table(
        ["", "pixels", "share of the compared pixels", "hectares"],
        (
            [name, f"{x['pixels']:,}", _percent(x["share"]), _area(x["hectares"])]
            for name, x in (("newly cleared", change["newly_cleared"]), ("regrown", change["regrown"]))
        ),
    )


def how(summary: Mapping[str, Any]) -> dict[str, str]:
    """With what model, options and versions a scan was made, by name."""
    return {
        "model": f"{summary['model']['path']}, SHA-256 {summary['model']['sha256']}",
        **{key: "none" if value is None else str(value) for key, value in summary["options"].items()},
        **{f"version of {name}": version for name, version in summary["versions"].items()},
    }


def _figures(area: ClassArea, whole: int) -> dict[str, Any]:
    return {
        "class": area.name,
        "pixels": area.pixels,
        "share": area.pixels / whole if whole else None,
        "hectares": area.hectares,
    }


def _sum(values: Iterable[float | None]) -> float | None:
    """The sum, None if one is unknown or there are none."""
    known = list(values)
    return None if None in known or not known else sum(value for value in known if value is not None)


def _percent(share: float | None) -> str:
    return MISSING if share is None else f"{share:.2%}"


def _area(hectares: float | None) -> str:
    return MISSING if hectares is None else f"{hectares:,.2f}"
