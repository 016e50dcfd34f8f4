"""BTHOWeN's ten published models, compiled: accuracy, LUTs, proof, and what it takes to make them.

``python benchmarks/bthowen.py DATA [--models iris wine] [--effort 0]``: DATA is a folder with
``bthowen/NAME.pickle.lzma``, ``uci/NAME.csv`` and ``mnist/mnist.npz``. Each model is compiled in a process of
its own, whose user time and peak of memory are those of the process and of all tools that it starts.

Where training on the rows gives the filters, the model has its thresholds: its encoder is counted, and its
accuracy is that of the circuit's words on the rows that BTHOWeN keeps to test on. The others read thermometer
bits. Published figures are Vivado's on an xc7z020, of time-shared hashes and without encoders.
"""

import argparse
import json
import resource
import subprocess
import sys
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.published import cpu_seconds
from wnn2hdl.build.compile import compile_model
from wnn2hdl.build.planning import CompileOptions, with_input
from wnn2hdl.dataset.tables import FeatureTable, read_table
from wnn2hdl.errors import InputError
from wnn2hdl.evaluation.rows import row_confusion
from wnn2hdl.importers import ImportOptions, Source
from wnn2hdl.importers.bthowen import read
from wnn2hdl.ir.models import BloomWisardModel
from wnn2hdl.markdown import head, row
from wnn2hdl.training.bthowen import with_thresholds

SHUTTLE_TRAINING = 43_500
"""Rows of ``shuttle.trn``, which come first."""


@dataclass(frozen=True)
class Published:
    """What was published of a model.

    Attributes:
        accuracy: percent.
        luts: without the encoder.
        words: of features that are not whole numbers; None where they are, or where no thresholds are found.
    """

    accuracy: float
    luts: int
    words: str | None = None


MODELS = {
    "iris": Published(98.0, 57, "UQ3.5"),
    "wine": Published(98.3, 585, "UQ11.5"),
    "ecoli": Published(87.5, 353, "UQ1.7"),
    "vowel": Published(90.0, 1559),
    "vehicle": Published(76.2, 1781),
    "satimage": Published(88.0, 3771),
    "shuttle": Published(99.9, 593),
    "letter": Published(90.0, 21603),
    "mnist_small": Published(93.4, 15756),
    "mnist_medium": Published(94.3, 38912),
}


def rows_of(data: Path, name: str) -> tuple[FeatureTable, FeatureTable]:
    """The rows to find thresholds from, and those that BTHOWeN keeps to test on."""
    if name.startswith("mnist"):
        path = data / "mnist" / "mnist.npz"
        return read_table(path, None, "train"), read_table(path, None, "test")
    if name == "satimage":
        training, test = (
            read_table(data / "uci" / f"satimage_{part}.csv", "label") for part in ("train", "test")
        )
        return training, test
    table = read_table(data / "uci" / f"{name}.csv", "label")
    if name == "shuttle":
        return _part(table, np.arange(SHUTTLE_TRAINING)), _part(
            table, np.arange(SHUTTLE_TRAINING, len(table.labels))
        )
    kept = np.random.RandomState(123).permutation(len(table.labels))[: len(table.labels) // 3]
    return table, _part(table, kept)


def _part(table: FeatureTable, chosen: np.ndarray[Any, Any]) -> FeatureTable:
    return replace(table, features=table.features[chosen], labels=tuple(table.labels[i] for i in chosen))


def measure(data: Path, name: str, effort: int) -> dict[str, Any]:
    """What a model takes, in a process that does nothing else."""
    model: Any = read(Source(data / "bthowen" / f"{name}.pickle.lzma"), ImportOptions())
    assert isinstance(model, BloomWisardModel)
    found: dict[str, Any] = {"reads": "bits", "accuracy": None}
    training, test = rows_of(data, name)
    try:
        model = with_thresholds(model, training)
    except InputError:
        pass
    else:
        words = MODELS[name].words
        model = model if words is None else with_input(model, words)
        confusion = row_confusion(model, test, None)
        found["reads"] = str(model.encoder.input)
        found["accuracy"] = 100 * float(confusion.trace() / confusion.sum())
    with tempfile.TemporaryDirectory() as folder:
        try:
            build = compile_model(model, Path(folder) / name, CompileOptions(effort=effort), lambda *_: None)
        except InputError as error:
            return found | {"refused": error.line()}
    parts = build.report["parts"]
    who = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    return found | {
        "luts": parts["network"]["luts"],
        "encoder": parts["encoder"]["luts"],
        "proof": build.report["proof"]["status"],
        "cpu": cpu_seconds(),
        "memory": max(resource.getrusage(each).ru_maxrss for each in who) / 1024,
    }


def main() -> None:
    """Print a line for each model."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("data", type=Path)
    parser.add_argument("--models", nargs="+", choices=MODELS, default=list(MODELS))
    parser.add_argument("--effort", type=int, default=0)
    parser.add_argument("--alone", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.alone:
        print(json.dumps(measure(given.data, given.models[0], given.effort)))
        return
    columns = ["model", "reads", "accuracy %", "published", "LUTs", "of these encoder", "published"]
    print(head([*columns, "proof", "CPU s", "MB"]), flush=True)
    for name in given.models:
        command = [sys.executable, __file__, str(given.data), "--models", name]
        command += ["--effort", str(given.effort), "--alone"]
        found = json.loads(subprocess.run(command, capture_output=True, check=True, text=True).stdout)
        accuracy = "" if found["accuracy"] is None else f"{found['accuracy']:.1f}"
        line = [name, found["reads"], accuracy, MODELS[name].accuracy]
        if "refused" in found:
            line += [found["refused"], "", MODELS[name].luts, "", "", ""]
        else:
            line += [found["luts"], found["encoder"], MODELS[name].luts, found["proof"]]
            line += [round(found["cpu"]), round(found["memory"])]
        print(row(line), flush=True)


if __name__ == "__main__":
    main()
