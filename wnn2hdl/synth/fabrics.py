"""FPGAs of other makers that designs are placed and routed on, and how their cells are counted.

Their LUTs have four inputs, so no figure of theirs compares with one of the 7 series.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from wnn2hdl.tools import ECP5, GOWIN, ICE40, Placer


@dataclass(frozen=True)
class Family:
    """What FPGAs of one architecture share.

    Attributes:
        placer: the programs that place, route and write the bitstream.
        synthesis: Yosys's commands for a circuit inside of a design, of which the best result counts.
        with_pads: its command for a whole design, whose ports are pins.
        models: Yosys's Verilog of the cells, below its data folder.
        lut_cell: Verilog of the module ``KEEP`` with the pins ``I0`` to ``I3`` and ``O`` and the parameter
            ``INIT``: one LUT of this family.
        counted: for cells by type which of `Cells` they count as, and how much of it.
        constraints: suffix of a file that assigns pins.
        bitstream: suffix of a bitstream.
        constrained: arguments for nextpnr, which get the file of constraints in the place of ``{}``.
        unconstrained: its arguments where it assigns the pins.
        routed: its argument ahead of the file that the packer reads.
        packed: arguments of the packer, with ``{routed}`` for that file and ``{bitstream}``.
    """

    placer: Placer
    synthesis: tuple[str, ...]
    with_pads: str
    models: str
    lut_cell: str
    counted: Mapping[str, tuple[str, int]]
    constraints: str
    bitstream: str
    constrained: tuple[str, ...]
    unconstrained: tuple[str, ...]
    routed: str
    packed: tuple[str, ...]


@dataclass(frozen=True)
class Fabric:
    """One FPGA.

    Attributes:
        name: as users give it.
        part: as its maker orders it.
        family: its architecture.
        luts: LUTs of four inputs.
        ffs: flip-flops.
        rams: block RAMs.
        ram_kilobits: size of one of these, in units of 1024 bits.
        pins: how many ports a design may have.
        options: what tells the placer of it.
        plain_pins: names of the pins that ports are assigned to, the clock's first; none where the placer
            assigns them.
    """

    name: str
    part: str
    family: Family
    luts: int
    ffs: int
    rams: int
    ram_kilobits: int
    pins: int
    options: tuple[str, ...]
    plain_pins: tuple[str, ...] = ()


_ECP5 = Family(
    placer=ECP5,
    synthesis=("synth_ecp5", "synth_ecp5 -nowidelut"),
    with_pads="synth_ecp5",
    models="ecp5/cells_sim.v",
    lut_cell="LUT4 #(.INIT(INIT)) lut (.A(I0), .B(I1), .C(I2), .D(I3), .Z(O));",
    counted={
        "LUT4": ("luts", 1),
        "CCU2C": ("luts", 2),
        "TRELLIS_DPR16X4": ("luts", 6),
        "TRELLIS_FF": ("ffs", 1),
        "DP16KD": ("rams", 1),
        "PDPW16KD": ("rams", 1),
        "PFUMX": ("muxes", 1),
        "L6MUX21": ("muxes", 1),
    },
    constraints=".lpf",
    bitstream=".bit",
    constrained=("--lpf", "{}"),
    unconstrained=("--lpf-allow-unconstrained",),
    routed="--textcfg",
    packed=("--compress", "{routed}", "{bitstream}"),
)

_ICE40 = Family(
    placer=ICE40,
    synthesis=("synth_ice40",),
    with_pads="synth_ice40",
    models="ice40/cells_sim.v",
    lut_cell="SB_LUT4 #(.LUT_INIT(INIT)) lut (.I0(I0), .I1(I1), .I2(I2), .I3(I3), .O(O));",
    counted={
        "SB_LUT4": ("luts", 1),
        **{
            f"SB_DFF{edge}{enable}{reset}": ("ffs", 1)
            for edge in ("", "N")
            for enable in ("", "E")
            for reset in ("", "R", "S", "SR", "SS")
        },
        "SB_RAM40_4K": ("rams", 1),
        "SB_CARRY": ("carries", 1),
    },
    constraints=".pcf",
    bitstream=".bin",
    constrained=("--pcf", "{}"),
    unconstrained=(),
    routed="--asc",
    packed=("{routed}", "{bitstream}"),
)

_GOWIN = Family(
    placer=GOWIN,
    synthesis=("synth_gowin -noiopads", "synth_gowin -noiopads -nowidelut"),
    with_pads="synth_gowin",
    models="gowin/cells_sim.v",
    lut_cell="LUT4 #(.INIT(INIT)) lut (.I0(I0), .I1(I1), .I2(I2), .I3(I3), .F(O));",
    counted={
        **{f"LUT{inputs}": ("luts", 1) for inputs in range(1, 5)},
        "ALU": ("luts", 1),
        **{
            f"DFF{edge}{kind}": ("ffs", 1)
            for edge in ("", "N")
            for kind in ("", "E", "S", "SE", "R", "RE", "P", "PE", "C", "CE")
        },
        "SDPB": ("rams", 1),
        "SDPX9B": ("rams", 1),
        "DPB": ("rams", 1),
        "DPX9B": ("rams", 1),
        **{f"MUX2_LUT{inputs}": ("muxes", 1) for inputs in range(5, 9)},
    },
    constraints=".cst",
    bitstream=".fs",
    constrained=("--vopt", "cst={}"),
    unconstrained=(),
    routed="--write",
    packed=("-d", "GW1N-9C", "-o", "{bitstream}", "{routed}"),
)

# A clock input, then the pins without a second function (Apycula's database of the package).
_QFN88P = (
    "52",
    "3",
    "11",
    *map(str, range(13, 21)),
    *map(str, range(25, 35)),
    *map(str, range(37, 43)),
    *map(str, range(47, 51)),
    *map(str, range(68, 78)),
    *map(str, range(79, 87)),
)

FREE = frozenset({"VCC", "GND", "$scopeinfo", "GSR"})
"""Cells that take nothing."""

FABRICS: Mapping[str, Fabric] = {
    fabric.name: fabric
    for fabric in (
        Fabric(
            name="ecp5-25k",
            part="LFE5U-25F-6BG381C",
            family=_ECP5,
            luts=24_288,
            ffs=24_288,
            rams=56,
            ram_kilobits=18,
            pins=197,
            options=("--25k", "--package", "CABGA381", "--speed", "6"),
        ),
        Fabric(
            name="ice40-up5k",
            part="ICE40UP5K-SG48",
            family=_ICE40,
            luts=5_280,
            ffs=5_280,
            rams=30,
            ram_kilobits=4,
            # Three of the 39 pins are open-drain outputs for LEDs, and no clock can come in there.
            pins=36,
            options=("--up5k", "--package", "sg48"),
        ),
        Fabric(
            name="gowin-gw1nr-9c",
            part="GW1NR-LV9QN88PC6/I5",
            family=_GOWIN,
            luts=8_640,
            ffs=6_480,
            rams=26,
            ram_kilobits=18,
            pins=len(_QFN88P),
            options=("--device", "GW1NR-LV9QN88PC6/I5", "--vopt", "family=GW1N-9C"),
            plain_pins=_QFN88P,
        ),
    )
}
"""The FPGAs by name: a Lattice ECP5 and an iCE40 UltraPlus, and the Gowin of the Tang Nano 9K."""
