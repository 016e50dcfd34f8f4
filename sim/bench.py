"""The cocotb test that runs inside the simulator: every vector of a file, applied to a combinational circuit.

It knows nothing of the compiler: the file named by `VECTORS` holds a list of pairs of port values, inputs and
the outputs that the model gives for them.
"""

import json
import os
from pathlib import Path
from typing import Any

import cocotb
from cocotb.triggers import Timer

VECTORS = "WNN2HDL_VECTORS"
"""The environment variable that names the file of vectors."""


@cocotb.test()
async def outputs_equal_the_model(dut: Any) -> None:
    """Every output is defined (no x, no z) and equals the model's, vector by vector."""
    vectors = json.loads(Path(os.environ[VECTORS]).read_text(encoding="utf-8"))
    assert vectors, "there are no vectors to run"
    for number, (inputs, outputs) in enumerate(vectors):
        for port, value in inputs.items():
            getattr(dut, port).value = value
        await Timer(1, "ns")
        for port, expected in outputs.items():
            found = getattr(dut, port).value
            assert found.is_resolvable, f"vector {number}: {port} is undefined: {found}"
            assert int(found) == expected, f"vector {number}: {port} is {found}, the model says {expected:b}"
    dut._log.info("%d vectors agree with the model", len(vectors))
