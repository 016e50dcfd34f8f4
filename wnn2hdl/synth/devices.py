"""What a device has, and the share of it that a circuit takes."""

from dataclasses import asdict, dataclass

from wnn2hdl.synth.resources import Resources


@dataclass(frozen=True)
class Device:
    """The resources of an FPGA.

    Attributes:
        name: part and package.
        luts: 6-input LUTs.
        ffs: flip-flops.
        bram36: block RAMs of 36 Kb.
        dsp: DSP slices.
    """

    name: str
    luts: int
    ffs: int
    bram36: int
    dsp: int


XC7Z020 = Device("xc7z020clg484", luts=53_200, ffs=106_400, bram36=140, dsp=220)
"""Zynq-7020, the device of the reference design (AMD DS190, Zynq-7000 overview)."""


@dataclass(frozen=True)
class Utilisation:
    """Shares of a device in percent.

    Attributes:
        device: its name.
        luts: LUTs and shift registers in LUTs.
        ffs: flip-flops.
        bram36: block RAMs.
        dsp: DSP slices.
    """

    device: str
    luts: float
    ffs: float
    bram36: float
    dsp: float


def utilisation(resources: Resources, device: Device = XC7Z020) -> Utilisation:
    """The share of a device that a circuit takes."""
    return Utilisation(
        device=device.name,
        luts=100 * (resources.luts + resources.srl) / device.luts,
        ffs=100 * resources.ffs / device.ffs,
        bram36=100 * resources.bram36 / device.bram36,
        dsp=100 * resources.dsp / device.dsp,
    )


def shares(resources: Resources) -> dict[str, float]:
    """The shares of `utilisation` by name, as reports list them."""
    return {name: share for name, share in asdict(utilisation(resources)).items() if name != "device"}
