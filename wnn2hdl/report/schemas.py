"""Checking the JSON objects that come back from disk."""

import json
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import jsonschema

from wnn2hdl.errors import ModelFileError
from wnn2hdl.files import read_json


def load_report(path: Path) -> dict[str, Any]:
    """The report of a file; raises ModelFileError if it is missing or damaged, and as `check_report`."""
    report = read_json(path, "a report")
    check_report(report, path)
    return report


def check_report(report: Mapping[str, Any], path: Path) -> None:
    """Raise ModelFileError unless an object is a report that this version of wnn2hdl understands."""
    hint = "compile the model again with this wnn2hdl"
    check(report, "report", path, hint)
    if report["target"] not in report["parts"]:
        raise ModelFileError(
            "not a report, or one of another version",
            value=f"{path} (the target {report['target']} is not one of its parts)",
            hint=hint,
        )


def check(data: Mapping[str, Any], name: str, path: Path, hint: str) -> None:
    """Check an object against a schema of this package.

    Args:
        data: the object.
        name: of the schema: ``baseline`` or ``report``.
        path: the file it was read from.
        hint: what to do about a damaged one.

    Raises:
        ModelFileError: it does not fit.
    """
    error = jsonschema.exceptions.best_match(_validator(name).iter_errors(data))
    if error is not None:
        where = "/".join(str(step) for step in error.absolute_path) or "the top level"
        raise ModelFileError(
            f"not a {name}, or one of another version",
            value=f"{path} (at {where}: {error.message[:120]})",
            hint=hint,
        )


@cache
def _validator(name: str) -> jsonschema.Draft202012Validator:
    text = files(__package__).joinpath(f"{name}.schema.json").read_text(encoding="utf-8")
    return jsonschema.Draft202012Validator(json.loads(text))
