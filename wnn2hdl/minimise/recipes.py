"""ABC's part of the portfolio: scripts that map a table to LUTs, and the files that go in and out."""

import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import ToolError
from wnn2hdl.ir import LUT_INPUTS
from wnn2hdl.minimise.draft import ONE, ZERO, Bits, Draft
from wnn2hdl.minimise.support import members, minimum_supports, restrict
from wnn2hdl.tools import find_abc, run_abc

# Seven inputs are two LUTs and a MUXF7, eight are four LUTs, two MUXF7 and a MUXF8.
_AREA = "1 1 1\n2 1 1\n3 1 1\n4 1 1\n5 1 1\n6 1 1\n7 2 1\n8 4 1\n"
# The costs with which Yosys's synth_xilinx maps for this family (-luts 2:2,3,6:5,10,20).
_YOSYS_AREA = "1 2 1\n2 2 1\n3 3 1\n4 5 1\n5 5 1\n6 5 1\n7 10 1\n8 20 1\n"
_SIX = "1 1 1\n2 1 1\n3 1 1\n4 1 1\n5 1 1\n6 1 1\n"

_POLISH = "mfs2 -a -e; lutpack"
_REMAP = f"strash; dch -f; if -a; {_POLISH}"

# From a complete truth table, already read; effort e runs the first e + 1 groups. {inputs} is their number.
_FROM_TRUTH = (
    (("lutmin", "lutmin -K 6"),),
    (
        ("yosys", "read_lut yosys.lut; strash; &get -n; &fraig -x; &put; scorr; dc2; dch -f; if; mfs2"),
        ("dch if", f"read_lut six.lut; strash; dch; if -a; {_POLISH}"),
        ("wide if", "read_lut area.lut; strash; dch -f; if -a"),
        ("lutmin again", f"read_lut six.lut; lutmin -K 6; {_POLISH}; {_REMAP}"),
        ("ttopt", f"read_lut six.lut; strash; &get -n; &ttopt -I {{inputs}} -O 1; &put; {_REMAP}"),
    ),
    (
        ("fx", f"read_lut six.lut; collapse; sop; fx; {_REMAP}; {_REMAP}"),
        ("compress", f"read_lut six.lut; strash; dc2; dc2; ifraig; {_REMAP}; {_REMAP}"),
        ("deepsyn", f"read_lut six.lut; strash; &get -n; &deepsyn -I 1 -J 3; &put; {_REMAP}; {_REMAP}"),
    ),
    (("deepsyn 20", f"read_lut six.lut; strash; &get -n; &deepsyn -I 2 -J 20; &put; {_REMAP}; {_REMAP}"),),
)
# From the cared-for codes themselves: bi-decomposition, with as many attempts.
_FROM_CARE = ((), (1,), (1, 8), (1, 8, 30))
# From a network that is mapped already.
_FROM_NETWORK = (
    ("polish", f"read_lut six.lut; {_POLISH}"),
    ("remap", f"read_lut six.lut; {_REMAP}; {_REMAP}"),
)
# Inputs that two LUTs can read between them, one pin being the wire that joins them.
_MAX_TWO_LUT_INPUTS = 2 * LUT_INPUTS - 1
# Seconds; a script that hangs loses its candidates, nothing else.
_TIME_LIMITS = (10.0, 30.0, 60.0, 300.0)
# Codes above which the text of the care set costs more than it gains.
_MAX_PLA_ROWS = 1 << 14


def truth_candidates(truth: NDArray[np.bool_], effort: int) -> Iterator[tuple[str, Draft]]:
    """Networks for a completely specified function, bool ``[2**n, outputs]``, each with its recipe's name.

    The networks are right only as far as ABC is; the caller checks them.
    """
    width = truth.shape[0].bit_length() - 1
    files = {"f.truth": "".join("".join("01"[int(x)] for x in column[::-1]) + "\n" for column in truth.T)}
    recipes = [
        (name, f"read_truth -xf f.truth; {script.format(inputs=width)}")
        for level in _FROM_TRUTH[: effort + 1]
        for name, script in level
    ]
    yield from _run(recipes, files, width, effort)


def care_candidates(
    values: NDArray[np.bool_], care: NDArray[np.bool_], effort: int
) -> Iterator[tuple[str, Draft]]:
    """As `truth_candidates`, for values that count only where ``care``, bool ``[2**n]``."""
    codes = np.flatnonzero(care)
    if len(codes) > _MAX_PLA_ROWS or not _FROM_CARE[effort]:
        return
    width = len(care).bit_length() - 1
    rows = [
        "".join("01"[code >> x & 1] for x in range(width)) + " " + "".join("01"[int(x)] for x in values[code])
        for code in codes.tolist()
    ]
    pla = f".i {width}\n.o {values.shape[1]}\n.type fr\n" + "\n".join(rows) + "\n.e\n"
    recipes = [
        (f"decpla {attempts}", f"read_lut six.lut; &decpla -K {attempts} f.pla; &put; {_REMAP}")
        for attempts in _FROM_CARE[effort]
    ]
    yield from _run(recipes, {"f.pla": pla}, width, effort)


