"""Properties of a video core and of its registers, from reset on, by ABC: for all time, or the first cycles.

The core is the shell of a video core around circuits of no logic, with lines of up to four pixels, as
``video_properties.v`` wants it. Its streams do whatever that file allows. The registers are those of a video
core, whose bus does whatever ``bus_properties.v`` allows.
"""

import re
import tempfile
from pathlib import Path
from typing import Literal

from wnn2hdl.errors import ToolError
from wnn2hdl.tools import find_yosys, run_abc

Property = Literal["stays", "in_order", "all_come", "goes_on"]
"""A beat that is offered stays until it is taken; answers come in order, of the frames that were sent and
with their marks; none is missing; the core takes the next beat in bounded time, whatever frames came before.
"""

ALWAYS: frozenset[Property] = frozenset({"stays", "goes_on"})
"""The properties that are proved for all time; the others are searched for in the first cycles."""

BusProperty = Literal["stays", "answers", "refuses", "goes_on", "keeps"]
"""All for all time: an answer stays until it is taken; each request has one, and no request is taken before
the answer to the one before is; those to addresses without a register, or that can only be read, are errors;
a request is taken in bounded time; what is written is kept byte by byte and read, and events are until they
are cleared, and interrupt.
"""

CYCLES = 16
"""How many: two frames, and what is sent before."""

_TIMEOUT = 300.0
_HELD = re.compile(r"Property proved|No output asserted in \d+ frames")
_BROKEN = re.compile(r"was asserted in frame (\d+)")

_SCRIPT = """\
read_verilog core.v
read_verilog -formal -D PROPERTY={name} monitor.v
hierarchy -check -top {monitor}
proc
flatten
memory_dff
memory_map
opt_clean
async2sync
formalff -clk2ff -ff2anyinit
chformal -lower
dffunmap
setundef -undriven -anyseq
opt -fast
techmap
opt -fast
aigmap
write_aiger -I -B -zinit -no-startoffset core.aig
"""


def first_broken(core: str, name: Property) -> int | None:
    """In which cycle after reset a property of a video core can first be broken.

    Args:
        core: the Verilog of the module ``formal_video``.
        name: the property.

    Returns:
        The cycle; None if it is proved that there is none, or none of the first `CYCLES`, see `ALWAYS`.

    Raises:
        ToolError: Yosys or ABC failed.
    """
    return _searched(core, "video_properties", name, "pdr" if name in ALWAYS else f"bmc3 -F {CYCLES}")


def bus_broken(control: str, name: BusProperty) -> int | None:
    """In which cycle after reset a property of registers can first be broken; None if there is none.

    Args:
        control: the Verilog of the module ``formal_control``.
        name: the property.

    Raises:
        ToolError: Yosys or ABC failed.
    """
    return _searched(control, "bus_properties", name, "pdr")


def _searched(core: str, monitor: str, name: str, search: str) -> int | None:
    with tempfile.TemporaryDirectory(prefix="wnn2hdl-") as place:
        folder = Path(place)
        (folder / "core.v").write_text(core, encoding="utf-8")
        text = Path(__file__).with_name(f"{monitor}.v").read_text(encoding="utf-8")
        (folder / "monitor.v").write_text(text, encoding="utf-8")
        find_yosys().run(_SCRIPT.format(name=name, monitor=monitor), cwd=folder, timeout=_TIMEOUT)
        # `fold` makes the assumptions part of the property.
        log = run_abc(f"read_aiger core.aig; fold; strash; {search}", cwd=folder, timeout=_TIMEOUT)
    if found := _BROKEN.search(log):
        return int(found[1])
    if _HELD.search(log) is None:
        raise ToolError("ABC gives no answer", value=log.strip().splitlines()[-1], output=log)
    return None
