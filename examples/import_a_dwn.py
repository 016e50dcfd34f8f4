"""A network of look-up tables that was trained elsewhere (a DWN) as Verilog that is proved equal to it.

Run it as ``python examples/import_a_dwn.py CHECKPOINT.pt VECTORS.npz [FOLDER]``. VECTORS has features as the
network reads them, ``x_raw [samples, features]``, and the answers that it gave, ``pred [samples]``.
"""

import sys
from pathlib import Path

import numpy as np

from wnn2hdl.api import CompileOptions, compile, evaluate_table, import_model  # noqa: A004


def main(checkpoint: Path, vectors: Path, folder: Path) -> None:
    """Import, compare with the recorded answers, compile, and compare the circuit."""
    model = import_model(checkpoint)
    print(model)

    recorded = np.load(vectors)
    classes = np.array(model.classes)
    features, answers = recorded["x_raw"], classes[recorded["pred"]]
    # Whether features still have to be scaled has to be said where a checkpoint records a scaler.
    same = evaluate_table(model, features, answers, raw=False)
    print(f"{same.accuracy:.1%} of the recorded answers are the model's")

    # Hardware reads fixed-point words: a sign bit, 3 bits before the binary point and 12 after.
    build = compile(model, folder / "network", CompileOptions(input="Q3.12"))
    print(build)
    circuit = evaluate_table(build, features, answers, raw=False)
    print(f"{circuit.accuracy:.1%} of them are the circuit's, which reads words")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]), Path(sys.argv[3] if len(sys.argv) > 3 else "build/example"))
