"""A full report and two small networks, shared by the tests of pages and gate."""

import json
from typing import Any

import pytest

from wnn2hdl.ir import Lut, LutNetwork, Mux
from wnn2hdl.report import (
    BuildReport,
    Care,
    EdgeFigures,
    LightFigures,
    Minimised,
    ModelFigures,
    PartFigures,
    Proof,
    report_dict,
)


def part(luts: int, delay: int) -> PartFigures:
    return PartFigures(luts, 0, 0, 0, 0, 0, 0, 0.0, 0, delay)


@pytest.fixture
def report() -> dict[str, Any]:
    """The report of a block of 19 LUTs, as it comes back from its file."""
    figures = BuildReport(
        name="amazon",
        target="block",
        mode="domain",
        parts={
            "pixel": part(2, 769),
            "edge": part(1, 631),
            "block": part(19, 1400),
            "match": part(10, 1284),
            "sobel": part(74, 3057),
        },
        count="synth_xilinx -family xc7",
        device="xc7z020clg484",
        utilisation={"block": {"luts": 0.0357, "ffs": 0.0}},
        minimised={"pixel": Minimised(119, 11, 1428, 31), "edge": Minimised(240, 4, 2160, 8)},
        proof=Proof("proved", "SAT", 0.5),
        care=Care(150, 0.999996, 4096),
        edges=EdgeFigures("boundary", 240, 0.6, 0.58, 0.59, "imagery"),
        light=LightFigures(
            {
                "exposure": tuple(
                    {
                        "value": value,
                        "accuracy": share,
                        "interval": (share - 0.02, share + 0.015),
                        "worst_image": {"name": f"dim-{value:g}", "accuracy": share - 0.2},
                    }
                    for value, share in ((0.8, 0.8871), (1.0, 0.9165), (1.5, 0.7313))
                )
            },
            "brighter ground of the same kind may be answered differently: R7 is not read",
        ),
        accuracy=0.9165,
        model_accuracy=0.9165,
        confusion=((130900, 7121), (14767, 109356)),
        model=ModelFigures(
            ("forest", "deforested"), 2, 3, ("R7", "G7"), 7, ((0.25, 0.5, 1.0), (0.0, 0.75, 0.5)), {"seed": 3}
        ),
        command="wnn2hdl compile amazon/model.json -o amazon-again --mode domain --care 'my imagery'",
        evaluation="wnn2hdl evaluate amazon --images 'my imagery' --masks masks",
        options={"edges": "boundary", "style": "cells", "simulated_vectors": {"match": 262144}},
        hashes={"model": "ab12"},
        tools={"wnn2hdl": "0.1.0", "pyosys": "0.70"},
        seconds={"plan": 0.72},
    )
    back: dict[str, Any] = json.loads(json.dumps(report_dict(figures)))
    return back


@pytest.fixture
def networks() -> dict[str, LutNetwork]:
    """A pixel of two LUTs behind a multiplexer, and an edge filter of one."""
    pixel = LutNetwork(
        ("R7", "G7", "B7"),
        (Lut("t0", ("R7", "G7"), 0b1000), Lut("t1", ("R7",), 0b01), Mux("t2", "t0", "t1", "G7")),
        (("class_bit0", "t2"),),
    )
    edge = LutNetwork(("bit0", "bit4"), (Lut("t0", ("bit0", "bit4"), 0b0110),), (("edge_bit", "t0"),))
    return {"pixel": pixel, "edge": edge}
