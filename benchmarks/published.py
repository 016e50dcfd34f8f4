"""Networks of look-up tables against published ones: accuracy, LUTs and proof.

``python benchmarks/published.py DATA [--rows mnist-650 letter] [--seeds 5] [--prove]``: DATA is a folder with
``mnist/mnist.npz`` and ``uci/NAME.csv``. Each row trains with every seed, counts the whole network
(encoder, tables, votes and winner) and judges it on test rows that nothing else reads. Two of MNIST's rows
take some CPU minutes each. With ``--prove`` the network of the first seed is compiled, too, which proves
it.

Splits: MNIST and satimage have their own test rows; letter's are the last 4,000; of the others a third of
each class is drawn with the row's seed. Features that are not whole numbers become bytes over the range of
the training rows: that scaling is not part of the circuit. BTHOWeN's LUTs are Vivado's, without its
encoder.
"""

import argparse
import resource
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.build.compile import compile_model
from wnn2hdl.build.planning import CompileOptions
from wnn2hdl.dataset.tables import FeatureTable, read_table
from wnn2hdl.encode.thermometer import whole_words
from wnn2hdl.errors import InputError
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.markdown import head, row
from wnn2hdl.training.gradient import (
    Architecture,
    Trained,
    train_network,
    usual_made_up,
    usual_recipe,
)
from wnn2hdl.training.gradient.samples import split

TEST_SHARE = 1 / 3
LETTER_TRAINING = 16_000
BYTE = FixedPoint(8, 0, signed=False)


@dataclass(frozen=True)
class Row:
    """A published network and what ours is allowed.

    Attributes:
        data: name of the data set.
        accuracy: to be reached, percent.
        luts: that the whole network may take.
        published: whose, and what theirs takes.
        levels: thresholds for each feature.
        epochs: passes over the training rows; None for `enough_epochs`.
        distortions: of each picture.
    """

    data: str
    accuracy: float
    luts: int
    published: str
    levels: int = 8
    epochs: int | None = None
    distortions: int = 0


ROWS = {
    "mnist-1400": Row("mnist", 98.0, 1400, "DWN: 97.9, 3,118 LUTs", 1, 260, 6),
    "mnist-650": Row("mnist", 97.0, 650, "DWN: 97.1, 692 LUTs without encoder", 1, 260, 6),
    "mnist-250": Row("mnist", 94.3, 250, "BTHOWeN: 94.3, 38,912 LUTs", 1, 260, 6),
    "letter": Row("letter", 90.0, 2160, "BTHOWeN: 90.0, 21,603 LUTs", 15, 150),
    "satimage": Row("satimage", 88.0, 377, "BTHOWeN: 88.0, 3,771 LUTs", 4),
    "shuttle": Row("shuttle", 99.9, 59, "BTHOWeN: 99.9, 593 LUTs"),
    "vowel": Row("vowel", 90.0, 155, "BTHOWeN: 90.0, 1,559 LUTs"),
    "vehicle": Row("vehicle", 76.2, 178, "BTHOWeN: 76.2, 1,781 LUTs"),
    "wine": Row("wine", 98.3, 58, "BTHOWeN: 98.3, 585 LUTs", 4),
    "ecoli": Row("ecoli", 87.5, 176, "BTHOWeN: 87.5, 353 LUTs"),
    "iris": Row("iris", 98.0, 28, "BTHOWeN: 98.0, 57 LUTs", 15),
}


@dataclass(frozen=True, eq=False)
class Case:
    """Rows to train on, and rows to judge by.

    Attributes:
        features: float64 ``[samples, features]``.
        labels: class index of each.
        test_features: as `features`.
        test_labels: as `labels`.
        classes: class names.
        words: format of the features.
        grid: rows and columns of pictures.
    """

    features: NDArray[np.float64]
    labels: NDArray[np.int64]
    test_features: NDArray[np.float64]
    test_labels: NDArray[np.int64]
    classes: tuple[str, ...]
    words: FixedPoint
    grid: tuple[int, int] | None


