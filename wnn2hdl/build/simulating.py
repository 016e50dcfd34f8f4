"""Simulating circuits of a build in another process: ``python -m wnn2hdl.build.simulating BUILD PART …``.

Amaranth's simulator runs in Python, one core per process; two processes use two cores, and Ctrl-C ends them
as it ends any outside program.
"""

import json
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from wnn2hdl.build.design import Design
from wnn2hdl.build.emission import video_part
from wnn2hdl.build.streaming import sample_frames
from wnn2hdl.elaborate import component, match_engine
from wnn2hdl.errors import CheckError
from wnn2hdl.ir.wires import Bits
from wnn2hdl.tools import run
from wnn2hdl.verify.engine import simulate_engine
from wnn2hdl.verify.simulation import SimulationResult, simulate
from wnn2hdl.verify.specification import Claim
from wnn2hdl.verify.stream import simulate_stream

_TIMEOUT = 3600.0

_MOST_CELLS, _CELL_VECTORS = 5_000, 1 << 19
"""LUTs of a gate network above which it is not simulated, and about how many LUTs are, on all vectors."""


def simulated_inputs(design: Design, claim: Claim) -> dict[str, Bits] | None:
    """The vectors that a circuit is simulated on, None where it is not: all of them, but fewer of many gates.

    What is left out of a gate network here is not left out of its proof, which starts with all vectors.
    """
    if claim.stimulus is None:
        return None
    inputs = claim.stimulus()
    if claim.gates is None:
        return inputs
    cells = sum(len(network.cells) for network in design.networks.values())
    if cells > _MOST_CELLS:
        return None
    (total,) = {len(bits) for bits in inputs.values()}
    chosen = np.linspace(0, total - 1, min(total, _CELL_VECTORS // max(cells, 1))).astype(np.int64)
    return {port: bits[chosen] for port, bits in inputs.items()}


def simulate_apart(folder: Path, parts: Sequence[str]) -> tuple[dict[str, int], str | None]:
    """Simulate circuits of a build in another process.

    Args:
        folder: holds the build's model and design.
        parts: the circuits, or the core around them.

    Returns:
        How many vectors each was simulated on, and the first mismatch in words; None if there is none.

    Raises:
        ToolError: the process failed or ran out of time.
    """
    command: list[str | Path] = [sys.executable, "-m", "wnn2hdl.build.simulating", folder, *parts]
    vectors, failure = json.loads(run(command, timeout=_TIMEOUT).output.splitlines()[-1])
    return vectors, failure


def simulate_parts(design: Design, parts: Sequence[str]) -> tuple[dict[str, int], str | None]:
    """The same in this process."""
    vectors: dict[str, int] = {}
    for part in parts:
        try:
            vectors[part] = _simulate(design, part).vectors
        except CheckError as error:
            return vectors, f"{part}: {error.line()}"
    return vectors, None


def _simulate(design: Design, part: str) -> SimulationResult:
    if part not in design.parts and design.engine is not None:
        small = design.engine.small()
        return simulate_engine(match_engine(design.top, small, style=design.style), small.sample_rounds())
    if part not in design.parts:
        return simulate_stream(video_part(design), sample_frames(design))
    claim = design.specification.claims[part]
    inputs = simulated_inputs(design, claim)
    assert inputs is not None
    return simulate(component(design.parts[part], style=design.style), inputs, claim.answers(inputs))


if __name__ == "__main__":
    build, *names = sys.argv[1:]
    outcome = simulate_parts(Design.load(Path(build)), names)
    sys.stdout.write(json.dumps(outcome) + "\n")
