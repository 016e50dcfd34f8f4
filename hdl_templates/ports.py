"""Names and loose ends that make emitted Verilog readable; in simulation they would only cost time."""

from collections.abc import Sequence

from amaranth.hdl import Cat, Module, Signal, Value

from hdl_templates.hierarchy import Emission


def named(m: Module, name: str, value: Value, platform: object) -> Value:
    """A value under its own name, so that emitted equations read ``R7`` and not ``rgb[23]``.

    Without an `Emission` it stays as it is: each signal costs Amaranth's simulator another round.
    """
    if not isinstance(platform, Emission):
        return value
    signal = Signal(value.shape(), name=name)
    m.d.comb += signal.eq(value)
    return signal


def tie_off(m: Module, bits: Sequence[Value], platform: object) -> None:
    """Gather bits of ports that nothing reads in a signal ``unused``, which linters take as intended."""
    if bits:
        named(m, "unused", Cat(*bits).any(), platform)
