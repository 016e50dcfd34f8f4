import json
import lzma
from collections.abc import Callable, Iterator
from importlib.metadata import EntryPoint, EntryPoints
from pathlib import Path

import numpy as np
import pytest

from wnn2hdl.errors import InputError
from wnn2hdl.importers import Importer, ImportOptions, Source, formats, import_model, known_formats
from wnn2hdl.ir.models import LogicModel

NOT = ".model not\n.inputs a\n.outputs y\n.names a y\n0 1\n.end\n"

wire = LogicModel(("a",), ("y",), np.empty((0, 2), dtype=np.uint32), np.array([2], dtype=np.uint32))
toy = Importer("toy", "a toy", lambda source: b".model" in source.content, lambda *_: wire)
namesake = Importer("blif", "another BLIF", lambda _: False, lambda *_: wire)
no_importer = "a text"


@pytest.fixture
def install(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[str], None]]:
    """``install(NAME)`` makes this module's NAME an importer of another package."""

    def add(name: str) -> None:
        point = EntryPoint(name, f"{__name__}:{name}", formats.GROUP)
        monkeypatch.setattr(formats, "entry_points", lambda group: EntryPoints([point]).select(group=group))
        monkeypatch.setattr(EntryPoint, "load", lambda self: globals()[self.name])
        known_formats.cache_clear()

    yield add
    known_formats.cache_clear()


@pytest.mark.parametrize(
    ("content", "name"),
    [
        (json.dumps({"classes": {}, "addressSize": 2, "bleachingActivated": True}).encode(), "wisardpkg"),
        (lzma.compress(b"x"), "bthowen"),
        (lzma.compress(b"x", format=lzma.FORMAT_ALONE), "bthowen"),
        (json.dumps({"0_0_0": {"acive": 1, "values_int": [0, 1]}}).encode(), "kanele"),
        (b"aag 1 1 0 1 0\n", "aiger"),
        (b"aig 1 1 0 1 0\n", "aiger"),
        (NOT.encode(), "blif"),
        (b"# by a tool\n\n.inputs a\n", "blif"),
    ],
)
def test_a_format_is_recognised_by_content_alone(tmp_path: Path, content: bytes, name: str) -> None:
    path = tmp_path / "model.bin"
    path.write_bytes(content)
    recognised = [each.name for each in known_formats().values() if each.recognises(Source(path))]
    assert recognised == [name]


@pytest.mark.parametrize(
    "content",
    [b"", b"{}", b"[1]", b"{", b'{"addressSize": 3}', b"PK\3\4", b"\xff" * 99, b"a,b,label\n1,2,x\n"],
)
def test_a_file_of_no_known_format_gets_one_line(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "model.bin"
    path.write_bytes(content)
    with pytest.raises(
        InputError, match=r"of no format that can be imported: .*; give --format, one of wisardpkg, "
    ):
        import_model(path, ImportOptions())


def test_a_file_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"cannot read a model: .*none\.json \(No such file or directory\)"):
        import_model(tmp_path / "none.json", ImportOptions())
    with pytest.raises(InputError, match="cannot read a model"):
        import_model(tmp_path, ImportOptions())


def test_a_file_that_is_too_large(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("wnn2hdl.importers.base.MAX_FILE_BYTES", 10)
    path = tmp_path / "not.blif"
    path.write_text(NOT)
    with pytest.raises(InputError, match="the file is too large"):
        import_model(path, ImportOptions())


def test_a_named_format_is_not_guessed(tmp_path: Path) -> None:
    path = tmp_path / "not.blif"
    path.write_text(NOT)
    with pytest.raises(
        InputError, match=r"not an AIGER file, or a damaged one: .*the first line is not a header"
    ):
        import_model(path, ImportOptions(), "aiger")


def test_an_option_of_another_format_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "not.blif"
    path.write_text(NOT)
    with pytest.raises(InputError, match="an option does not apply to a network in BLIF: --bleach"):
        import_model(path, ImportOptions(bleach=2))


def test_another_packages_importer_is_known_and_ambiguity_refused(
    tmp_path: Path, install: Callable[[str], None]
) -> None:
    install("toy")
    path = tmp_path / "not.blif"
    path.write_text(NOT)
    with pytest.raises(InputError, match=r"could be of several formats: .*; give --format, one of blif, toy"):
        import_model(path, ImportOptions())
    assert import_model(path, ImportOptions(), "toy") == (toy, wire)


@pytest.mark.parametrize("name", ["namesake", "no_importer", "missing"])
def test_another_packages_broken_importer_gets_one_line(install: Callable[[str], None], name: str) -> None:
    install(name)
    with pytest.raises(InputError, match="importer"):
        known_formats()