def load(data: Path, name: str, seed: int) -> Case:
    """The case of a data set; its own split is used where it has one."""
    if name == "mnist":
        training, test = (read_table(data / "mnist" / "mnist.npz", None, part) for part in ("train", "test"))
    elif name == "satimage":
        training, test = (
            read_table(data / "uci" / f"satimage_{part}.csv", "label") for part in ("train", "test")
        )
    else:
        rows = read_table(data / "uci" / f"{name}.csv", "label")
        if name == "letter":
            training, test = (
                _part(rows, np.arange(LETTER_TRAINING)),
                _part(rows, np.arange(LETTER_TRAINING, 20_000)),
            )
        else:
            _, numbers = np.unique(rows.labels, return_inverse=True)
            training, test = (_part(rows, chosen) for chosen in split(numbers, TEST_SHARE, seed))
    classes = tuple(sorted(set(training.labels)))
    features, test_features = training.features, test.features
    words = whole_words(features)
    if words is None:
        low, high = features.min(axis=0), features.max(axis=0)
        scale = BYTE.highest / np.where(high > low, high - low, 1)
        features, test_features, words = (features - low) * scale, (test_features - low) * scale, BYTE
    index = {label: number for number, label in enumerate(classes)}
    labels, test_labels = (np.array([index[label] for label in table.labels]) for table in (training, test))
    return Case(features, labels, test_features, test_labels, classes, words, training.grid)


def _part(rows: FeatureTable, chosen: NDArray[np.int64]) -> FeatureTable:
    return FeatureTable(rows.columns, rows.features[chosen], tuple(rows.labels[i] for i in chosen))


def train(case: Case, published: Row, seed: int) -> Trained:
    """A network within the row's LUTs."""
    made_up = usual_made_up(len(case.labels), pictures=case.grid is not None)
    architecture = Architecture(
        case.words,
        max_luts=published.luts,
        levels=published.levels,
        grid=case.grid,
        distortions=published.distortions,
        made_up=made_up,
    )
    recipe = usual_recipe(len(case.labels) + made_up, epochs=published.epochs, seed=seed)
    return train_network(case.features, case.labels, case.classes, architecture, recipe, lambda *_: None)


def accuracy(case: Case, trained: Trained) -> float:
    """Percent of the test rows that are right."""
    answers = trained.model.evaluate(trained.model.encoder.bits(case.test_features))
    return 100 * float((answers == case.test_labels).mean())


def proof(trained: Trained) -> str:
    """How the compiled network was checked."""
    with tempfile.TemporaryDirectory() as folder:
        options = CompileOptions(target="network")
        build = compile_model(trained.model, Path(folder) / "network", options, lambda *_: None)
    return str(build.report["proof"]["status"])


def cpu_seconds() -> float:
    """User time of this process and its finished children so far."""
    return sum(resource.getrusage(who).ru_utime for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))


def main() -> None:
    """Print a line for each row."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("data", type=Path)
    parser.add_argument("--rows", nargs="+", choices=ROWS, default=list(ROWS))
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--prove", action="store_true")
    given = parser.parse_args()
    columns = ["row", "accuracy %, mean (worst)", "wanted", "LUTs, most", "allowed", "", "published"]
    print(head([*columns, "CPU s per seed", "proof"]))
    for name in given.rows:
        wanted = ROWS[name]
        start, proved = cpu_seconds(), "not asked"
        accuracies: list[float] = []
        luts: list[int] = []
        try:
            for seed in range(given.seeds):
                case = load(given.data, wanted.data, seed)
                trained = train(case, wanted, seed)
                accuracies.append(accuracy(case, trained))
                luts.append(trained.luts or 0)
                if given.prove and seed == 0:
                    proved = proof(trained)
        except InputError as error:
            print(
                row([name, error.line(), wanted.accuracy, "", wanted.luts, "lost", wanted.published, "", ""])
            )
            continue
        mean = float(np.mean(accuracies))
        print(
            row(
                [
                    name,
                    f"{mean:.2f} ({min(accuracies):.2f})",
                    wanted.accuracy,
                    max(luts),
                    wanted.luts,
                    "won" if mean >= wanted.accuracy else "lost",
                    wanted.published,
                    round((cpu_seconds() - start) / given.seeds),
                    proved,
                ]
            ),
            flush=True,
        )


if __name__ == "__main__":
    main()
