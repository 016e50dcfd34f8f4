"""From labelled features to a voting network of 6-input tables."""

import hashlib
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import wnn2hdl
from wnn2hdl.errors import InputError
from wnn2hdl.ir.fixed_point import FixedPoint
from wnn2hdl.ir.models import LutGroupModel
from wnn2hdl.progress import Progress
from wnn2hdl.training.gradient.budget import Budget
from wnn2hdl.training.gradient.checkpoint import Checkpoint
from wnn2hdl.training.gradient.cost import affordable_nodes
from wnn2hdl.training.gradient.inputs import InputBits, choose_inputs
from wnn2hdl.training.gradient.layer import VotingLayer
from wnn2hdl.training.gradient.loss import MAX_BATCH
from wnn2hdl.training.gradient.pictures import distorted
from wnn2hdl.training.gradient.samples import Samples, split
from wnn2hdl.training.gradient.teacher import Teacher, choose_teacher, made_up
from wnn2hdl.training.gradient.training import Recipe, Training

SAVE_BATCHES = 2000
"""After about so many batches a training is saved, at the end of an epoch."""


@dataclass(frozen=True)
class Architecture:
    """What is trained.

    Attributes:
        words: the format in which hardware reads the features.
        nodes: for each class, if there is no budget.
        max_luts: the budget of the whole network; None for none. As many nodes as fit are trained.
        levels: thresholds for each feature, of which the most significant bit of its words is one if that
            varies.
        grid: rows and columns of the picture whose pixels are the features, row by row; None if they are no
            picture. Nodes may then also read whether any of 2x2 pixels is bright.
        distortions: how often each picture is distorted for training; needs a grid.
        made_up: rows that are made up between the samples and labelled by a teacher, see
            `wnn2hdl.training.gradient.teacher`; 0 for no teacher.
        validation: share of the samples, or of the rows that are made up, that is kept for validation; 0 to
            train on all, to the end.
    """

    words: FixedPoint
    nodes: int = 8
    max_luts: int | None = None
    levels: int = 8
    grid: tuple[int, int] | None = None
    distortions: int = 0
    made_up: int = 0
    validation: float = 0.1


@dataclass(frozen=True, eq=False)
class Trained:
    """A network and what training showed.

    Attributes:
        model: the network.
        validation: its accuracy on the samples kept for validation, or how often it agrees with its teacher
            on made-up rows kept for that; None if there were none.
        teacher: which had been trained on all samples; None for none.
        epochs: that were trained.
        nodes: for each class.
        luts: of the whole network, as counted; None without a budget.
        steps: nodes for each class and accuracy in validation, when wiring and tables were learned, when
            nodes were dropped, and when the tables of the others were learned again; none without validation.
    """

    model: LutGroupModel
    validation: float | None
    epochs: int
    nodes: int
    luts: int | None
    steps: tuple[tuple[int, float], ...] = ()
    teacher: Teacher | None = None


def train_network(
    features: NDArray[np.float64],
    labels: NDArray[np.int64],
    classes: tuple[str, ...],
    architecture: Architecture,
    recipe: Recipe,
    progress: Progress,
    checkpoint: Path | None = None,
) -> Trained:
    """Train a network by gradient.

    The same samples, architecture and recipe give the same network, on any number of threads, and however
    often the training was killed and started again.

    Args:
        features: finite numbers ``[samples, features]``.
        labels: class index of each, ``[samples]``.
        classes: class names.
        architecture: what is trained.
        recipe: how.
        progress: called with each epoch.
        checkpoint: a file through which a killed training goes on; it is removed at the end. None for none.

    Raises:
        InputError: the features cannot be read as said, a class has no sample, or nothing fits the budget.
        ToolError: Yosys is missing or failed; it counts the LUTs of a budget.
    """
    identity = _identity(features, labels, architecture, recipe)
    most = architecture.max_luts
    nodes = architecture.nodes if most is None else affordable_nodes(most, len(classes))
    teacher = None
    if architecture.made_up:
        _require_all(labels, classes)
        # Hardware saturates, so the teacher learns where it can tell samples apart.
        words = architecture.words
        features = np.clip(features, *words.values([words.lowest, words.highest]))
        teacher = choose_teacher(features, labels, recipe.seed)
        rows = made_up(features, architecture.words, architecture.made_up, recipe.seed)
        features = np.concatenate([features, rows])
        labels = np.concatenate([labels, teacher.classifier.predict(rows)])
    chosen, kept = split(labels, architecture.validation, recipe.seed)
    _require_all(labels[chosen], classes)
    inputs = choose_inputs(features[chosen], architecture.words, architecture.levels, architecture.grid)
    samples = Samples(_copies(features[chosen], inputs, architecture, recipe), labels[chosen], recipe.seed)
    validation = inputs.rows(features[kept]), labels[kept]
    budget = None if most is None else Budget(most, inputs, classes)

    training = Training(recipe, samples, inputs.luts, len(classes), nodes)
    saved = None if checkpoint is None else Checkpoint(checkpoint, identity)
    if saved is not None and (arrays := saved.read()) is not None:
        training.restore(arrays)
    save_epochs = max(1, SAVE_BATCHES * MAX_BATCH // len(samples))

    progress("training", training.epoch, recipe.epochs)
    while not training.finished:
        if training.wiring and training.epoch >= recipe.wiring_epochs:
            training.note(validation)
            training.freeze(_fitted(training, budget))
            training.note(validation)
        training.run_epoch()
        if not training.wiring:
            training.validate(validation)
        if saved is not None and training.epoch % save_epochs == 0:
            saved.write(training.arrays())
        progress("training", training.epoch, recipe.epochs)
    training.take_best()
    training.note(validation)
    layer = _fitted(training, budget)
    right = float((layer.predict(validation[0]) == validation[1]).mean()) if len(kept) else None
    trained = Trained(
        inputs.model(layer, classes),
        right,
        training.epoch,
        layer.nodes_per_class,
        None if budget is None else budget.luts(layer),
        tuple(training.steps),
        teacher,
    )
    if saved is not None:
        saved.remove()
    return trained


def _require_all(labels: NDArray[np.int64], classes: tuple[str, ...]) -> None:
    missing = sorted(set(range(len(classes))) - set(labels.tolist()))
    if missing:
        raise InputError("a class has no sample to train on", value=classes[missing[0]], hint="add some")


def _fitted(training: Training, budget: Budget | None) -> VotingLayer:
    """The layer as it is, with its best nodes where there is a budget."""
    return training.layer if budget is None else budget.fitted(training.layer, training.effects())


def _copies(
    features: NDArray[np.float64], inputs: InputBits, architecture: Architecture, recipe: Recipe
) -> list[NDArray[np.uint8]]:
    copies = [inputs.rows(features)]
    for number in range(architecture.distortions):
        assert architecture.grid is not None
        seed = recipe.seed + number
        copies.append(inputs.rows(distorted(features, architecture.grid, seed)))
    return copies


def _identity(
    features: NDArray[np.float64], labels: NDArray[np.int64], architecture: Architecture, recipe: Recipe
) -> dict[str, Any]:
    """All that decides a training."""
    digest = hashlib.sha256(features.tobytes() + labels.tobytes()).hexdigest()
    shape = asdict(architecture) | {"words": str(architecture.words)}
    return {
        "samples": digest,
        "architecture": shape,
        "recipe": asdict(recipe),
        "version": wnn2hdl.__version__,
    }
