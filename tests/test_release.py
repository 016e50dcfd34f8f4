"""What a release needs fits together: one version, workflows that servers can read, files that exist."""

import re
import tomllib
from pathlib import Path
from typing import Any

import pytest
import yaml

import wnn2hdl

ROOT = Path(__file__).parents[1]
GITHUB = ROOT / ".github"


def read(path: Path) -> Any:
    return yaml.safe_load(path.read_text(encoding="utf-8"))


def test_the_citation_has_the_package_s_version() -> None:
    citation = read(ROOT / "CITATION.cff")
    assert citation["version"] == wnn2hdl.__version__
    assert citation["license"] == "MIT"


def test_the_changelog_begins_with_what_is_not_released_or_this_version() -> None:
    first = re.search(r"^## (\S+)", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert first is not None
    assert first[1] in {"Unreleased", wnn2hdl.__version__}


def test_the_release_tries_the_pythons_that_the_package_names() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    named = re.findall(r"Python :: (3\.\d+)", "\n".join(project["classifiers"]))
    steps = read(GITHUB / "workflows" / "release.yml")["jobs"]["build"]["steps"]
    (smoke,) = [step["run"] for step in steps if step.get("run", "").startswith(".ci/smoke")]
    assert smoke.split()[1:] == [f"python{version}" for version in named]
    assert (ROOT / ".ci" / "smoke").stat().st_mode & 0o100


def test_a_tag_must_name_the_version() -> None:
    steps = read(GITHUB / "workflows" / "release.yml")["jobs"]["build"]["steps"]
    (check,) = [step["run"] for step in steps if "GITHUB_REF_NAME" in step.get("run", "")]
    line = re.search(r'grep -qxF "(.*)" (\S+)', check)
    assert line is not None
    wanted = line[1].replace('\\"', '"').replace("${GITHUB_REF_NAME#v}", wnn2hdl.__version__)
    assert wanted in (ROOT / line[2]).read_text(encoding="utf-8").splitlines()


@pytest.mark.parametrize("name", ["fault.yml", "wish.yml"])
def test_a_form_asks_each_question_once(name: str) -> None:
    form = read(GITHUB / "ISSUE_TEMPLATE" / name)
    questions = [item["id"] for item in form["body"]]
    assert len(questions) == len(set(questions)) > 0


def test_files_that_contributors_are_led_to_exist() -> None:
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    named = re.findall(r"\]\(([^)]+)\)", text) + re.findall(
        r"`((?:wnn2hdl|hdl_templates|benchmarks)/[^`]+)`", text
    )
    assert [name for name in named if "NAME" not in name and not (ROOT / name).exists()] == []
