"""Choosing encoders: which pixel bits a network reads, and thermometers fitted to features."""

from typing import TYPE_CHECKING, Any

from wnn2hdl.encode.bits import high_bits, parse_bits
from wnn2hdl.encode.thermometer import Spacing, fit_thermometer, whole_words

if TYPE_CHECKING:
    from wnn2hdl.encode.transformer import ThermometerEncoder

__all__ = ["Spacing", "ThermometerEncoder", "fit_thermometer", "high_bits", "parse_bits", "whole_words"]


def __getattr__(name: str) -> Any:
    # scikit-learn takes a second to import, which no command should wait for that does not use it.
    if name == "ThermometerEncoder":
        from wnn2hdl.encode.transformer import ThermometerEncoder

        return ThermometerEncoder
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
