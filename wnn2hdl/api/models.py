"""Models: trained here, imported, or read from a file."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wnn2hdl.api.progress import watched
from wnn2hdl.api.showing import Shown
from wnn2hdl.dataset import (
    CLASSES,
    SAMPLE_IMAGES,
    SAMPLE_SIDE,
    Dataset,
    LabelledImage,
    from_masks,
    from_samples,
)
from wnn2hdl.dataset.tables import FeatureTable
from wnn2hdl.encode import high_bits, parse_bits
from wnn2hdl.errors import InputError
from wnn2hdl.images import UNLABELLED, Picture
from wnn2hdl.importers import ImportOptions
from wnn2hdl.importers import import_model as read_foreign_model
from wnn2hdl.ir import WisardModel
from wnn2hdl.ir.models import AnyModel, LogicModel, load_model
from wnn2hdl.progress import Progress
from wnn2hdl.training.budget import ADDRESS_BITS, RAMS, train_under_budget
from wnn2hdl.training.context import train_context
from wnn2hdl.training.discriminators import train as train_discriminators
from wnn2hdl.training.discriminators import with_colours
from wnn2hdl.training.gradient import train_rows
from wnn2hdl.training.neighbourhood import train_neighbourhood
from wnn2hdl.training.tables import TableOptions
from wnn2hdl.training.tables import train_table as train_wisard

Pictures = Path | str | Sequence[NDArray[np.uint8]]
"""A folder of pictures, or arrays uint8 ``[height, width, 3]``."""

Masks = Path | str | Sequence[NDArray[Any]]
"""A folder of masks, or arrays of class indices ``[height, width]``."""


@dataclass(frozen=True, eq=False, repr=False)
class Model(Shown):
    """A trained network.

    Attributes:
        model: the network, one of `wnn2hdl.ir.models.AnyModel`.
    """

    model: AnyModel

    @property
    def classes(self) -> tuple[str, ...]:
        """Class names; none of a network of gates."""
        return () if isinstance(self.model, LogicModel) else self.model.classes

    @property
    def title(self) -> str:
        """See `Shown.title`."""
        return f"Model of kind {self.model.kind}"

    @property
    def facts(self) -> Mapping[str, str]:
        """See `Shown.facts`."""
        model = self.model
        width = model.width if isinstance(model, LogicModel) else model.encoder.width
        found = {"input bits": str(width)}
        if self.classes:
            found["classes"] = ", ".join(self.classes[:10]) + (" …" if len(self.classes) > 10 else "")
        if isinstance(model, WisardModel):
            found["RAMs"] = f"{model.rams} of {model.address_bits} address bits for each class"
            found["bleaching threshold"] = str(model.bleaching)
            found["reads"] = ", ".join(model.encoder.names[:16])
        return found

    def save(self, path: Path | str) -> None:
        """Write the model file; raises InputError if it cannot be written."""
        self.model.save(Path(path))


def load(path: Path | str) -> Model:
    """Read a model file; raises ModelFileError if it is missing, damaged or no model."""
    return Model(load_model(Path(path)))


def import_model(
    path: Path | str,
    options: ImportOptions = ImportOptions(),  # noqa: B008  # frozen
    format_name: str | None = None,
) -> Model:
    """Read another tool's trained model.

    Args:
        path: the file.
        options: what the file may leave open.
        format_name: its format; recognised by its content if left out.

    Raises:
        InputError: it is of no known format, damaged, or leaves something open that no option says.
    """
    _, model = read_foreign_model(Path(path), options, format_name)
    assert isinstance(model, AnyModel)
    return Model(model)


def train(
    images: Pictures | Dataset | None = None,
    masks: Masks | None = None,
    *,
    luts_per_pixel: int | None = None,
    nested: bool = False,
    neighbourhood: int | None = None,
    context: int | None = None,
    bits: str | None = None,
    address_bits: int = ADDRESS_BITS,
    rams: int = RAMS,
    bleaching: int | None = None,
    balanced: bool = False,
    trials: int = 20,
    seed: int = 0,
    progress: Progress | None = None,
) -> Model:
    """Train a classifier of pixels.

    Args:
        images: a folder of pictures, arrays uint8 ``[height, width, 3]``, or a data set with its labels; the
            generated landscapes if left out.
        masks: a folder of masks of the same stems; or for each picture an array ``[height, width]`` of class
            indices, 0 forest and 1 deforested, 255 not labelled.
        luts_per_pixel: train the most accurate classifier within so many LUTs, not discriminators.
        nested: state the accuracy of the whole choice within that budget, made once more inside each fold.
        neighbourhood: train a classifier that looks at the 3x3 or 5x5 pixels around; 3 or 5.
        context: train a classifier that counts bits in the square around; 3, 7, 15 or 31.
        bits: of a colour that discriminators read, as in ``"R7,R6,G7"``; by default four high bits of each
            channel.
        address_bits: n, of each RAM of a discriminator.
        rams: k, of each discriminator.
        bleaching: the threshold of discriminators; None finds it by cross-validation by image.
        balanced: give all classes of discriminators the same weight.
        trials: random mappings that are tried within a budget of LUTs.
        seed: of all that is random.
        progress: called with how far it is; by default a line is shown where somebody watches.

    Raises:
        InputError: the images or masks cannot be used, two ways to choose a classifier are asked for, or
            nothing fits the budget.
    """
    if context is not None and (luts_per_pixel is not None or neighbourhood is not None):
        raise InputError(
            "context= chooses the classifier itself", hint="leave luts_per_pixel= and neighbourhood= out"
        )
    if nested and (luts_per_pixel is None or neighbourhood is not None):
        raise InputError("only a choice within luts_per_pixel= is nested", hint="leave nested= out")
    dataset = labelled(images, masks, seed)
    with watched(progress) as report:
        if neighbourhood is not None:
            model = train_neighbourhood(
                dataset, neighbourhood, luts_per_pixel=luts_per_pixel, seed=seed, progress=report
            )
        elif context is not None:
            model = train_context(dataset, context, seed=seed, progress=report)
        elif luts_per_pixel is not None:
            model = train_under_budget(
                dataset, luts_per_pixel, trials=trials, seed=seed, progress=report, nested=nested
            )
        else:
            model = train_discriminators(
                dataset,
                parse_bits(bits) if bits else high_bits(),
                address_bits=address_bits,
                rams=rams,
                bleaching=bleaching,
                balanced=balanced,
                seed=seed,
                progress=report,
            )
        return Model(with_colours(model, dataset, report))


def train_table(
    features: ArrayLike,
    labels: Sequence[str] | NDArray[np.generic],
    *,
    options: TableOptions = TableOptions(),  # noqa: B008  # frozen
    max_luts: int | None = None,
    epochs: int | None = None,
    seed: int = 0,
    progress: Progress | None = None,
) -> Model:
    """Train a network on feature vectors: a WiSARD, or look-up tables within a number of LUTs.

    Args:
        features: finite numbers ``[samples, features]``.
        labels: the class of each.
        options: how a WiSARD is built; of these, `levels` and `words` hold for look-up tables, too.
        max_luts: train a network of 6-input look-up tables whose whole circuit takes at most so many LUTs.
        epochs: passes of that training over the rows; by default as many as are usually enough.
        seed: of all that is random.
        progress: called with each epoch; by default a line is shown where somebody watches.

    Raises:
        InputError: the rows cannot be used, the format of their words is not known, or nothing fits.
        ToolError: Yosys is missing or failed; it counts the LUTs of a budget.
    """
    rows = feature_table(features, labels)
    if max_luts is None:
        return Model(train_wisard(rows, options, seed))
    with watched(progress) as report:
        trained = train_rows(
            rows,
            max_luts=max_luts,
            levels=options.levels,
            words=options.words,
            epochs=epochs,
            seed=seed,
            progress=report,
        )
    return Model(trained.model)


def labelled(images: Pictures | Dataset | None, masks: Masks | None, seed: int = 0) -> Dataset:
    """Labelled images of folders or arrays; the generated landscapes of a seed if nothing is given.

    Raises:
        InputError: one of the two is missing, one is a folder and the other arrays, or shapes or types do not
            fit.
    """
    if isinstance(images, Dataset):
        return images
    if images is None and masks is None:
        return from_samples(SAMPLE_IMAGES, SAMPLE_SIDE, seed=seed)
    if images is None or masks is None:
        raise InputError("pictures go together with masks", hint="give both")
    if isinstance(images, str | Path) and isinstance(masks, str | Path):
        return from_masks(Path(images), Path(masks))
    if isinstance(images, str | Path) or isinstance(masks, str | Path):
        raise InputError("one is a folder and the other is not", hint="give two folders, or arrays")
    if len(images) != len(masks):
        raise InputError("each picture has a mask", value=f"{len(images)} pictures, {len(masks)} masks")
    pairs = {f"picture-{i:05d}": pair for i, pair in enumerate(zip(images, masks, strict=True))}

    def read(name: str) -> LabelledImage:
        picture, mask = (np.asarray(array) for array in pairs[name])
        if picture.ndim != 3 or picture.shape[2] != 3 or picture.dtype != np.uint8:
            raise InputError(
                "a picture is uint8 [height, width, 3]", value=f"{picture.dtype} {picture.shape}"
            )
        if mask.shape != picture.shape[:2]:
            raise InputError("a mask has its picture's shape", value=f"{mask.shape} / {picture.shape[:2]}")
        classes = mask.astype(np.uint8)
        known = (classes == mask) & ((mask < len(CLASSES)) | (mask == UNLABELLED))
        if not known.all():
            raise InputError(
                "a mask holds class indices",
                value=mask[~known][0],
                hint="0 forest, 1 deforested, 255 neither",
            )
        return LabelledImage.of(name, Picture(picture, np.ones(mask.shape, dtype=np.bool_)), classes)

    return Dataset(CLASSES, tuple(pairs), read)


def feature_table(
    features: ArrayLike | FeatureTable, labels: Sequence[str] | NDArray[np.generic] | None
) -> FeatureTable:
    """Rows of arrays, or the table that is given.

    Raises:
        InputError: they are no finite numbers ``[samples, features]`` with a label each.
    """
    if isinstance(features, FeatureTable):
        return features
    try:
        numbers = np.asarray(features, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError("features are numbers [samples, features]", value=str(error)) from error
    if labels is None or numbers.ndim != 2 or not numbers.size or len(labels) != len(numbers):
        raise InputError(
            "features are numbers [samples, features], with a label each",
            value=f"{numbers.shape}, {'no' if labels is None else len(labels)} labels",
        )
    if not np.isfinite(numbers).all():
        raise InputError("a feature is not a finite number", hint="leave its row out")
    if any(label is None or label != label for label in labels):  # NaN alone differs from itself
        raise InputError("a label is missing", hint="leave its row out")
    columns = tuple(f"feature {number}" for number in range(numbers.shape[1]))
    return FeatureTable(columns, numbers, tuple(map(str, labels)))
