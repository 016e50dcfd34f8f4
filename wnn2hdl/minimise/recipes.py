"""ABC's part of the portfolio: scripts that map a table to LUTs, and the files that go in and out.

What comes out depends on what goes in alone, not on how fast or busy the machine is:

- No command has a time limit. `&deepsyn` and `lutexact` could have one (``-T``), which is off unless asked
  for; what bounds the work are counts of conflicts, nodes, cuts, divisors and rounds, at their defaults.
- Commands that draw random numbers (`dch`, `scorr`, `ifraig`, `&fraig`, `&dch`, `&ttopt`, `&deepsyn`,
  `&decpla`) seed them with a constant each time. Even so each recipe gets its own process: no
  state that another left, and no crash of another, can reach it.
- A recipe is asked only for functions small enough for it, counted in nodes of ABC's own network. The limit
  in seconds is for the unforeseen, far beyond what was measured: exceeding it gives an error, not another
  circuit.

This was read in ABC's sources of August 2026 (berkeley-abc/abc 5ea3464) and measured with the yosys-abc of
pyosys 0.70, which is a little younger and has `&decpla`.
"""

import math
import re
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from graphlib import TopologicalSorter
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import ToolError, ToolStoppedError
from wnn2hdl.ir import LUT_INPUTS, Column, codes_to_bits, pack_contents
from wnn2hdl.minimise.draft import ONE, ZERO, Draft
from wnn2hdl.minimise.support import members, minimum_supports, restrict
from wnn2hdl.tools import find_abc, run_abc

# Seven inputs are two LUTs and a MUXF7, eight are four LUTs, two MUXF7 and a MUXF8.
_AREA = "1 1 1\n2 1 1\n3 1 1\n4 1 1\n5 1 1\n6 1 1\n7 2 1\n8 4 1\n"
# The costs with which Yosys's synth_xilinx maps for this family (-luts 2:2,3,6:5,10,20).
_YOSYS_AREA = "1 2 1\n2 2 1\n3 3 1\n4 5 1\n5 5 1\n6 5 1\n7 10 1\n8 20 1\n"

_POLISH = "mfs2 -a -e; lutpack"
_REMAP = f"strash; dch -f; if -a; {_POLISH}"


@dataclass(frozen=True)
class _Recipe:
    """One way to map a complete truth table, already read.

    Attributes:
        name: its name among the candidates.
        script: commands of ABC; {inputs} is the number of inputs, {luts} that of a LUT.
        most_nodes: nodes of the function's AND-inverter graph above which it is not asked for.
        six: whether it is for LUTs of six inputs only, as one that reads the areas of wider functions.
    """

    name: str
    script: str
    most_nodes: float = math.inf
    six: bool = False


# Measured on random functions, which are the worst (12 inputs are 3,400 nodes, 14 are 12,500, 16 are 47,000):
# at their limit most take up to half a minute of processor time, and "deepsyn 20" some minutes.
_LIGHT, _MEDIUM, _HEAVY = 50_000, 12_000, 2_000

# Effort e runs the first e + 1 groups.
_FROM_TRUTH = (
    (_Recipe("lutmin", "lutmin -K {luts}"),),
    (
        _Recipe(
            "yosys",
            "read_lut yosys.lut; strash; &get -n; &fraig -x; &put; scorr; dc2; dch -f; if; mfs2",
            _LIGHT,
            six=True,
        ),
        _Recipe("dch if", f"read_lut plain.lut; strash; dch; if -a; {_POLISH}", _LIGHT),
        _Recipe("wide if", "read_lut area.lut; strash; dch -f; if -a", _LIGHT, six=True),
        _Recipe("lutmin again", f"read_lut plain.lut; lutmin -K {{luts}}; {_POLISH}; {_REMAP}", _LIGHT),
        _Recipe(
            "ttopt", f"read_lut plain.lut; strash; &get -n; &ttopt -I {{inputs}} -O 1; &put; {_REMAP}", _LIGHT
        ),
    ),
    (
        _Recipe("fx", f"read_lut plain.lut; collapse; sop; fx; {_REMAP}; {_REMAP}", _MEDIUM),
        _Recipe("compress", f"read_lut plain.lut; strash; dc2; dc2; ifraig; {_REMAP}; {_REMAP}", _MEDIUM),
        _Recipe(
            "deepsyn",
            f"read_lut plain.lut; strash; &get -n; &deepsyn -I 1 -J 3; &put; {_REMAP}; {_REMAP}",
            _HEAVY,
        ),
    ),
    (
        _Recipe(
            "deepsyn 20",
            f"read_lut plain.lut; strash; &get -n; &deepsyn -I 2 -J 20; &put; {_REMAP}; {_REMAP}",
            _HEAVY,
        ),
    ),
)
# From the cared-for codes themselves: bi-decomposition, with as many attempts.
_FROM_CARE = ((), (1,), (1, 8), (1, 8, 30))
# From a network that is mapped already.
_FROM_NETWORK = (
    ("polish", f"read_lut plain.lut; {_POLISH}"),
    ("remap", f"read_lut plain.lut; {_REMAP}; {_REMAP}"),
)
# Codes above which the text of the care set costs more than it gains: at the limit one attempt takes 7 s.
_MAX_PLA_ROWS = 1 << 14
# Seconds that no recipe comes near to; an error, never another result.
_SAFETY_NET = 3600.0
_NODES = re.compile(r"\band = *(\d+)")


