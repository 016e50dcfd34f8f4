"""Properties of a video core, from reset on, by ABC: proved for all time, or for the first cycles.

The core is the shell of a video core around circuits of no logic, with lines of up to four pixels, as
``video_properties.v`` wants it. Its streams do whatever that file allows.
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

CYCLES = 16
"""How many: two frames, and what is sent before."""

_MONITOR = Path(__file__).with_name("video_properties.v")
_TIMEOUT = 300.0
_HELD = re.compile(r"Property proved|No output asserted in \d+ frames")
_BROKEN = re.compile(r"was asserted in frame (\d+)")

_SCRIPT = """\
read_verilog core.v
read_verilog -formal -D PROPERTY={name} monitor.v
hierarchy -check -top video_properties
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
    """In which cycle after reset a property can first be broken.

    Args:
        core: the Verilog of the module ``formal_video``.
        name: the property.

    Returns:
        The cycle; None if it is proved that there is none, or none of the first `CYCLES`, see `ALWAYS`.

    Raises:
        ToolError: Yosys or ABC failed.
    """
    with tempfile.TemporaryDirectory(prefix="wnn2hdl-") as place:
        folder = Path(place)
        (folder / "core.v").write_text(core, encoding="utf-8")
        (folder / "monitor.v").write_text(_MONITOR.read_text(encoding="utf-8"), encoding="utf-8")
        find_yosys().run(_SCRIPT.format(name=name), cwd=folder, timeout=_TIMEOUT)
        # `fold` makes the assumptions part of the property.
        search = "pdr" if name in ALWAYS else f"bmc3 -F {CYCLES}"
        log = run_abc(f"read_aiger core.aig; fold; strash; {search}", cwd=folder, timeout=_TIMEOUT)
    if found := _BROKEN.search(log):
        return int(found[1])
    if _HELD.search(log) is None:
        raise ToolError("ABC gives no answer", value=log.strip().splitlines()[-1], output=log)
    return None
