"""Networks of features become builds like all others."""

import json
from pathlib import Path

import numpy as np
import pytest

from tests.small_networks import bloom, lut_network
from tests.small_sums import sum_network
from wnn2hdl.build.compile import compile_model
from wnn2hdl.build.planning import CompileOptions, with_input
from wnn2hdl.build.verification import verify_build
from wnn2hdl.dataset.tables import read_table
from wnn2hdl.errors import InputError
from wnn2hdl.importers import ImportOptions, Source
from wnn2hdl.importers.bthowen import read
from wnn2hdl.ir import ThermometerBits
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.ir.models import BloomWisardModel, LogicModel, LutGroupModel
from wnn2hdl.training.bthowen import with_thresholds


def silent(step: str, done: int, total: int) -> None:
    pass


@pytest.mark.slow
def test_a_network_is_built_proved_and_verified(tmp_path: Path) -> None:
    folder = tmp_path / "net"
    built = compile_model(lut_network(2), folder, CompileOptions(input="Q2.4"), silent)
    assert built.failure is None
    report = json.loads((folder / "report.json").read_text())
    pieces = {"encoder", "tables", "sum_0", "winner"}
    assert set(report["parts"]) == {*pieces, "core", "network", "sobel"}
    assert report["proof"]["status"] == "proved"
    assert report["options"]["simulated_vectors"] == {"network": 10_240}
    assert (folder / "net.v").read_text().count("module net_") >= 3
    assert verify_build(folder, silent)[0] == []


@pytest.mark.slow
def test_bloom_filters_are_built_proved_and_verified(tmp_path: Path) -> None:
    folder = tmp_path / "net"
    built = compile_model(bloom(1), folder, CompileOptions(effort=0), silent)
    assert built.failure is None
    assert set(built.report["parts"]) == {
        *("encoder", "hashes", "tables", "sum_0", "winner", "core", "network", "sobel")
    }
    assert built.report["proof"]["status"] == "proved"
    assert verify_build(folder, silent)[0] == []


@pytest.mark.slow
def test_a_pipeline_of_bloom_filters_is_proved(tmp_path: Path) -> None:
    built = compile_model(bloom(1), tmp_path / "net", CompileOptions(effort=0, stages=2), silent)
    assert (built.failure, built.report["proof"]["status"]) == (None, "proved")


def test_a_model_too_large_for_the_device_is_refused_before_work(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    contents = rng.random((20, 20, 4096)) < 0.5
    mapping = np.arange(480, dtype=np.int32).reshape(20, 24)
    hashes = rng.integers(0, 4096, (2, 24)).astype(np.uint32)
    classes = tuple("abcdefghijklmnopqrst")
    model = BloomWisardModel(ThermometerBits(480, 1), classes, mapping, hashes, contents)
    with pytest.raises(InputError, match=r"about 5\d,\d+ of the 53,200 of an xc7z020.*--max-luts"):
        compile_model(model, tmp_path / "net", CompileOptions(), silent)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.realdata
@pytest.mark.slow
def test_a_published_model_is_proved_with_its_thresholds(realdata: Path, tmp_path: Path) -> None:
    source = Source(realdata / "bthowen" / "iris.pickle.lzma")
    rows = realdata / "uci" / "iris.csv"
    model = with_thresholds(read(source, ImportOptions()), read_table(rows, "label"))
    options = CompileOptions(effort=0, input="UQ3.5", test_table=rows, label="label")
    built = compile_model(model, tmp_path / "net", options, silent)
    assert (built.failure, built.report["proof"]["status"]) == (None, "proved")
    assert built.report["parts"]["network"]["luts"] < 57
    assert built.report["accuracy"] > 0.97


@pytest.mark.slow
def test_a_pipeline_is_built_proved_verified_and_changes_are_found(tmp_path: Path) -> None:
    folder = tmp_path / "net"
    built = compile_model(lut_network(2), folder, CompileOptions(input="Q2.4", stages=3), silent)
    assert built.failure is None
    report = json.loads((folder / "report.json").read_text())
    assert (report["latency"], report["options"]["stages"], report["options"]["latency"]) == (3, 3, 3)
    network = report["parts"]["network"]
    assert network["ffs"] > 0
    # Yosys counts the clock's buffer, 96 ps, and no wires.
    assert network["delay_ps"] - 96 <= report["stage_ps"]
    assert json.loads((folder / "manifest.json").read_text())["options"]["latency"] == 3
    assert "Latency 3 cycles, and a new input in each" in (folder / "report.md").read_text()
    assert 'data-key="latency"' in (folder / "report.html").read_text()
    assert " i + 1" in (folder / "net_network_tb.v").read_text()
    assert verify_build(folder, silent)[0] == []
    design = json.loads((folder / "design.json").read_text())
    design["pipeline"]["stages"]["network"]["encode"][""] += 1
    (folder / "design.json").write_text(json.dumps(design))
    assert any("the design is damaged" in problem for problem in verify_build(folder, silent)[0])


def test_a_clock_that_cannot_be_met_writes_nothing(tmp_path: Path) -> None:
    options = CompileOptions(input="Q2.4", clock=1000)
    with pytest.raises(InputError, match="no number of stages meets the clock"):
        compile_model(lut_network(2), tmp_path / "net", options, silent)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_sums_of_tables_are_built_and_proved_layer_by_layer(tmp_path: Path) -> None:
    built = compile_model(sum_network(5), tmp_path / "sums", CompileOptions(style="equations"), silent)
    assert built.failure is None
    parts = {"layer_0", "saturation_0", "layer_1", "saturation_1", "winner", "network", "sobel"}
    assert set(built.report["parts"]) == parts
    assert "sums by substitution" in built.report["proof"]["method"]


@pytest.mark.slow
def test_sums_of_tables_become_pipelines(tmp_path: Path) -> None:
    built = compile_model(sum_network(5), tmp_path / "sums", CompileOptions(stages=3), silent)
    assert built.failure is None
    assert built.report["proof"]["status"] == "proved"
    assert built.report["latency"] == 3
    assert built.report["parts"]["network"]["ffs"] > 0


def test_the_words_of_a_model_can_be_narrowed() -> None:
    narrowed = with_input(lut_network(2), "UQ3.1")
    assert isinstance(narrowed, LutGroupModel)
    assert narrowed.encoder.input == FixedPoint(4, 1, signed=False)  # type: ignore[union-attr]


def test_a_format_that_means_nothing_is_refused() -> None:
    with pytest.raises(InputError, match=r"not a format of words: 16; write Q3\.12 or UQ8\.0"):
        with_input(lut_network(2), "16")
    gates = LogicModel(("a",), ("b",), np.zeros((0, 2), np.uint32), np.array([2], np.uint32))
    with pytest.raises(InputError, match="the model reads no numbers"):
        with_input(gates, "Q3.12")
