"""LUTs of random and trained functions by plain Yosys, by ABC alone and by us, as a Markdown table.

python benchmarks/lut_mapping.py --count 100 --efforts 0 1 2
"""

import argparse
import json
import tempfile
import time
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import TruthTable
from wnn2hdl.markdown import head, row
from wnn2hdl.minimise import map_luts
from wnn2hdl.tools import find_yosys

# Modules in one Yosys run; each is mapped on its own, so the counts are those of single runs.
BATCH = 20

Way = Callable[[list[TruthTable]], list[int]]


def random_table(seed: int) -> TruthTable:
    """A random function of 6 to 12 inputs; every other one has don't-cares."""
    rng = np.random.default_rng(seed)
    width = 6 + seed // 2 % 7
    share = 1.0 if seed % 2 == 0 else rng.uniform(0.1, 0.5)
    return _table(width, rng.random(1 << width) < 0.5, rng.random(1 << width) < share)


def trained_table(seed: int) -> TruthTable:
    """A WiSARD (n = 4, k = 16, two discriminators) over 6, 9 or 12 bits of two clouds of colours.

    Every other table cares only for the codes that occurred at least four times in 4,000 training pixels.
    """
    rng = np.random.default_rng(seed)
    depth = 2 + seed // 2 % 3
    width, address_bits, rams = 3 * depth, 4, 16
    centre = rng.integers(20, 140, 3)
    other = np.clip(centre + rng.integers(10, 90, 3) * rng.choice([-1, 1], 3), 10, 245)
    classes = [_pixel_codes(rng, x, depth) for x in (centre, other)]
    repeated = [rng.permutation(width) for _ in range(-(-address_bits * rams // width))]
    mapping = np.concatenate(repeated)[: address_bits * rams].reshape(rams, address_bits)
    codes = np.arange(1 << width)
    addresses = (codes[:, np.newaxis, np.newaxis] >> mapping & 1) @ (1 << np.arange(address_bits))
    responses = []
    for seen in classes:
        hits = [
            np.bincount(addresses[seen, ram], minlength=1 << address_bits)[addresses[:, ram]] > 5
            for ram in range(rams)
        ]
        responses.append(np.sum(hits, axis=0))
    care = np.ones(1 << width, dtype=np.bool_)
    if seed % 2:
        care = np.bincount(np.concatenate(classes), minlength=1 << width) >= 4
    return _table(width, responses[1] > responses[0], care)


def by_synth_xilinx(tables: list[TruthTable]) -> list[int]:
    """LUT cells after `synth_xilinx -family xc7 -flatten -noiopad` of a `case` with x for don't-cares."""
    names = [f"f{x}" for x in range(len(tables))]
    modules = [_module(name, table) for name, table in zip(names, tables, strict=True)]
    ports = ", ".join(
        f"input [{len(table.inputs) - 1}:0] x{name}, output y{name}"
        for name, table in zip(names, tables, strict=True)
    )
    instances = "\n".join(f"{name} i_{name} (.x(x{name}), .y(y{name}));" for name in names)
    script = (
        "read_verilog f.v\nsynth_xilinx -family xc7 -flatten -noiopad -top top\n"
        "tee -q -o stat.json stat -json\n"
    )
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "f.v").write_text("\n".join([*modules, f"module top({ports});", instances, "endmodule\n"]))
        find_yosys().run(script, timeout=3600, cwd=folder)
        stat = json.loads((folder / "stat.json").read_text())
    return [_count(stat["modules"].get(f"\\{x}", {})) for x in names]


def by_abc(tables: list[TruthTable]) -> list[int]:
    """LUTs after Yosys's `abc -lut 6` of the same Verilog."""
    script = (
        "read_verilog f.v\nproc\nopt\nmemory\nopt\ntechmap\nopt\nabc -lut 6\nopt_clean\n"
        "tee -q -o stat.json stat -json\n"
    )
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "f.v").write_text("\n".join(_module(f"f{x}", table) for x, table in enumerate(tables)))
        find_yosys().run(script, timeout=3600, cwd=folder)
        stat = json.loads((folder / "stat.json").read_text())
    return [_count(stat["modules"][f"\\f{x}"]) for x in range(len(tables))]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=100, help="functions of each kind")
    parser.add_argument("--efforts", type=int, nargs="+", default=[0, 1, 2], choices=[0, 1, 2, 3])
    options = parser.parse_args()
    compared = ["against synth_xilinx", "better", "equal", "worse"]
    print(head(["functions", "way", "LUTs", *compared, "seconds per function"]))
    for kind, make in (("random", random_table), ("trained", trained_table)):
        tables = [make(seed) for seed in range(options.count)]
        groups = [("exact", tables[::2]), ("with don't-cares", tables[1::2])]
        for group, members in groups:
            _rows(f"{len(members)} {kind}, {group}", members, options.efforts)


def _rows(title: str, tables: list[TruthTable], efforts: Iterable[int]) -> None:
    reference: list[int] = []
    ways = [("synth_xilinx", _batched(by_synth_xilinx)), ("abc -lut 6", _batched(by_abc))]
    ways += [(f"effort {effort}", _ours(effort)) for effort in efforts]
    for name, way in ways:
        started = time.perf_counter()
        luts = way(tables)
        seconds = (time.perf_counter() - started) / max(len(tables), 1)
        reference = reference or luts
        change = 100 * (sum(luts) / max(sum(reference), 1) - 1)
        signs = np.sign(np.array(luts) - np.array(reference))
        better, equal, worse = ((signs == sign).sum() for sign in (-1, 0, 1))
        figures = [sum(luts), f"{change:+.0f} %", better, equal, worse, seconds]
        print(row([title, name, *figures]), flush=True)


def _ours(effort: int) -> Way:
    return lambda tables: [len(map_luts(table, effort=effort).network.luts) for table in tables]


def _batched(way: Way) -> Way:
    def batches(tables: list[TruthTable]) -> list[int]:
        return [x for start in range(0, len(tables), BATCH) for x in way(tables[start : start + BATCH])]

    return batches


def _table(width: int, values: NDArray[np.bool_], care: NDArray[np.bool_]) -> TruthTable:
    return TruthTable(tuple(f"x{i}" for i in range(width)), ("y",), values.reshape(-1, 1), care)


def _pixel_codes(rng: np.random.Generator, centre: NDArray[np.int64], depth: int) -> NDArray[np.int64]:
    """The high ``depth`` bits of each channel of 2,000 pixels around a colour."""
    light = rng.normal(0, 22, (2000, 1))
    pixels = np.clip(centre + light + rng.normal(0, 12, (2000, 3)), 0, 255).astype(np.int64) >> (8 - depth)
    return pixels @ (1 << depth * np.arange(3))


def _module(name: str, table: TruthTable) -> str:
    width = len(table.inputs)
    codes = np.flatnonzero(table.care)
    cases = "\n".join(f"{width}'d{code}: y = 1'b{int(table.values[code, 0])};" for code in codes)
    default = "" if table.care.all() else "default: y = 1'bx;\n"
    return (
        f"(* keep_hierarchy *) module {name}(input [{width - 1}:0] x, output reg y);\n"
        f"always @* case (x)\n{cases}\n{default}endcase\nendmodule"
    )


def _count(module: dict[str, dict[str, int]]) -> int:
    cells = module.get("num_cells_by_type", {})
    return sum(n for kind, n in cells.items() if kind.startswith("LUT") or kind in ("INV", "$lut"))


if __name__ == "__main__":
    main()
