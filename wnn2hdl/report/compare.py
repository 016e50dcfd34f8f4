"""Two builds side by side: what changed."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from wnn2hdl.ir import MAX_TABLE_INPUTS, LutNetwork, codes_to_bits
from wnn2hdl.markdown import MISSING
from wnn2hdl.report.page import MANY_TABLES
from wnn2hdl.report.shell import form

_LEAST_POINTS = 0.0001


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
    latencies = [report.get("latency") for report in (first, second)]
    figures.append(_number("latency in cycles", *latencies, kind="count", good=-1))
    delays = [report["parts"][report["target"]]["delay_ps"] for report in (first, second)]
    figures.append(_number("logic delay of the target", *delays, kind="ps", good=-1))
    for what, key in (("accuracy of the circuit", "accuracy"), ("accuracy of the model", "model_accuracy")):
        figures.append(_number(what, first[key], second[key], kind="percent", good=1))
    codes = [report["care"]["codes"] for report in (first, second)]
    figures.append(_number("codes cared for", *codes, kind="count", good=0))
    coverages = [report["care"]["coverage"] for report in (first, second)]
    figures.append(_number("coverage of labelled pixels", *coverages, kind="percent", good=0))
    figures += _cubes(first["minimised"], second["minimised"])
    figures.append(_words("proof", first["proof"]["status"], second["proof"]["status"]))
    return {
        "Figures": tuple(x for x in figures if (x.before, x.after) != (MISSING, MISSING)),
        **{
            title: tuple(change for change in _mapping(first[key], second[key]) if change.change)
            for title, key in (("Options", "options"), ("Tools", "tools"), ("Files, SHA-256", "hashes"))
        },
    }


def _cubes(first: Mapping[str, Mapping[str, int]], second: Mapping[str, Mapping[str, int]]) -> list[Change]:
    """The product terms of each table, or of all together where there are many."""
    tables = dict.fromkeys([*first, *second])
    if len(tables) > MANY_TABLES:
        sums = [sum(sizes["cubes_after"] for sizes in minimised.values()) for minimised in (first, second)]
        return [_number(f"cubes of all {len(tables):,} tables", *sums, kind="count", good=0)]
    return [
        _number(
            f"cubes of {table}",
            *(minimised.get(table, {}).get("cubes_after") for minimised in (first, second)),
            kind="count",
            good=0,
        )
        for table in tables
    ]


def compare_tables(first: Mapping[str, LutNetwork], second: Mapping[str, LutNetwork]) -> tuple[Change, ...]:
    """Whether the networks of two builds compute the same, on all values of the inputs that either reads.

    Where there are many, those that do are counted in one line.

    Args:
        first: the networks of a build, by part.
        second: those of the other.
    """
    changes = []
    for part in dict.fromkeys([*first, *second]):
        one, other = first.get(part), second.get(part)
        text = "in one build only" if one is None or other is None else _difference(one, other)
        changes.append(Change(f"function of {part}", _size(one), _size(other), text))
    if len(changes) > MANY_TABLES:
        differing = [change for change in changes if change.change]
        same = f"{len(changes) - len(differing):,} of {len(changes):,}"
        return (*differing, Change("functions that are the same", same, same, ""))
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
    change = _points(difference) if kind == "percent" else f"{difference:+,}{' ps' * (kind == 'ps')}"
    judgement = "" if not good else "better" if difference * good > 0 else "worse"
    return Change(what, *texts, change.replace("-", "\N{MINUS SIGN}"), judgement)


def _points(difference: float) -> str:
    """A difference of two shares in percentage points: two decimals, or one digit where these would be 0."""
    points = 100 * difference
    if abs(points) < _LEAST_POINTS / 2:
        return f"less than {_LEAST_POINTS} points {'more' if points > 0 else 'fewer'}"
    text = f"{points:+.2f}" if abs(points) >= 0.01 else f"{float(f'{points:.1g}'):+.4f}"
    return f"{text.rstrip('0').rstrip('.')} points"


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
