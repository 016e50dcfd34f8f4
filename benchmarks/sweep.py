"""A sweep against one `synth_xilinx` call a trial: ``python benchmarks/sweep.py --images … --masks …``.

Prints how long the grid of n = 2…12, k = 2…20 with ten mappings takes, what it holds in memory compared with
a tenth of the trials, and, on a random sample of the trials, how its LUT counts agree with `synth_xilinx` and
how long that takes. Synthesis and sweep use the same number of cores, and nothing is taken from a cache.

Three designs of each sampled trial are synthesised: the circuit that the sweep mapped, as `compile` writes it
in its two styles, vendor's cells and equations; and the trial's table as a `case` statement with x for
don't-cares, which is what a sweep without its own mapper would synthesise, and whose time is compared.
Without images the embedded landscapes are swept.
"""

import argparse
import os
import random
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from wnn2hdl.apps.sweep import PixelSets, Plan, Recipe, Trial, draw, grid
from wnn2hdl.apps.sweep.trial import table_and_network
from wnn2hdl.dataset import from_masks, from_samples
from wnn2hdl.elaborate import component
from wnn2hdl.emit import verilog
from wnn2hdl.encode import high_bits
from wnn2hdl.ir import PIXEL_BITS, LutNetwork, Style, TruthTable
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.nodes import Table
from wnn2hdl.ir.wires import Port, Slice
from wnn2hdl.synth import Job, synthesise_all

SIDE = 256
IMAGES = 12
PIXELS = 20_000
ENCODER = high_bits()


def run_grid(options: argparse.Namespace, trials: int) -> tuple[float, float]:
    """Seconds and peak megabytes (of the largest process) of a whole `wnn2hdl sweep`."""
    program = "import sys; from wnn2hdl.cli import main, sweep; sys.exit(main())"
    command = [sys.executable, "-c", program, "sweep", "--trials", str(trials), "--mode", options.mode]
    if options.images:
        command += ["--images", str(options.images), "--masks", str(options.masks)]
    with tempfile.TemporaryDirectory() as folder:
        started = time.perf_counter()
        subprocess.run([*command, "-o", folder, "--json"], check=True, stdout=subprocess.DEVNULL)
        seconds = time.perf_counter() - started
    return seconds, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024


def as_compiled(network: LutNetwork, style: Style) -> Job:
    """The circuit as `compile` writes it."""
    code = tuple(Slice("rgb", position) for position in ENCODER.pixel_positions)
    table = Table("decision", code, network)
    drivers = {"class_bits": (Slice("decision", 0, len(network.outputs)),)}
    circuit = Circuit("pixel", "Pixel classifier.", (Port("rgb", PIXEL_BITS),), (table,), drivers)
    return Job(verilog(component(circuit, style=style), prefix="our_", header=()), "our_pixel")


def as_case(table: TruthTable) -> Job:
    """The table as a `case` statement."""
    cases = "\n".join(f"12'd{x}: y = 1'b{int(table.values[x, 0])};" for x in np.flatnonzero(table.care))
    default = "" if table.care.all() else "default: y = 1'bx;\n"
    body = f"always @* case (x)\n{cases}\n{default}endcase\nendmodule\n"
    return Job(f"module pixel(input [11:0] x, output reg y);\n{body}", "pixel")


def synthesised(jobs: Sequence[Job]) -> tuple[list[int], float]:
    """LUTs of each job, and the seconds they took together on all cores, nothing cached."""
    with tempfile.TemporaryDirectory() as folder:
        os.environ["WNN2HDL_CACHE"] = folder
        started = time.perf_counter()
        results = synthesise_all({str(x): job for x, job in enumerate(jobs)})
        seconds = time.perf_counter() - started
    return [result.resources.luts for result in results.values()], seconds


def agreement(what: str, ours: Sequence[int], theirs: Sequence[int]) -> None:
    """Print how two counts of the same circuits agree."""
    differences = [b - a for a, b in zip(ours, theirs, strict=True)]
    equal = sum(x == 0 for x in differences)
    print(
        f"{what}: equal in {equal} of {len(differences)}, synth_xilinx fewer in "
        f"{sum(x < 0 for x in differences)}, more in {sum(x > 0 for x in differences)}; "
        f"differences from {min(differences):+d} to {max(differences):+d} LUTs; "
        f"in all {sum(ours)} against {sum(theirs)} LUTs",
        flush=True,
    )


def pixel_sets(options: argparse.Namespace) -> PixelSets:
    """The pixels that the command line sweeps with the same options."""
    data = from_masks(options.images, options.masks) if options.images else from_samples(IMAGES, SIDE, seed=0)
    return draw(data, pixels=PIXELS, seed=0, progress=lambda *_: None)


def sample(plan: Plan, count: int) -> list[Trial]:
    """Random trials of the grid."""
    chosen = random.Random(0).sample(range(len(plan)), count)
    return [plan.trial(position) for position in sorted(chosen)]


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--images", type=Path)
    parser.add_argument("--masks", type=Path)
    parser.add_argument("--mode", choices=["domain", "exact"], default="domain")
    parser.add_argument("--sample", type=int, default=100, help="trials that are synthesised")
    options = parser.parse_args()
    plan = grid(
        Recipe(0, ENCODER.bits, None, 1 if options.mode == "domain" else None),
        range(2, 13),
        range(2, 21),
        trials=10,
    )
    print(f"load average before: {os.getloadavg()[0]:.1f} on {len(os.sched_getaffinity(0))} cores")
    tenth, tenth_memory = run_grid(options, 1)
    seconds, memory = run_grid(options, plan.trials)
    each = seconds / len(plan)
    print(
        f"sweep of {len(plan):,} trials, everything included: {seconds:.1f} s, {1000 * each:.1f} ms a trial"
    )
    print(
        f"largest process: {memory:.0f} MB; {tenth_memory:.0f} MB with a tenth of the trials ({tenth:.1f} s)"
    )

    sets = pixel_sets(options)
    pairs = [table_and_network(sets, trial) for trial in sample(plan, options.sample)]
    ours = [len(network.luts) for _, network in pairs]
    styles: tuple[Style, ...] = ("cells", "equations")
    for style in styles:
        theirs, _ = synthesised([as_compiled(network, style) for _, network in pairs])
        agreement(f"the mapped circuit as {style}", ours, theirs)
    rival, rival_seconds = synthesised([as_case(table) for table, _ in pairs])
    agreement("the table as a case statement", ours, rival)
    rival_each = rival_seconds / len(pairs)
    print(f"synth_xilinx: {rival_each:.2f} s per trial on the same cores; ratio {rival_each / each:.0f}")


if __name__ == "__main__":
    main()
