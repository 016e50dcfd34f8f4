"""The gate: whether builds are as good as they were, and as good as they must be."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from wnn2hdl.report.baseline import Recorded, recorded


@dataclass(frozen=True)
class Limits:
    """What is asked of every build.

    Attributes:
        max_luts: LUTs that the build's target may take; None for any number.
        min_accuracy: least accuracy of the circuit, 0 to 1; None for any, measured or not.
        max_regress: LUTs by which a part may rise above the baseline.
    """

    max_luts: int | None = None
    min_accuracy: float | None = None
    max_regress: int = 0


@dataclass(frozen=True)
class Check:
    """One thing that was looked at.

    Attributes:
        build: the name of the build.
        name: what was looked at; together with the build it occurs once.
        passed: whether it is as it must be.
        text: what was found, and what it was measured by.
        better: whether it passed with something to spare, so that the baseline could be written again.
    """

    build: str
    name: str
    passed: bool
    text: str
    better: bool = False


def run_gate(
    reports: Mapping[str, Mapping[str, Any]],
    changes: Mapping[str, Sequence[str]],
    limits: Limits,
    baseline: Mapping[str, Recorded] | None,
) -> tuple[Check, ...]:
    """Look at all builds.

    A build whose files were changed fails: what was proved and counted is no longer there. With a
    baseline, a build or part that only one side knows fails: an unrecorded build would not be guarded, and
    one that is gone would silently stop being guarded.

    Args:
        reports: the objects of `report.json` by the name of the build.
        changes: for each build which of its files were changed after it was made, one line each.
        limits: what is asked of every build.
        baseline: what was recorded; None if nothing was.

    Returns:
        The checks, by build in the order given, then builds that only the baseline knows.
    """
    checks: list[Check] = []
    for name, report in reports.items():
        checks += _of_build(name, report, changes[name], limits)
        if baseline is not None:
            checks += _against(name, recorded(report), baseline.get(name), limits.max_regress)
    for name in sorted(set(baseline or {}) - set(reports)):
        checks.append(Check(name, "build", False, "in the baseline, but not among the builds"))
    return tuple(checks)


def _of_build(
    name: str, report: Mapping[str, Any], changes: Sequence[str], limits: Limits
) -> Iterator[Check]:
    status, failure = report["proof"]["status"], report["proof"].get("failure")
    proved = status == "proved"
    text = "proved equal to the model" if proved else f"{status}, not proved equal to the model"
    reason = failure or ", ".join(report["proof"].get("unproved", []))
    yield Check(name, "proof", proved, f"{text}: {reason}" if reason else text)
    yield Check(name, "files", not changes, ", ".join(changes) or "as they were written")
    target = report["target"]
    if limits.max_luts is not None:
        luts = report["parts"][target]["luts"]
        taken = "was not counted" if luts is None else f"takes {luts} LUTs"
        text = f"the {target} {taken}, allowed are {limits.max_luts}"
        yield Check(name, "max-luts", luts is not None and luts <= limits.max_luts, text)
    if limits.min_accuracy is not None:
        accuracy = report["accuracy"]
        text = f"{_share(accuracy)}, at least {limits.min_accuracy:.8g} is asked for"
        yield Check(name, "min-accuracy", accuracy is not None and accuracy >= limits.min_accuracy, text)


def _against(name: str, now: Recorded, before: Recorded | None, max_regress: int) -> Iterator[Check]:
    if before is None:
        yield Check(name, "build", False, "not in the baseline; record it with --write-baseline")
        return
    kinds = [f"{build.target}, {build.mode} mode" for build in (now, before)]
    yield Check(name, "build", kinds[0] == kinds[1], " and in the baseline ".join(dict.fromkeys(kinds)))
    for part in sorted({*now.luts, *before.luts}):
        yield _part(name, part, now.luts.get(part), before.luts.get(part), max_regress)
    if before.accuracy is not None:
        kept = now.accuracy is not None and now.accuracy >= before.accuracy
        better = kept and now.accuracy != before.accuracy
        text = f"{_share(now.accuracy)}, in the baseline {_share(before.accuracy)}"
        yield Check(name, "accuracy", kept, text, better)


def _part(name: str, part: str, now: int | None, before: int | None, max_regress: int) -> Check:
    check = f"luts of {part}"
    if now is None:
        return Check(name, check, False, f"not measured, in the baseline {before}")
    if before is None:
        return Check(name, check, False, f"{now}, not in the baseline; record it with --write-baseline")
    allowed = f" and allowed to rise by {max_regress}" if max_regress else ""
    text = f"{now}, in the baseline {before}{allowed}"
    return Check(name, check, now <= before + max_regress, text, now < before)


def _share(share: float | None) -> str:
    # A fall may be of one pixel among millions.
    return "not measured" if share is None else f"{share:.8g}"
