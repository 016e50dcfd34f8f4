"""Networks of gates mapped to LUTs: ABC's part, from a network in AIGER to one in BLIF.

Mapping alone keeps the structure: every LUT is a gate of the network over other gates. That is as quick to
prove as it is to make, whatever the size. Restructuring saves more, but SAT has to find again which gates
are equal, so a recipe that restructures is asked only where the proof was measured to follow.
"""

import tempfile
from dataclasses import dataclass
from pathlib import Path

from wnn2hdl.ir import LutNetwork
from wnn2hdl.ir.models import LogicModel
from wnn2hdl.ir.packing import packed_luts
from wnn2hdl.minimise.recipes import from_blif
from wnn2hdl.progress import Progress, reported
from wnn2hdl.tools import run_abc
from wnn2hdl.tools.aiger import binary_aiger

_SIX = "".join(f"{size} 1 1\n" for size in range(1, 7))
# Six inputs fill a LUT6, where two tables of fewer can share one.
_SHARED = "".join(f"{size} 1 1\n" for size in range(1, 6)) + "6 2 1\n"
# Seconds that no recipe comes near to; an error, never another result.
_SAFETY_NET = 7200.0


@dataclass(frozen=True)
class _Recipe:
    """One way to map a network.

    Attributes:
        name: as the report has it.
        script: commands of ABC, once the network is read.
        most_gates: gates of a network above which it is not asked for.
        effort: below which it is not asked for.
    """

    name: str
    script: str
    most_gates: int
    effort: int


_POLISHED = "dch; if -a; mfs2 -a -e"
_ALL = 10**9

# Measured on multipliers and on layers of random gates with sums behind them, of 1,000 to 22,000 gates: the
# second recipe takes up to 14 % fewer LUTs than the first, the third never fewer, but it may elsewhere.
_RECIPES = (
    _Recipe("if for pairs", "read_lut shared.lut; if -a", _ALL, 0),
    _Recipe("dc2 for pairs", f"read_lut shared.lut; dc2; {_POLISHED}", 30_000, 1),
    _Recipe("dc2", f"read_lut six.lut; dc2; {_POLISHED}", 30_000, 2),
    _Recipe("deepsyn", f"read_lut shared.lut; &get -n; &deepsyn -I 1 -J 3; &put; {_POLISHED}", 5_000, 3),
)


def map_gates(model: LogicModel, effort: int, progress: Progress) -> tuple[LutNetwork, str]:
    """LUTs that compute what a network of gates does, the fewest of several recipes.

    What comes out is right as far as ABC is; the circuit made of it is proved against the model.

    Args:
        model: the network.
        effort: 0 to 3, how many recipes are tried; large networks get fewer.
        progress: reports each recipe.

    Returns:
        The LUTs, whose inputs are ``i0`` and so on, and outputs ``o0`` and so on; and the recipe's name.

    Raises:
        ToolError: ABC is missing or failed.
    """
    asked = [r for r in _RECIPES if r.effort <= effort and len(model.gates) <= r.most_gates]
    with tempfile.TemporaryDirectory(prefix="wnn2hdl-") as place:
        folder = Path(place)
        gates = binary_aiger(model.width, model.literals.tolist(), model.gates)
        (folder / "gates.aig").write_bytes(gates)
        (folder / "six.lut").write_text(_SIX, encoding="ascii")
        (folder / "shared.lut").write_text(_SHARED, encoding="ascii")
        found = [
            (_mapped(model, recipe, folder), recipe.name)
            for recipe in reported(asked, "mapping gates to LUTs", len(asked), progress)
        ]
    return min(found, key=lambda pair: (packed_luts(pair[0]), len(pair[0].cells)))


def _mapped(model: LogicModel, recipe: _Recipe, folder: Path) -> LutNetwork:
    run_abc(
        f"read_aiger gates.aig; strash; {recipe.script}; write_blif luts.blif",
        cwd=folder,
        timeout=_SAFETY_NET,
    )
    draft = from_blif((folder / "luts.blif").read_text(encoding="ascii"), model.width)
    inputs = tuple(f"i{place}" for place in range(model.width))
    return draft.network(inputs, tuple(f"o{place}" for place in range(len(model.outputs))))
