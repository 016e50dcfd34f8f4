"""Two builds side by side: what changed."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from wnn2hdl.ir import MAX_TABLE_INPUTS, LutNetwork, codes_to_bits
from wnn2hdl.report.page import MISSING, form


@dataclass(frozen=True)
class Change:
    """A line of a comparison.

    Attributes:
        what: is compared.
        before: of the first build, as a person reads it.
        after: of the second.
        change: what changed, in words; empty if nothing did.
        judgement: ``better``, ``worse`` or, where neither can be said, empty.
    """

    what: str
    before: str
    after: str
    change: str
    judgement: str = ""


def compare(first: Mapping[str, Any], second: Mapping[str, Any]) -> dict[str, tuple[Change, ...]]:
    """What two reports tell apart, by section: of figures all that one has, of the others those that differ.

    Args:
        first: the object of a `report.json`.
        second: that of the other build.
    """
    figures = [
        _words("target", first["target"], second["target"]),
        _words("mode", first["mode"], second["mode"]),
    ]
    for part in dict.fromkeys([*first["parts"], *second["parts"]]):
        luts = [report["parts"].get(part, {}).get("luts") for report in (first, second)]
        if luts != [None, None]:
            figures.append(_number(f"LUTs of {part}", *luts, kind="count", good=-1))
    delays = [report["parts"][report["target"]]["delay_ps"] for report in (first, second)]
    figures.append(_number("logic delay of the target", *delays, kind="ps", good=-1))
    for what, key in (("accuracy of the circuit", "accuracy"), ("accuracy of the model", "model_accuracy")):
        figures.append(_number(what, first[key], second[key], kind="percent", good=1))
    codes = [report["care"]["codes"] for report in (first, second)]
    figures.append(_number("codes cared for", *codes, kind="count", good=0))
    coverages = [report["care"]["coverage"] for report in (first, second)]
    figures.append(_number("coverage of labelled pixels", *coverages, kind="percent", good=0))
    for table in dict.fromkeys([*first["minimised"], *second["minimised"]]):
        cubes = [report["minimised"].get(table, {}).get("cubes_after") for report in (first, second)]
        figures.append(_number(f"cubes of {table}", *cubes, kind="count", good=0))
    figures.append(_words("proof", first["proof"]["status"], second["proof"]["status"]))
    return {
        "Figures": tuple(x for x in figures if (x.before, x.after) != (MISSING, MISSING)),
        **{
            title: tuple(change for change in _mapping(first[key], second[key]) if change.change)
            for title, key in (("Options", "options"), ("Tools", "tools"), ("Files, SHA-256", "hashes"))
        },
    }


def compare_tables(first: Mapping[str, LutNetwork], second: Mapping[str, LutNetwork]) -> tuple[Change, ...]:
    """Whether the networks of two builds compute the same, on all values of the inputs that either reads.

    Args:
        first: the networks of a build, by part.
        second: those of the other.
    """
    changes = []
    for part in dict.fromkeys([*first, *second]):
        one, other = first.get(part), second.get(part)
        text = "in one build only" if one is None or other is None else _difference(one, other)
        changes.append(Change(f"function of {part}", _size(one), _size(other), text))
    return tuple(changes)


def _size(network: LutNetwork | None) -> str:
    return MISSING if network is None else f"{network.depth} deep, LUTs: {len(network.luts)}"


def _difference(one: LutNetwork, other: LutNetwork) -> str:
    """In how many rows of a common truth table two networks differ, in words; empty if in none."""
    if [name for name, _ in one.outputs] != [name for name, _ in other.outputs]:
        return "other outputs"
    names = tuple(dict.fromkeys([*_read(one), *_read(other)]))
    if len(names) > MAX_TABLE_INPUTS:
        return f"not compared: {len(names)} inputs together"
    bits = codes_to_bits(np.arange(1 << len(names)), len(names))
    answers = []
    for network in (one, other):
        codes = np.zeros(len(bits), dtype=np.int64)
        for position, name in enumerate(network.inputs):
            if name in names:
                codes |= bits[:, names.index(name)].astype(np.int64) << position
        answers.append(network.evaluate(codes))
    rows = int((answers[0] != answers[1]).any(axis=1).sum())
    return f"differ in {rows:,} of {len(bits):,} rows, {100 * rows / len(bits):.1f} %" if rows else ""


def _read(network: LutNetwork) -> list[str]:
    """The inputs that a network reads."""
    used = {name for lut in network.luts for name in lut.inputs} | {mux.select for mux in network.muxes}
    used |= {signal for _, signal in network.outputs}
    return [name for name in network.inputs if name in used]


def _number(what: str, before: float | None, after: float | None, *, kind: str, good: int) -> Change:
    texts = form(before, kind), form(after, kind)
    if before is None or after is None or before == after:
        return Change(what, *texts, "" if before == after else "measured in one build only")
    difference = after - before
    points = f"{100 * difference:+.{2 if abs(difference) >= 1e-4 else 8}f}".rstrip("0").rstrip(".")
    told = f"{points} points" if kind == "percent" else f"{difference:+,}{' ps' * (kind == 'ps')}"
    judgement = "" if not good else "better" if difference * good > 0 else "worse"
    return Change(what, *texts, told.replace("-", "\N{MINUS SIGN}"), judgement)


def _words(what: str, before: Any, after: Any) -> Change:
    return Change(what, form(before, "text"), form(after, "text"), "" if before == after else "differs")


def _mapping(first: Mapping[str, Any], second: Mapping[str, Any]) -> list[Change]:
    changes = []
    for key in dict.fromkeys([*first, *second]):
        before, after = first.get(key), second.get(key)
        if isinstance(before, Mapping) and isinstance(after, Mapping):
            changes += [
                Change(f"{key}, {change.what}", change.before, change.after, change.change)
                for change in _mapping(before, after)
            ]
        else:
            changes.append(_words(key, before, after))
    return changes