def truth_candidates(
    truth: NDArray[np.bool_], effort: int, lut_inputs: int = LUT_INPUTS
) -> Iterator[tuple[str, Draft]]:
    """Networks for a completely specified function, bool ``[2**n, outputs]``, each with its recipe's name.

    The networks are right only as far as ABC is; the caller checks them.
    """
    width = truth.shape[0].bit_length() - 1
    files = {"f.truth": "".join(_digits(column[::-1]) + "\n" for column in truth.T)}
    read = "read_truth -xf f.truth"
    recipes = [recipe for level in _FROM_TRUTH[: effort + 1] for recipe in level]
    nodes = _nodes(read, files) if effort else 0
    scripts = [
        (recipe.name, f"{read}; {recipe.script.format(inputs=width, luts=lut_inputs)}")
        for recipe in recipes
        if nodes <= recipe.most_nodes and (lut_inputs == LUT_INPUTS or not recipe.six)
    ]
    yield from _run(scripts, files, width, lut_inputs)


def care_candidates(
    values: NDArray[np.bool_], care: NDArray[np.bool_], effort: int, lut_inputs: int = LUT_INPUTS
) -> Iterator[tuple[str, Draft]]:
    """As `truth_candidates`, for values that count only where ``care``, bool ``[2**n]``."""
    codes = np.flatnonzero(care)
    if len(codes) > _MAX_PLA_ROWS or not _FROM_CARE[effort]:
        return
    width = len(care).bit_length() - 1
    bits = codes_to_bits(codes, width)
    rows = [f"{_digits(code)} {_digits(wanted)}" for code, wanted in zip(bits, values[codes], strict=True)]
    pla = f".i {width}\n.o {values.shape[1]}\n.type fr\n" + "\n".join(rows) + "\n.e\n"
    scripts = [
        (f"decpla {attempts}", f"read_lut plain.lut; &decpla -K {attempts} f.pla; &put; {_REMAP}")
        for attempts in _FROM_CARE[effort]
    ]
    yield from _run(scripts, {"f.pla": pla}, width, lut_inputs)


def network_candidates(draft: Draft) -> Iterator[tuple[str, Draft]]:
    """Networks equal to the draft on all codes, made from it."""
    scripts = [(name, f"read_blif f.blif; {script}") for name, script in _FROM_NETWORK]
    yield from _run(scripts, {"f.blif": to_blif(draft)}, draft.width, draft.lut_inputs)


def two_lut_candidates(truth: NDArray[np.bool_], lut_inputs: int = LUT_INPUTS) -> Iterator[tuple[str, Draft]]:
    """The two LUTs that make a completely specified function, bool ``[2**n]``, if there are such two.

    ABC's ``lutexact`` decides this by SAT. Measured (yosys-abc of pyosys 0.70): for two LUTs it takes under
    0.2 s, whatever the function. Of 8-input functions made of two LUTs that share three inputs it maps 10 of
    10, which the rest of the portfolio maps to four; of 30 tables of 8 and 9 inputs with don't-cares, filled
    by the best network, it maps none better. Three LUTs take from 0.1 s to more than 10 s at eight inputs,
    and `lutexact` counts no conflicts that could end that; so three are not asked for.
    """
    support = members(minimum_supports(truth, ~truth)[0])
    width = len(support)
    # One pin of the two LUTs is the wire that joins them.
    if not lut_inputs < width <= 2 * lut_inputs - 1:
        return
    column = restrict(truth, sum(1 << x for x in support))
    digits = f"{pack_contents(column):0{len(column) // 4}x}"
    # ABC names the file after the first 16 digits; if there is no solution, there is no file to read.
    script = f"lutexact -d -N {width} -M 2 -K {lut_inputs} {digits}; read_blif {digits[:16]}_.blif"
    for method, small in _run([("lutexact", script)], {}, width, lut_inputs):
        draft = Draft(truth.shape[0].bit_length() - 1, lut_inputs=lut_inputs)
        signals = dict(enumerate(support))
        for number in small.order():
            cell = small.cells[number]
            signals[number] = draft.add(tuple(signals[x] for x in cell.fanins), cell.contents)
        draft.outputs = [signals[x] for x in small.outputs]
        yield method, draft


