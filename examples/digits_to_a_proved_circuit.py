"""Handwritten digits to a proved circuit, with pictures of what its tables look at.

Run it as ``python examples/digits_to_a_proved_circuit.py [FOLDER [MNIST.npz LUTS]]``. With MNIST's file,
which holds ``x_train``, ``y_train``, ``x_test`` and ``y_test``, it takes some minutes; without, it reads
the small digits that come with scikit-learn. The build and the picture go to FOLDER.
"""

import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from sklearn.datasets import load_digits

from wnn2hdl.api import compile, evaluate_table  # noqa: A004
from wnn2hdl.dataset.tables import FeatureTable, read_table
from wnn2hdl.images import write_png
from wnn2hdl.ir import Thermometer
from wnn2hdl.ir.models import LutGroupModel
from wnn2hdl.training.gradient import train_rows


def main(folder: Path, file: Path | None, max_luts: int) -> None:
    """Train within a number of LUTs, compile, measure, and draw."""
    if file is None:
        file = folder / "digits.npz"
        small_digits(file)
    rows, others = read_table(file, None, "train"), read_table(file, None, "test")

    # One threshold a pixel, its most significant bit, costs nothing; moved and turned copies teach more.
    trained = train_rows(
        rows, max_luts=max_luts, levels=1, words=None, distort=6, seed=0, progress=lambda *_: None
    )
    assert trained.validation is not None
    print(f"{trained.nodes} tables for each digit, {trained.validation:.1%} right in validation")

    build = compile(trained.model, folder / "circuit")
    print(build)

    # The circuit itself is measured, on digits that had no part in the training.
    print(evaluate_table(build, others))
    write_png(folder / "looked_at.png", picture(trained.model, rows))


def small_digits(path: Path) -> None:
    """Write 1,797 digits of 8x8 pixels as MNIST's are written, every third one to judge by."""
    digits = load_digits()
    pixels = np.minimum(digits.images * 16, 255).astype(np.uint8)
    test = np.arange(len(pixels)) % 3 == 0
    path.parent.mkdir(parents=True, exist_ok=True)
    np.savez(
        path,
        x_train=pixels[~test],
        y_train=digits.target[~test],
        x_test=pixels[test],
        y_test=digits.target[test],
    )


def looked_at(model: LutGroupModel) -> NDArray[np.int64]:
    """How many tables of each class read each pixel: int64 ``[classes, pixels]``."""
    assert isinstance(model.encoder, Thermometer)
    bits = [len(thresholds) for thresholds in model.encoder.thresholds]
    reads = np.repeat(np.eye(len(bits), dtype=np.bool_), bits, axis=0)
    for layer in model.layers:
        reads = np.asarray(reads[layer.mapping].any(axis=1))
    return np.stack([reads[model.groups == owner].sum(axis=0) for owner in range(len(model.classes))])


def picture(model: LutGroupModel, rows: FeatureTable) -> NDArray[np.uint8]:
    """For each class its mean picture, and in green how many of its tables read each pixel."""
    assert rows.grid is not None
    labels = np.array(rows.labels)
    counts = looked_at(model)
    tiles = []
    for name, count in zip(model.classes, counts, strict=True):
        mean = rows.features[labels == name].mean(axis=0)
        green = 255 * count / counts.max()
        tile = np.stack([mean / 2, np.maximum(mean / 2, green), mean / 2], axis=1).reshape(*rows.grid, 3)
        tiles.append(np.pad(tile, ((1, 1), (1, 1), (0, 0)), constant_values=255))
    scale = max(1, 112 // rows.grid[0])
    half = -(-len(tiles) // 2)
    tiles += [np.full_like(tiles[0], 255)] * (2 * half - len(tiles))
    sheet = np.concatenate([np.concatenate(line, axis=1) for line in (tiles[:half], tiles[half:])])
    return sheet.repeat(scale, axis=0).repeat(scale, axis=1).astype(np.uint8)


if __name__ == "__main__":
    words = sys.argv[1:]
    given = (Path(words[1]), int(words[2])) if len(words) > 2 else (None, 250)
    main(Path(words[0]) if words else Path("build/example"), *given)
