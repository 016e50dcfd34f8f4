"""The page a person reads."""

import json
from dataclasses import replace

import pytest

from wnn2hdl.report import (
    BuildReport,
    Care,
    LightFigures,
    Minimised,
    PartFigures,
    Proof,
    report_dict,
    report_markdown,
)

FIGURES = PartFigures(
    luts=18, inv=0, muxf7=2, muxf8=0, carry4=0, srl=0, ffs=0, bram36=0.5, dsp=0, delay_ps=1284
)
FULL = BuildReport(
    name="amazon",
    target="block",
    mode="domain",
    parts={"block": FIGURES, "sobel": PartFigures()},
    count="synth_xilinx -family xc7",
    device="xc7z020clg484",
    utilisation={"block": {"luts": 0.0338, "ffs": 0.0}},
    minimised={"pixel": Minimised(60, 3, 720, 9)},
    proof=Proof("proved", "SAT", 0.5),
    care=Care(120, 0.9812),
    accuracy=0.9,
    light=LightFigures(
        {
            "exposure": (
                {
                    "value": 1.5,
                    "accuracy": 0.7313,
                    "interval": (0.7, 0.75),
                    "worst_image": {"name": "dim|s", "accuracy": 0.5},
                },
            ),
            "haze": (
                {
                    "value": 0.1,
                    "accuracy": 0.6,
                    "interval": None,
                    "worst_image": {"name": "a", "accuracy": 0.6},
                },
            ),
        },
        "brighter ground may be answered differently: R7 is not read",
    ),
    options={"edges": "boundary|learned"},
    hashes={"block.v": "ab12"},
    tools={"yosys": "0.70"},
    seconds={"synth": 7.25},
)


def page(report: BuildReport) -> str:
    """The page of a report that has been written and read back."""
    return report_markdown(json.loads(json.dumps(report_dict(report))))


@pytest.mark.parametrize(
    "line",
    [
        "# amazon",
        "Target block, mode domain, proof: proved by SAT in 0.50 s.",
        "| block | 18 | 0 | 2 | 0 | 0 | 0 | 0 | 0.5 | 0 | 1284 |",
        "Counted after `synth_xilinx -family xc7`.",
        "| block | 0.034 % | 0 % |",
        "## Published, not measured here",
        "| accuracy of the circuit | 90.00 % |",
        "| exposure 1.5 | 73.13 % | 70.00 % to 75.00 % | dim\\|s | 50.00 % |",
        "| haze 0.1 | 60.00 % | n/a | a | 60.00 % |",
        "brighter ground may be answered differently: R7 is not read",
        "| pixel codes cared for | 120 |",
        "| pixel | 60 | 3 | 720 | 9 |",
        "| edges | boundary\\|learned |",
        "| block.v | ab12 |",
        "| yosys | 0.70 |",
        "| synth | 7.25 |",
    ],
)
def test_every_figure_has_its_line(line: str) -> None:
    assert line in page(FULL).splitlines()


def test_what_was_not_measured_is_never_0() -> None:
    parts = {"block": FIGURES, "pixel": PartFigures(luts=2)}
    assert "| pixel | 2 | n/a | n/a | n/a | n/a | n/a | n/a | n/a | n/a | n/a |" in page(
        replace(FULL, parts=parts)
    )
    assert "proof: not run." in page(replace(FULL, proof=Proof()))


def test_rows_and_columns_in_which_nothing_was_measured_are_left_out() -> None:
    lines = page(replace(FULL, parts={"block": PartFigures(luts=18), "sobel": PartFigures()})).splitlines()
    assert lines[lines.index("| part | LUTs |") :][:3] == [
        "| part | LUTs |",
        "| --- | --- |",
        "| block | 18 |",
    ]
    assert not [line for line in lines if line.startswith(("| sobel", "| accuracy of the model"))]
    assert "Nothing was measured." in page(replace(FULL, parts={"block": PartFigures()}))


def test_a_simulation_that_passed_before_is_told_as_such() -> None:
    options = {
        "edges": None,
        "mapping": {"pixel": "decpla"},
        "simulated_vectors": {"match": 262144, "pixel": 64},
        "simulated_before": "match",
    }
    text = page(replace(FULL, options=options))
    assert "| match | 262144 | passed before on the same vectors |" in text
    assert "| pixel | 64 | simulated for this build |" in text
    assert "| mapping, pixel | decpla |" in text
    assert "| edges" not in text


def test_a_proof_of_an_earlier_build_is_told_as_such() -> None:
    text = page(replace(FULL, proof=Proof("proved", "SAT", 0.0, before=("pixel", "edge"))))
    told = "proved by SAT in 0.00 s; before, with the same Verilog and netlist: pixel, edge."
    assert told in text
    assert "before, with" not in page(FULL)


def test_it_says_that_yosys_is_not_vivado() -> None:
    assert "**Yosys is not Vivado:**" in page(FULL)


def test_published_figures_stand_under_their_own_heading_only() -> None:
    measured, published = page(FULL).split("## Published, not measured here")
    assert "| 135 | 49 |" in published
    assert "135" not in measured


def test_a_report_with_nothing_to_tell_has_no_empty_tables() -> None:
    text = page(BuildReport("empty", "pixel", "exact", {}))
    assert "## Minimised" not in text
    assert "None" not in text
    assert "\n\n\n" not in text


def test_nearly_all_is_not_told_as_all() -> None:
    reported = page(replace(FULL, care=Care(150, 0.999996)))
    assert "| share of other imagery that these codes cover | 99.9996 % |" in reported.splitlines()
