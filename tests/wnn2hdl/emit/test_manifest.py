"""The manifest notices what changed."""

from pathlib import Path

import pytest

from wnn2hdl.emit import MANIFEST_NAME, check, manifest, write_manifest
from wnn2hdl.errors import InputError, ModelFileError


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "block.v").write_text("module block; endmodule\n")
    (tmp_path / "report.json").write_text("{}\n")
    write_manifest(
        tmp_path, ["report.json", "block.v"], versions={"yosys": "0.70"}, options={"mode": "exact"}
    )
    return tmp_path


def test_it_names_files_versions_and_options() -> None:
    data = manifest({"b": b"", "a": b"x"}, versions={"z": "1", "y": "2"}, options={"mode": "exact"})
    assert list(data["files"]) == ["a", "b"]
    assert data["files"]["b"] == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"
    assert data["versions"] == {"y": "2", "z": "1"}
    assert data["options"] == {"mode": "exact"}


def test_an_untouched_folder_has_no_differences(folder: Path) -> None:
    assert check(folder) == []


def test_changed_and_missing_files_are_named(folder: Path) -> None:
    (folder / "block.v").write_text("module clock; endmodule\n")
    (folder / "report.json").unlink()
    assert check(folder) == ["block.v was changed", "report.json is missing"]


def test_files_that_may_differ_are_passed_over(folder: Path) -> None:
    (folder / "block.v").write_text("module clock; endmodule\n")
    (folder / "report.json").unlink()
    assert check(folder, besides={"report.json"}) == ["block.v was changed"]


def test_without_a_manifest_nothing_can_be_checked(folder: Path) -> None:
    (folder / MANIFEST_NAME).write_text("[]")
    with pytest.raises(ModelFileError, match="not a manifest"):
        check(folder)
    (folder / MANIFEST_NAME).write_text("{}")
    with pytest.raises(ModelFileError, match="not a manifest"):
        check(folder)


def test_a_file_that_is_not_there_cannot_be_listed(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot read"):
        write_manifest(tmp_path, ["absent.v"], versions={}, options={})
