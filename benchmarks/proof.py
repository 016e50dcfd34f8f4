"""Proof times, mutants caught and simulators' speed of builds: ``python benchmarks/proof.py build/NAME …``.

Mutants are of the circuits that can be simulated on every cared-for input, each by itself, and of the whole
text: hierarchy, compressors, matcher and all.
"""

import re
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.mutation import check_proof, make_mutants
from wnn2hdl.build.design import Design
from wnn2hdl.build.emission import Files
from wnn2hdl.build.verification import open_build
from wnn2hdl.elaborate import component
from wnn2hdl.synth import synthesise
from wnn2hdl.verify.compiled import CompiledSimulator, run_compiled
from wnn2hdl.verify.equivalence import Circuit
from wnn2hdl.verify.proof import prove, prove_netlists
from wnn2hdl.verify.simulation import simulate

MUTANTS = 200
"""Of the whole text, and of all circuits by themselves together."""

MUTATED = ("pixel", "edge")
"""Circuits whose mutants are simulated on every cared-for input."""

WHOLE = 256
"""Windows on which mutants of the whole text are simulated, drawn from the stimulus of the circuit."""

WINDOWS = 254 * 254
SIMULATORS: tuple[CompiledSimulator, ...] = ("icarus", "verilator")


def proof_times(design: Design, text: str) -> None:
    """Seconds for each circuit by itself, Verilog against model and netlist against Verilog."""
    for part, definition in design.parts.items():
        if part not in design.specification.claims:
            continue
        circuit = Circuit((text,), design.module(part), definition.latency)
        proof = prove(design.specification, {part: circuit})[part]
        netlist = replace(circuit, sources=(synthesise(text, circuit.top).netlist_verilog,))
        after = prove_netlists({part: (circuit, netlist)}, {part: definition.widths})[part]
        print(f"  {part}: {proof.status} in {proof.seconds:.2f} s, ", end="")
        print(f"netlist {after.status} in {after.seconds:.2f} s")


def mutants_caught(design: Design, text: str) -> None:
    """Caught of harmful mutants, and false alarms among the others."""
    alone = [part for part in MUTATED if part in design.parts and part != design.circuit.name]
    counted = [(part, _module(text, design.module(part)), MUTANTS // len(alone)) for part in alone]
    for part, verilog, count in [*counted, (design.circuit.name, text, MUTANTS)]:
        draw = design.specification.claims[part].stimulus
        assert draw is not None
        inputs = draw()
        if part not in alone:
            rows = np.random.default_rng(0).permutation(len(next(iter(inputs.values()))))[:WHOLE]
            inputs = {port: bits[rows] for port, bits in inputs.items()}
        started = time.perf_counter()
        mutants = make_mutants(verilog, count, 0)
        report = check_proof(design.specification, part, design.module(part), mutants, inputs)
        print(f"  {part}: {report} ({time.perf_counter() - started:.0f} s)")
        for kind, listed in (("missed", report.missed), ("false alarm", report.false_alarms)):
            print("".join(f"    {kind}: {mutant.fault}\n" for mutant in listed), end="")


def simulators_speed(design: Design, files: Files) -> None:
    """Windows a second of the whole circuit, in each simulator."""
    claim = design.specification.claims[design.circuit.name]
    assert claim.stimulus is not None
    inputs = claim.stimulus()
    repeats = -(-WINDOWS // len(next(iter(inputs.values()))))
    windows = {port: np.concatenate([values] * repeats)[:WINDOWS] for port, values in inputs.items()}
    for simulator in SIMULATORS:
        started = time.perf_counter()
        _, seconds = run_compiled(
            claim, design.module(claim.part), files.simulated, windows, simulator, latency=design.top.latency
        )
        whole = time.perf_counter() - started
        print(
            f"  {simulator}: {WINDOWS / seconds:.0f} windows per second, {WINDOWS / whole:.0f} with compiling"
        )
    result = simulate(component(design.top, style=design.style), windows, claim.answers(windows))
    print(f"  amaranth: {result.vectors_per_second:.0f} windows per second")


def _module(text: str, name: str) -> str:
    """A module alone; pixel and edge filter instantiate nothing but the vendor's cells."""
    found = re.search(rf"^module {name}\b.*?^endmodule$", text, re.DOTALL | re.MULTILINE)
    assert found is not None
    return found[0]


if __name__ == "__main__":
    for folder in sys.argv[1:]:
        print(folder)
        its_design, its_files, _ = open_build(Path(folder))
        verilog = its_files.verilog.read_text(encoding="utf-8")
        proof_times(its_design, verilog)
        mutants_caught(its_design, verilog)
        simulators_speed(its_design, its_files)
