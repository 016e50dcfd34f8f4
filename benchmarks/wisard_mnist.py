"""Training and answering on MNIST, ours against wisardpkg: ``python benchmarks/wisard_mnist.py mnist.npz``.

Both read the same bits, pixel >= 128, with RAMs that read each of the 784 once. Times are CPU seconds of one
core, memory is the peak of a process that does nothing else. wisardpkg takes Python lists, whose making is
not timed; it finds a bleaching threshold again for each answer, which ours can do, too. It is left out where
it is not installed: ``pip install pybind11 setuptools wheel``, then ``pip install --no-build-isolation
wisardpkg``, in an environment of its own if need be, named in ``PYTHONPATH``.
"""

import importlib
import importlib.util
import json
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.ir import Words
from wnn2hdl.ir.models import Dynamic
from wnn2hdl.wisard import WisardClassifier, draw_mapping
from wnn2hdl.wisard.sparse import train_sparse

ADDRESS_BITS = (28, 14, 4)
CLASSES = tuple("0123456789")
PIXELS = 784

Bits = NDArray[np.bool_]
Labels = NDArray[np.int64]
Answerer = Callable[[Any], Any]


def sparse(bits: Bits, labels: Labels, n: int, bleaching: int | None) -> Answerer:
    """RAMs that store the addresses they have seen."""
    mapping = draw_mapping(PIXELS, PIXELS // n, n, 0)
    return train_sparse(bits, labels, Words(PIXELS), CLASSES, mapping, bleaching).evaluate


def dense(bits: Bits, labels: Labels, n: int, bleaching: int | None) -> Answerer:
    """RAMs that hold a count for every address."""
    mapping = draw_mapping(PIXELS, PIXELS // n, n, 0)
    return WisardClassifier(mapping=mapping, bleaching=bleaching or "auto").fit(bits, labels).predict


def rising(bits: Bits, labels: Labels, n: int) -> Answerer:
    """Sparse RAMs with a threshold that rises for each answer, as wisardpkg has it."""
    mapping = draw_mapping(PIXELS, PIXELS // n, n, 0)
    model = train_sparse(bits, labels, Words(PIXELS), CLASSES, mapping, 1)
    return replace(model, bleaching=Dynamic(), ties="last").evaluate


def rival(bits: list[list[int]], labels: list[str], n: int) -> Answerer:
    """The package's `Wisard` as it is."""
    network = importlib.import_module("wisardpkg").Wisard(n)
    network.train(bits, labels)
    return lambda rows: np.array(network.classify(rows)).astype(np.int64)


def ours(n: int) -> Callable[[Bits, Labels, int, int | None], Answerer]:
    """The kind of RAMs that `train --table` would take."""
    return sparse if n > 10 else dense


CONTENDERS: dict[str, Callable[[Any, Any, int], Answerer]] = {
    "wnn2hdl, threshold 1": lambda bits, labels, n: ours(n)(bits, labels, n, 1),
    "wnn2hdl, threshold searched": lambda bits, labels, n: ours(n)(bits, labels, n, None),
    "wnn2hdl, threshold rises": rising,
    "wisardpkg": rival,
}


def measure(name: str, n: int, path: str) -> dict[str, float]:
    """Seconds of training and of answering, accuracy, and the peak of memory in MB, of this process."""
    with np.load(path) as arrays:
        train, test = (arrays[f"x_{part}"].reshape(-1, PIXELS) >= 128 for part in ("train", "test"))
        labels, truth = (arrays[f"y_{part}"].astype(np.int64) for part in ("train", "test"))
    given: tuple[Any, Any, Any] = (train, labels, test)
    if name == "wisardpkg":
        given = (train.astype(int).tolist(), list(map(str, labels)), test.astype(int).tolist())
    start = time.process_time()
    answerer = CONTENDERS[name](given[0], given[1], n)
    trained = time.process_time()
    answers = answerer(given[2])
    done = time.process_time()
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return {
        "train": trained - start,
        "answer": done - trained,
        "accuracy": float((answers == truth).mean()),
        "memory": peak / 1024,
    }


def main(path: str) -> None:
    """Print a table, one process after the other."""
    print(f"{'n':>2}  {'':28}{'train s':>9}{'answer s':>9}{'accuracy':>10}{'peak MB':>9}")
    for n in ADDRESS_BITS:
        for name in CONTENDERS:
            if name == "wisardpkg" and importlib.util.find_spec("wisardpkg") is None:
                continue
            command = [sys.executable, __file__, path, name, str(n)]
            found = json.loads(subprocess.run(command, capture_output=True, check=True, text=True).stdout)
            print(
                f"{n:>2}  {name:28}{found['train']:9.2f}{found['answer']:9.2f}{found['accuracy']:10.4f}"
                f"{found['memory']:9.0f}",
                flush=True,
            )


if __name__ == "__main__":
    if len(sys.argv) == 4:
        print(json.dumps(measure(sys.argv[2], int(sys.argv[3]), sys.argv[1])))
    else:
        main(sys.argv[1])
