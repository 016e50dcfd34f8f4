"""Simulating circuits of a build in another process: ``python -m wnn2hdl.build.simulating BUILD PART …``.

Amaranth's simulator runs in Python, one core per process; two processes use two cores, and Ctrl-C ends them
as it ends any outside program.
"""

import json
import sys
from collections.abc import Sequence
from pathlib import Path

from wnn2hdl.build.design import Design
from wnn2hdl.elaborate import component
from wnn2hdl.errors import CheckError
from wnn2hdl.tools import run
from wnn2hdl.verify.simulation import simulate

_TIMEOUT = 3600.0


def simulate_apart(folder: Path, parts: Sequence[str]) -> tuple[dict[str, int], str | None]:
    """Simulate circuits of a build in another process.

    Args:
        folder: holds the build's model and design.
        parts: the circuits.

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
        claim = design.specification.claims[part]
        assert claim.stimulus is not None
        inputs = claim.stimulus()
        try:
            circuit = component(design.parts[part], style=design.style)
            result = simulate(circuit, inputs, claim.answers(inputs))
        except CheckError as error:
            return vectors, f"{part}: {error.line()}"
        vectors[part] = result.vectors
    return vectors, None


if __name__ == "__main__":
    build, *names = sys.argv[1:]
    outcome = simulate_parts(Design.load(Path(build)), names)
    sys.stdout.write(json.dumps(outcome) + "\n")