def network_candidates(draft: Draft, effort: int) -> Iterator[tuple[str, Draft]]:
    """Networks equal to the draft on all codes, made from it."""
    recipes = [(name, f"read_blif f.blif; {script}") for name, script in _FROM_NETWORK]
    yield from _run(recipes, {"f.blif": to_blif(draft)}, draft.width, effort)


def two_lut_candidates(truth: NDArray[np.bool_]) -> Iterator[tuple[str, Draft]]:
    """The two LUTs that make a completely specified function, bool ``[2**n]``, if there are such two.

    ABC's ``lutexact`` decides this by SAT. Measured (yosys-abc of pyosys 0.70): for two LUTs it takes under
    0.2 s, whatever the function. Of 8-input functions made of two LUTs that share three inputs it maps 10 of
    10, which the rest of the portfolio maps to four; of 30 tables of 8 and 9 inputs with don't-cares, filled
    by the best network, it maps none better. Three LUTs take from 0.1 s to more than 10 s at eight inputs,
    and only a time limit could end that, which would let the result depend on the machine; so three are not
    asked for.
    """
    support = members(minimum_supports(truth, ~truth)[0])
    width = len(support)
    if not LUT_INPUTS < width <= _MAX_TWO_LUT_INPUTS:
        return
    column = restrict(truth, sum(1 << x for x in support))
    digits = np.packbits(column, bitorder="little")[::-1].tobytes().hex()
    # ABC names the file after the first 16 digits; if there is no solution, there is no file to read.
    script = f"lutexact -d -N {width} -M 2 -K {LUT_INPUTS} {digits}; read_blif {digits[:16]}_.blif"
    for method, small in _run([("lutexact", script)], {}, width, 0):
        draft = Draft(truth.shape[0].bit_length() - 1)
        signals = dict(enumerate(support))
        for number in small.order():
            cell = small.cells[number]
            signals[number] = draft.add(tuple(signals[x] for x in cell.fanins), cell.contents)
        draft.outputs = [signals[x] for x in small.outputs]
        yield method, draft


def _run(
    recipes: Sequence[tuple[str, str]], files: dict[str, str], width: int, effort: int
) -> Iterator[tuple[str, Draft]]:
    find_abc()  # a missing ABC is the user's to know; a recipe that fails is not
    with tempfile.TemporaryDirectory(prefix="wnn2hdl-") as name:
        folder = Path(name)
        for file, text in {**files, "six.lut": _SIX, "area.lut": _AREA, "yosys.lut": _YOSYS_AREA}.items():
            (folder / file).write_text(text, encoding="ascii")
        pending = list(enumerate(recipes))
        while pending:
            script = "\n".join(f"{recipe}; write_blif {index}.blif" for index, (_, recipe) in pending)
            try:
                run_abc(script, cwd=folder, timeout=_TIME_LIMITS[effort])
                failed = len(recipes)
            except ToolError:
                # ABC asserts on some functions and then ends: go on behind the recipe that did it.
                failed = next(x for x, _ in pending if not (folder / f"{x}.blif").exists())
            for index, (method, _) in pending:
                if index < failed and (folder / f"{index}.blif").exists():
                    yield method, from_blif((folder / f"{index}.blif").read_text(encoding="ascii"), width)
            pending = [(x, recipe) for x, recipe in pending if x > failed]


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
        places = range(len(cell.fanins))
        lines += [
            "".join("01"[address >> x & 1] for x in places) + " 1"
            for address in np.flatnonzero(cell.contents).tolist()
        ]
    lines += [f".names {names[signal]} o{position}\n1 1" for position, signal in enumerate(draft.outputs)]
    return "\n".join([*lines, ".end", ""])


def from_blif(text: str, width: int) -> Draft:
    """Read what ABC wrote; inputs and outputs are taken in the order of their declaration."""
    draft = Draft(width)
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
    for name in _sorted_names(tables, outputs):
        fanins, rows = tables[name]
        signals[name] = _add_wide(draft, tuple(signals[x] for x in fanins), _contents(len(fanins), rows))
    draft.outputs = [signals[name] for name in outputs]
    return draft


def _sorted_names(tables: dict[str, tuple[list[str], list[str]]], outputs: list[str]) -> list[str]:
    done: dict[str, None] = {}
    stack = list(reversed(outputs))
    while stack:
        name = stack[-1]
        missing = [x for x in tables[name][0] if x in tables and x not in done] if name in tables else []
        if missing:
            stack += missing
        else:
            stack.pop()
            if name in tables:
                done[name] = None
    return list(done)


def _contents(width: int, rows: list[str]) -> Bits:
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


def _add_wide(draft: Draft, fanins: tuple[int, ...], contents: Bits) -> int:
    if len(fanins) <= LUT_INPUTS:
        return draft.add(fanins, contents)
    low, high = (_add_wide(draft, fanins[:-1], half) for half in np.split(contents, 2))
    return draft.add_mux(low, high, fanins[-1])
