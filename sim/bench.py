"""The cocotb test that runs inside the simulator: every vector of a file, one after the other.

It knows nothing of the compiler: the file named by `VECTORS` holds the circuit's latency in cycles of the
clock ``clk``, 0 of a combinational circuit, and pairs of port values, inputs and the outputs that the model
gives for them.
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
    """Every output is defined (no x, no z) and equals the model's, with a new vector in each cycle."""
    data = json.loads(Path(os.environ[VECTORS]).read_text(encoding="utf-8"))
    latency, vectors = data["latency"], data["vectors"]
    assert vectors, "there are no vectors to run"
    for cycle in range(len(vectors) + latency):
        for port, value in vectors[min(cycle, len(vectors) - 1)][0].items():
            getattr(dut, port).value = value
        if latency:
            dut.clk.value = 0
        await Timer(1, "ns")
        number = cycle - latency
        outputs = vectors[number][1] if number >= 0 else {}
        for port, expected in outputs.items():
            found = getattr(dut, port).value
            assert found.is_resolvable, f"vector {number}: {port} is undefined: {found}"
            assert int(found) == expected, f"vector {number}: {port} is {found}, the model says {expected:b}"
        if latency:
            dut.clk.value = 1
            await Timer(1, "ns")
    dut._log.info("%d vectors agree with the model", len(vectors))