def _run(
    scripts: Sequence[tuple[str, str]], files: dict[str, str], width: int, lut_inputs: int
) -> Iterator[tuple[str, Draft]]:
    """What each script makes of the files, one process each, started when it is asked for."""
    find_abc()  # a missing ABC is reported to the user; a recipe that fails is not
    with _folder(files, lut_inputs) as folder:
        for number, (method, script) in enumerate(scripts):
            result = folder / f"{number}.blif"
            try:
                run_abc(f"{script}; write_blif {result.name}", cwd=folder, timeout=_SAFETY_NET)
            except ToolStoppedError:
                raise
            except ToolError:
                continue  # ABC refuses some functions, and asserts on others
            yield method, from_blif(result.read_text(encoding="ascii"), width, lut_inputs)


def _nodes(script: str, files: dict[str, str]) -> int:
    """Nodes of the AND-inverter graph of what a script reads, as ABC makes it before any recipe."""
    with _folder(files) as folder:
        output = run_abc(f"{script}; strash; print_stats", cwd=folder, timeout=_SAFETY_NET)
    found = _NODES.search(output)
    if found is None:
        raise ToolError("yosys-abc did not print the number of nodes", output=output)
    return int(found[1])


@contextmanager
def _folder(files: dict[str, str], lut_inputs: int = LUT_INPUTS) -> Iterator[Path]:
    """A temporary folder with these files and the LUT libraries."""
    with tempfile.TemporaryDirectory(prefix="wnn2hdl-") as name:
        folder = Path(name)
        plain = "".join(f"{inputs} 1 1\n" for inputs in range(1, lut_inputs + 1))
        for file, text in {**files, "plain.lut": plain, "area.lut": _AREA, "yosys.lut": _YOSYS_AREA}.items():
            (folder / file).write_text(text, encoding="ascii")
        yield folder


def _digits(flags: NDArray[np.bool_] | Column) -> str:
    """``0110`` for four flags, the first one first."""
    return (flags.astype(np.uint8) + ord("0")).tobytes().decode("ascii")


def to_blif(draft: Draft) -> str:
    """The draft as BLIF; input ``i`` is named ``i<i>``, output ``j`` is named ``o<j>``."""
    lines = [
        ".model f",
        ".inputs " + " ".join(f"i{x}" for x in range(draft.width)),
        ".outputs " + " ".join(f"o{x}" for x in range(len(draft.outputs))),
        ".names zero",
        ".names one",
        "1",
    ]
    names = {**{x: f"i{x}" for x in range(draft.width)}, ZERO: "zero", ONE: "one"}
    for number in draft.order():
        cell = draft.cells[number]
        names[number] = f"c{number}"
        lines.append(".names " + " ".join(names[x] for x in (*cell.fanins, number)))
        addresses = codes_to_bits(np.flatnonzero(cell.contents), len(cell.fanins))
        lines += [f"{_digits(address)} 1" for address in addresses]
    lines += [f".names {names[signal]} o{position}\n1 1" for position, signal in enumerate(draft.outputs)]
    return "\n".join([*lines, ".end", ""])


def from_blif(text: str, width: int, lut_inputs: int = LUT_INPUTS) -> Draft:
    """Read what ABC wrote; inputs and outputs are taken in the order of their declaration."""
    draft = Draft(width, lut_inputs=lut_inputs)
    tables: dict[str, tuple[list[str], list[str]]] = {}
    inputs: list[str] = []
    outputs: list[str] = []
    cubes: list[str] = []
    for line in text.replace("\\\n", " ").splitlines():
        words = line.split("#")[0].split()
        if not words:
            continue
        if words[0] == ".inputs":
            inputs = words[1:]
        elif words[0] == ".outputs":
            outputs = words[1:]
        elif words[0] == ".names":
            cubes = []
            tables[words[-1]] = (words[1:-1], cubes)
        elif not words[0].startswith("."):
            cubes.append(line)
    signals = {name: position for position, name in enumerate(inputs)}
    order = TopologicalSorter({name: fanins for name, (fanins, _) in tables.items()}).static_order()
    for name in (name for name in order if name in tables):
        fanins, rows = tables[name]
        signals[name] = _add_wide(draft, tuple(signals[x] for x in fanins), _contents(len(fanins), rows))
    draft.outputs = [signals[name] for name in outputs]
    return draft


def _contents(width: int, rows: list[str]) -> Column:
    codes = np.arange(1 << width)
    hit = np.zeros(1 << width, dtype=np.bool_)
    value = 1
    for row in rows:
        *cube, output = row.split()
        value = int(output)
        mask = sum(1 << x for x, literal in enumerate(cube[0]) if literal != "-") if cube else 0
        wanted = sum(1 << x for x, literal in enumerate(cube[0]) if literal == "1") if cube else 0
        hit |= codes & mask == wanted
    return (hit if value else ~hit).astype(np.uint8)


def _add_wide(draft: Draft, fanins: tuple[int, ...], contents: Column) -> int:
    if len(fanins) <= draft.lut_inputs:
        return draft.add(fanins, contents)
    low, high = (_add_wide(draft, fanins[:-1], half) for half in np.split(contents, 2))
    return draft.add_mux(low, high, fanins[-1])
