"""Networks against straightforward Verilog of the same models, and at scale.

``python benchmarks/networks.py DATA [--models NAME …] [--implied] [--scale NODES …]``: DATA is the folder
with ``dwn``, ``kanele``, ``wisardpkg`` and ``uci``. The first table counts each network twice by the same run
of `synth_xilinx`: as it is compiled, and as an engineer would write it (`benchmarks.plain`). Both are whole
networks, encoder, tables, sums and winner. ``--implied`` adds what a network takes without the don't-cares
that a thermometer implies. ``--scale`` compiles networks of so many tables instead, each in a process of its
own: wall clock, CPU seconds (user time) and the most memory, children included.

The networks of ``--scale`` have 784 bytes with three thresholds each, and one layer of random 6-input tables
on random bits for ten classes. Random tables share nothing and drop nothing, so trained ones take less.
"""

import argparse
import tempfile
from collections.abc import Callable
from pathlib import Path
from unittest import mock

import numpy as np

from benchmarks.compiling import compile_apart
from benchmarks.plain import TOP, plain_verilog
from benchmarks.published import ROWS, load, train
from wnn2hdl.build.planning import with_input
from wnn2hdl.elaborate import component
from wnn2hdl.emit import verilog
from wnn2hdl.importers import import_model
from wnn2hdl.importers.base import ImportOptions
from wnn2hdl.ir import Thermometer
from wnn2hdl.ir.care import Everything
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.ir.models import AnyModel, LutGroupModel, LutLayer, TableSumModel, VotingModel
from wnn2hdl.lower import structural
from wnn2hdl.lower.targets import Ingredients, target_for
from wnn2hdl.markdown import head, row
from wnn2hdl.minimise.circuit import minimise
from wnn2hdl.synth import synthesise
from wnn2hdl.verify.equivalence import Circuit, evaluate
from wnn2hdl.verify.specify import specify

GOAL = 0.7
"""Our LUTs for each of the straightforward Verilog, at most."""

CHECKED = 8
"""Vectors on which the straightforward Verilog is compared with the model."""


def imported(path: Path, words: str | None = None, bleach: int | None = None) -> AnyModel:
    """A published model, with a format of its features or a fixed bleaching threshold where it has none."""
    _, model = import_model(path, ImportOptions(bleach=bleach))
    assert isinstance(model, AnyModel)
    return model if words is None else with_input(model, words)


def trained(data: Path, name: str) -> AnyModel:
    """A network trained by gradient, as in `benchmarks.published`."""
    return train(load(data, ROWS[name].data, 0), ROWS[name], 0).model


def models(data: Path) -> dict[str, Callable[[], AnyModel]]:
    """Every model at hand by name."""
    dwn, pixels = data / "dwn", data / "wisardpkg" / "pixels_n4_bleach.json"
    small, large = (
        dwn / f"dwn_jsc_{name}_checkpoint.pt"
        for name in ("t200_distributive_50_l_b100", "t4_distributive_300-100_lr")
    )
    return {
        "dwn-50": lambda: imported(small, "Q3.12"),
        "dwn-300-100": lambda: imported(large, "Q3.12"),
        "kanele-jets": lambda: imported(data / "kanele" / "jsc_openml" / "truth_tables.json"),
        "kanele-mnist": lambda: imported(data / "kanele" / "mnist" / "truth_tables.json"),
        "wisardpkg-bleach-3": lambda: imported(pixels, bleach=3),
        "trained-vowel": lambda: trained(data, "vowel"),
        "trained-satimage": lambda: trained(data, "satimage"),
    }


def luts(model: AnyModel) -> int:
    """What the compiled network takes."""
    lowered = target_for(model, "network").lower(Ingredients(model))
    circuit = minimise(lowered, 1, lambda *_: None).circuit
    text = verilog(component(circuit, style="cells"), prefix="x_", header=[])
    return synthesise(text, f"x_{circuit.name}").resources.luts


def plain_luts(model: AnyModel) -> int:
    """What the straightforward Verilog takes; it has to answer as the model."""
    assert isinstance(model, VotingModel | TableSumModel)
    text = plain_verilog(model)
    claim = specify(model, None, {}).claims["network"]
    assert claim.stimulus is not None
    inputs = claim.stimulus()["features"]
    chosen = np.random.default_rng(0).choice(len(inputs), CHECKED, replace=False)
    wanted = claim.answers({"features": inputs[chosen]})["class_bits"]
    for bits, answer in zip(inputs[chosen], wanted, strict=True):
        word = sum(1 << int(place) for place in np.flatnonzero(bits))
        found = evaluate(Circuit((text,), TOP), {"features": word}, claim.inputs, ("class_bits",))
        if found["class_bits"] != sum(1 << int(place) for place in np.flatnonzero(answer)):
            raise AssertionError("the straightforward Verilog is not the model")
    return synthesise(text, TOP, baseline=True).resources.luts


def without_implied(model: AnyModel) -> int:
    """What the network takes if every combination of a thermometer's bits counts as one that may occur."""
    with mock.patch.object(structural, "implied", lambda encoder: Everything(encoder.width)):
        return luts(model)


def scale_network(nodes: int) -> LutGroupModel:
    """The network of ``--scale``."""
    rng = np.random.default_rng(0)
    levels = np.sort([rng.choice(np.arange(16, 241), 3, replace=False) for _ in range(784)], axis=1)
    encoder = Thermometer(
        tuple(tuple(map(float, row)) for row in levels), strict=False, input=FixedPoint(8, 0, signed=False)
    )
    mapping = np.stack([rng.choice(encoder.width, 6, replace=False) for _ in range(nodes)]).astype(np.int32)
    layer = LutLayer(mapping, rng.random((nodes, 64)) < 0.5)
    owners = (np.arange(nodes) * 10 // nodes).astype(np.int32)
    return LutGroupModel(encoder, tuple(map(str, range(10))), (layer,), owners)


def scale(nodes: int) -> None:
    """Print a row about a compile of so many tables."""
    with tempfile.TemporaryDirectory() as place:
        found = compile_apart(scale_network(nodes), Path(place))
    figures = [nodes, round(found.wall), round(found.cpu), round(found.peak / 1e6)]
    print(row([*figures, found.luts or "", found.proof]), flush=True)


def main() -> None:
    """Print the tables asked for."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("data", type=Path)
    parser.add_argument("--models", nargs="+")
    parser.add_argument("--implied", action="store_true")
    parser.add_argument("--scale", nargs="+", type=int, metavar="NODES")
    given = parser.parse_args()
    if given.scale:
        print(head(["tables", "wall s", "CPU s", "peak MB", "LUTs", "proof"]))
        for nodes in given.scale:
            scale(nodes)
        return
    known = models(given.data)
    columns = ["model", "LUTs", "straightforward", "share", f"at most {GOAL}"]
    print(head([*columns, "without implied"] if given.implied else columns))
    for name in given.models or known:
        model = known[name]()
        ours, plain = luts(model), plain_luts(model)
        cells = [name, ours, plain, f"{ours / plain:.2f}", "won" if ours <= GOAL * plain else "lost"]
        if given.implied:
            cells.append("" if isinstance(model, TableSumModel) else without_implied(model))
        print(row(cells), flush=True)


if __name__ == "__main__":
    main()
