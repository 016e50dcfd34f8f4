"""A build in which a limit left something unproved: it says so, and no gate takes it for proved."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.small_networks import lut_network
from wnn2hdl.verify.equivalence import UNDECIDED, find_differences

Run = Callable[..., Any]


def first_undecided(*pairs: Any, **limits: Any) -> list[Any]:
    """What comparing gives, had the first pair reached a limit."""
    return [UNDECIDED, *find_differences(*pairs, **limits)[1:]]


@pytest.mark.slow
def test_what_a_limit_leaves_unproved_is_named_and_has_to_be_allowed(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("WNN2HDL_CACHE", str(tmp_path / "cache"))
    # All pieces of small networks are decided within any limit.
    monkeypatch.setattr("wnn2hdl.verify.proof.find_differences", first_undecided)
    monkeypatch.setattr("wnn2hdl.verify.proof.difference_of_graphs", lambda *_: UNDECIDED)
    model, build = tmp_path / "model.json", tmp_path / "build"
    lut_network(8).save(model)

    done = run("compile", model, "-o", build)
    assert done.status == 1
    assert "a limit left parts UNPROVED" in done.stderr
    report = json.loads((build / "report.json").read_text())
    assert report["proof"]["status"] == "UNPROVED"
    unproved = report["proof"]["unproved"]
    assert unproved == ["encoder", *(f"{part} netlist" for part in report["parts"] if part != "sobel")]
    assert "UNPROVED" in (build / "report.md").read_text()
    assert "UNPROVED" in (build / "report.html").read_text()

    named = [word for part in unproved for word in ("--allow-unproved", part)]
    allowed = run("verify", build, *named)
    assert allowed.status == 0
    assert "UNPROVED" in allowed.stdout
    assert run("verify", build).status == 1
    assert run("report", build, "--max-luts", 1000).status == 1
    monkeypatch.undo()
    assert run("verify", build).status == 1
