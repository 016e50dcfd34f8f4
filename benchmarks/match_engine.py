"""What a match engine takes for a template of 220 x 220 pixels, and how many it matches per second.

    python -m benchmarks.match_engine

Engines are chosen for rates at a clock of 100 MHz, as `compile --target engine` chooses them. LUTs,
flip-flops, block RAMs and the longest path, logic only, are those of the whole core by the count that all
reports have.
"""

from wnn2hdl.elaborate import match_engine
from wnn2hdl.emit import verilog
from wnn2hdl.ir.engine import EngineFormat
from wnn2hdl.lower.deforestation import engine as engine_circuit
from wnn2hdl.lower.deforestation import lane
from wnn2hdl.schedule import for_clock, pipelined
from wnn2hdl.synth import synthesise

TEMPLATE = 220, 220
CLOCK_MHZ = 100.0
WANTED = ((543, 1.0), (543, 10.0), (543, 30.0), (1024, 1.0), (1024, 5.0))
"""Rows and columns of the segment, and templates per second."""


def row(side: int, rate: float) -> str:
    """An engine, as a row of a Markdown table."""
    engine = EngineFormat.fast_enough(TEMPLATE, (side, side), int(CLOCK_MHZ * 1e6 / rate))
    circuit = engine_circuit(lane(engine.columns))
    circuit = pipelined(circuit, for_clock(circuit, CLOCK_MHZ))
    core = match_engine(circuit, engine, style="cells")
    cost = synthesise(verilog(core, prefix="bench_", header=[]), "bench_engine").resources
    cycles = engine.cycles(circuit.latency)
    return (
        f"| {side}x{side} | {engine.lanes} x {engine.columns} | {engine.bits} | {cycles:,} "
        f"| {CLOCK_MHZ * 1e6 / cycles:.1f} | {cost.luts:,} | {cost.ffs:,} | {cost.carry4} | {cost.bram36:g} "
        f"| {cost.dsp} | {cost.delay_ps} ps |"
    )


def main() -> None:
    """Print the table."""
    heads = ["segment", "lanes x columns", "bits per cycle", "cycles", "per second at 100 MHz", "LUTs"]
    heads += ["flip-flops", "CARRY4", "block RAM of 36 Kb", "DSP", "longest path, logic only"]
    print(f"| {' | '.join(heads)} |")
    print("|" + "---|" * len(heads))
    for side, rate in WANTED:
        print(row(side, rate), flush=True)


if __name__ == "__main__":
    main()
