"""Real designs through the real Yosys; the results are shared, as each call takes half a second."""

from pathlib import Path

import pytest

from wnn2hdl.errors import InputError, ToolError
from wnn2hdl.synth import OPTIONS, Job, Synthesis, cache, synthesise, synthesise_all
from wnn2hdl.tools import Yosys, find_yosys

GATE = "module gate(input [5:0] a, output y);\n  assign y = ^a;\nendmodule\n"
COUNT = """\
module count(input [8:0] a, input [8:0] b, output [3:0] n, output y);
  wire [8:0] e = a ~^ b;
  assign n = e[0] + e[1] + e[2] + e[3] + e[4] + e[5] + e[6] + e[7] + e[8];
  assign y = ~a[0];
endmodule
"""
WIRE = "module wire_through(input a, output y);\n  assign y = a;\nendmodule\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("cache")


@pytest.fixture(autouse=True)
def own_cache(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(cache.FOLDER, str(folder))


@pytest.fixture(scope="module")
def results(folder: Path) -> dict[str, Synthesis]:
    jobs = {
        "gate": Job(GATE, "gate"),
        "count": Job(COUNT, "count"),
        "wire": Job(WIRE, "wire_through"),
    }
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(cache.FOLDER, str(folder))
        seen: list[str] = []
        results = synthesise_all(jobs, done=seen.append)
    assert sorted(seen) == sorted(results)
    assert list(results) == list(jobs)
    return results


def test_six_inputs_are_one_lut(results: dict[str, Synthesis]) -> None:
    gate = results["gate"]
    assert (gate.resources.luts, gate.resources.inv, gate.resources.carry4) == (1, 0, 0)
    assert gate.resources.delay_ps is not None
    assert 100 < gate.resources.delay_ps < 1000
    assert (gate.tool, gate.options) == ("pyosys", OPTIONS)
    assert gate.version == find_yosys().version
    assert gate.seconds > 0


def test_the_netlist_keeps_name_and_ports(results: dict[str, Synthesis]) -> None:
    netlist = results["gate"].netlist_verilog
    assert "module gate(a, y);" in netlist
    assert netlist.count("LUT6 #(") == 1
    assert "(*" not in netlist


def test_the_delay_goes_through_a_carry_chain_to_its_end(results: dict[str, Synthesis]) -> None:
    # Three levels of LUTs before a carry chain; without the chain's own arcs it would be 1745 ps or less.
    count = results["count"].resources
    assert count.carry4 > 0
    assert count.delay_ps is not None
    assert count.delay_ps > 1800


def test_a_wire_has_no_delay_rather_than_0(results: dict[str, Synthesis]) -> None:
    assert results["wire"].resources.luts == 0
    assert results["wire"].resources.delay_ps is None


def test_the_second_time_it_comes_from_the_cache(
    results: dict[str, Synthesis], monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(self: Yosys, script: str, **rest: object) -> str:
        raise AssertionError("Yosys was started again")

    monkeypatch.setattr(Yosys, "run", refuse)
    assert synthesise(GATE, "gate") == results["gate"]
    as_baseline = synthesise(COUNT, "count", baseline=True).resources
    ours = results["count"].resources
    assert ours.inv > 0
    assert as_baseline.luts == ours.luts - ours.inv


def test_a_damaged_cache_entry_is_made_again(results: dict[str, Synthesis], folder: Path) -> None:
    entry = next(file for file in (folder / "synth").iterdir() if "module wire_through" in file.read_text())
    entry.write_text(entry.read_text().replace("wire_through", "wire_thought"))
    again = synthesise(WIRE, "wire_through")
    assert again.resources == results["wire"].resources
    assert "wire_through" in entry.read_text()


@pytest.mark.parametrize(
    ("field", "value"),
    [("cells", {"LUT6": "many"}), ("cells", [1]), ("delay_ps", "96"), ("netlist", None), ("seconds", {})],
)
def test_an_entry_with_other_contents_than_ours_is_made_again(
    field: str, value: object, results: dict[str, Synthesis], monkeypatch: pytest.MonkeyPatch
) -> None:
    load = cache.load
    monkeypatch.setattr(cache, "load", lambda kind, key: {**(load(kind, key) or {}), field: value})
    assert synthesise(WIRE, "wire_through").resources == results["wire"].resources


def test_verilog_with_an_error_is_an_error() -> None:
    with pytest.raises(
        ToolError, match=r"^pyosys failed with exit status 1: design\.v:1: ERROR: syntax error"
    ):
        synthesise("module m(;", "m")


def test_one_bad_design_ends_all() -> None:
    with pytest.raises(ToolError, match="ERROR"):
        synthesise_all({"good": Job("module good; endmodule", "good"), "bad": Job("module", "bad")})


@pytest.mark.parametrize("top", ["", "two words", "a;b", "1st"])
def test_a_name_that_is_no_identifier(top: str) -> None:
    with pytest.raises(InputError, match=r"^not a name of a Verilog module"):
        synthesise(GATE, top)


def test_statistics_that_cannot_be_read_are_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Yosys, "run", lambda self, script, **rest: "a log")
    with pytest.raises(ToolError, match=r"^Yosys wrote no statistics that can be read"):
        synthesise(GATE + "// another one\n", "gate")
