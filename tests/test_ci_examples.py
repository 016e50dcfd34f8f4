"""The workflow files in examples/ci are what build servers read, and their commands are ours."""

import re
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import click
import pytest
import yaml

from wnn2hdl.cli.main import app

FOLDER = Path(__file__).parents[1] / "examples" / "ci"


def read(name: str) -> Any:
    return yaml.safe_load((FOLDER / name).read_text(encoding="utf-8"))


def parsed(words: list[str]) -> click.Context:
    """A call of wnn2hdl as click understands it."""
    command = app.get_command(click.Context(app), words[0])
    assert command is not None, words
    return command.make_context(words[0], words[1:])


def variables(data: dict[str, Any]) -> dict[str, str]:
    """What a workflow sets for its commands."""
    return {**data.get("env", {}), **data.get("circuits", {}).get("variables", {})}


def calls(data: Any, known: dict[str, str]) -> Iterator[list[str]]:
    """The words of every call of wnn2hdl in a workflow."""
    if isinstance(data, dict):
        for value in data.values():
            yield from calls(value, known)
    elif isinstance(data, list):
        for value in data:
            yield from calls(value, known)
    elif isinstance(data, str) and data.startswith("wnn2hdl "):
        yield shlex.split(re.sub(r"\$(\w+)", lambda match: known[match[1]], data))[1:]


@pytest.mark.parametrize("name", ["github-actions.yml", "gitlab-ci.yml"])
def test_every_command_can_be_given(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "build" / "forest").mkdir(parents=True)
    monkeypatch.chdir(tmp_path)
    data = read(name)
    given = [parsed(words) for words in calls(data, variables(data))]
    assert {context.info_name for context in given} == {"compile", "report"}
    for context in given:
        if context.info_name == "report":
            assert context.params["baseline"] == Path("baseline.json")
            assert (context.params["max_luts"], context.params["min_accuracy"]) == (21, 0.9)


def test_a_wrong_option_would_be_noticed(tmp_path: Path) -> None:
    (words,) = calls({"script": [f"wnn2hdl report {tmp_path} $GATE"]}, {"GATE": "--max-lut 21"})
    with pytest.raises(click.NoSuchOption):
        parsed(words)


def test_github_shows_what_the_gate_wrote() -> None:
    data = read("github-actions.yml")
    # YAML 1.1 takes the key `on` for true.
    assert data[True] == ["push", "pull_request"]
    steps = {step.get("name"): step for step in data["jobs"]["circuits"]["steps"]}
    assert "--format markdown -o build/gate.md" in steps["Gate"]["run"]
    assert steps["Summary"]["run"] == 'cat build/gate.md >> "$GITHUB_STEP_SUMMARY"'
    assert steps["Summary"]["if"].startswith("always()")


def test_gitlab_reads_what_the_gate_wrote() -> None:
    job = read("gitlab-ci.yml")["circuits"]
    assert "--format junit -o build/gate.xml" in job["script"][-1]
    assert job["artifacts"]["reports"]["junit"] == "build/gate.xml"
    assert job["artifacts"]["when"] == "always"
