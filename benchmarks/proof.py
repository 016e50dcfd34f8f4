"""Proof times, mutants caught and simulators' speed of builds: ``python benchmarks/proof.py build/NAME …``.

Mutants are those of the module named, with the cells it instantiates; a simulator that runs them on every
cared-for code says which ones the proof has to catch.
"""

import re
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np

from wnn2hdl.build.circuits import PARTS, Circuits, component, port_arrays
from wnn2hdl.build.design import Design
from wnn2hdl.build.verification import open_build
from wnn2hdl.synth import synthesise
from wnn2hdl.verify.compiled import CompiledSimulator, run_compiled
from wnn2hdl.verify.mutation import check_proof, make_mutants
from wnn2hdl.verify.proof import prove, prove_netlists
from wnn2hdl.verify.simulation import simulate
from wnn2hdl.verify.specification import Specification
from wnn2hdl.verify.vectors import stimulus

MUTANTS = 200
WINDOWS = 254 * 254
SIMULATORS: tuple[CompiledSimulator, ...] = ("icarus", "verilator")
MUTATED: tuple[Literal["pixel", "edge"], ...] = ("pixel", "edge")


def proof_times(design: Design, circuits: Circuits) -> None:
    """Seconds for each part by itself, Verilog against model and netlist against Verilog."""
    text = circuits.verilog.read_text(encoding="utf-8")
    for part in PARTS[design.target]:
        proof = prove(design.specification, {part: circuits.verilog})[part]
        synthesis = synthesise(text, design.specification.part(part).module)
        with tempfile.TemporaryDirectory() as name:
            netlist = Path(name) / "netlist.v"
            netlist.write_text(synthesis.netlist_verilog, encoding="utf-8")
            after = prove_netlists(design.specification, {part: (circuits.verilog, netlist)})[part]
        print(f"  {part}: {proof.status} in {proof.seconds:.2f} s, ", end="")
        print(f"netlist {after.status} in {after.seconds:.2f} s")


def mutants_caught(design: Design, circuits: Circuits) -> None:
    """Caught of catchable mutants of pixel and edge filter."""
    if not isinstance(design.specification, Specification):
        return  # mutants are judged by the circuit's answer to one pixel
    text = circuits.verilog.read_text(encoding="utf-8")
    for part in MUTATED:
        module = design.specification.part(part).module
        found = re.search(rf"^module {module}\b.*?^endmodule$", text, re.DOTALL | re.MULTILINE)
        if found is None:
            continue
        models = "".join(
            re.findall(r"^module (?:LUT\d|MUXF\d)\b.*?^endmodule\n", text, re.DOTALL | re.MULTILINE)
        )
        mutants = [
            replace(mutant, verilog=f"{mutant.verilog}\n{models}")
            for mutant in make_mutants(found[0], MUTANTS, 0)
        ]
        started = time.perf_counter()
        report = check_proof(design.specification, part, mutants, "icarus")
        print(f"  {part}: {report} ({time.perf_counter() - started:.0f} s)")


def simulators_speed(design: Design, circuits: Circuits) -> None:
    """Windows a second of the whole block, in each simulator."""
    part = PARTS[design.target][-1]
    inputs = stimulus(design.specification, part)
    repeats = -(-WINDOWS // len(next(iter(inputs.values()))))
    windows = {port: np.concatenate([values] * repeats)[:WINDOWS] for port, values in inputs.items()}
    for simulator in SIMULATORS:
        started = time.perf_counter()
        _, seconds = run_compiled(design.specification.part(part), [circuits.verilog], windows, simulator)
        whole = time.perf_counter() - started
        print(
            f"  {simulator}: {WINDOWS / seconds:.0f} windows a second, {WINDOWS / whole:.0f} with compiling"
        )
    expected = design.specification.evaluate(part, windows)
    result = simulate(component(design, part), port_arrays(windows), port_arrays(expected))
    print(f"  amaranth: {result.vectors_per_second:.0f} windows a second")


if __name__ == "__main__":
    for folder in sys.argv[1:]:
        print(folder)
        its_design, its_circuits, _ = open_build(Path(folder))
        proof_times(its_design, its_circuits)
        mutants_caught(its_design, its_circuits)
        simulators_speed(its_design, its_circuits)
