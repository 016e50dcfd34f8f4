"""Whether a circuit can fit a device, said before hours go into one that cannot."""

from wnn2hdl.errors import InputError
from wnn2hdl.synth import XC7Z020, Device


def require_capacity(luts: int, allowed: int | None = None, *, device: Device = XC7Z020) -> None:
    """Refuse a circuit that takes more LUTs than the device has.

    Args:
        luts: an estimate of what the circuit takes, or a lower bound.
        allowed: LUTs that the user allows (``--max-luts``); more than the device has stands for a larger one.
        device: the device.

    Raises:
        InputError: neither the device nor the user allows so many.
    """
    if luts > max(device.luts, allowed or 0):
        raise InputError(
            "the circuit is estimated to take more LUTs than the device has",
            value=f"about {luts:,} of the {device.luts:,} of an {device.name}",
            hint=f"use a smaller model, or allow more with --max-luts {luts}",
        )
