"""How long a signal takes: the delay model by which pipelines are cut.

It is a model of cells before placement. Delays of cells are those of Yosys's library of 7-series cells
(``+/xilinx/cells_sim.v``), which has them from Project X-Ray's timing database of the Artix-7; a wire takes
the time that ``synth_xilinx`` itself assumes when it maps to LUTs with ``abc9`` (``-W 300``).
"""

from dataclasses import dataclass

from wnn2hdl.ir import LUT_INPUTS


@dataclass(frozen=True)
class Delays:
    """Delays in picoseconds.

    Attributes:
        register: from the clock's edge to the output of a flip-flop (FDRE, C to Q).
        setup: how long before the edge the input of a flip-flop has to stand (FDRE, D; -46 ps in the
            database, which Yosys takes for 0).
        lut: through a LUT from its slowest pin (LUT6, I0 to O). Every LUT is given this, since a placer may
            exchange pins, and two small LUTs may share one.
        mux_data: through a MUXF7 or MUXF8 from a data pin (MUXF7, I1 to O).
        mux_select: the same from its select pin (MUXF7, S to O).
        carry_start: into a carry chain (CARRY4, CYINIT to CO[3]; the chain's own LUTs come before it).
        carry: through each further CARRY4 (CI to CO[3]).
        carry_end: out of a chain (CARRY4, CI to O[1]).
        net: of a wire between two cells, except from a LUT to the multiplexer beside it.
    """

    register: int = 303
    setup: int = 0
    lut: int = 642
    mux_data: int = 223
    mux_select: int = 296
    carry_start: int = 580
    carry: int = 114
    carry_end: int = 334
    net: int = 300

    def comparison(self, bits: int) -> int:
        """Through the comparison of a word of so many bits with a constant: one LUT, or a carry chain."""
        if bits <= LUT_INPUTS:
            return self.lut
        return self.lut + self.carry_start + self.carry * (-(-bits // 4) - 1) + self.carry_end


XC7 = Delays()
"""The 7-series, as Yosys knows it."""
