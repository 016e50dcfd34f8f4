"""Golden models of the whole family: what a trained network answers, before it is hardware."""

from pathlib import Path

from wnn2hdl.ir.model import WisardModel
from wnn2hdl.ir.modelfile import contradicting, read_model_file
from wnn2hdl.ir.models.base import ClassifierModel, FirstOrLast, Model
from wnn2hdl.ir.models.bloom import BloomWisardModel
from wnn2hdl.ir.models.logic import LogicModel
from wnn2hdl.ir.models.luts import LutGroupModel, LutLayer
from wnn2hdl.ir.models.sums import SumLayer, TableSumModel
from wnn2hdl.ir.models.wisard import Dynamic, SparseWisardModel

AnyModel = WisardModel | SparseWisardModel | BloomWisardModel | LutGroupModel | TableSumModel | LogicModel
"""Every model that a file can hold."""

VotingModel = WisardModel | SparseWisardModel | LutGroupModel
"""Models whose last tables vote for classes."""

NetworkModel = VotingModel | BloomWisardModel
"""Models that become a network: an encoder, what votes, a sum for each class, a winner."""

KINDS: dict[str, type[AnyModel]] = {
    model.kind: model
    for model in (
        WisardModel,
        SparseWisardModel,
        BloomWisardModel,
        LutGroupModel,
        TableSumModel,
        LogicModel,
    )
}
"""The class of each ``kind`` in a model file."""


def load_model(path: Path) -> AnyModel:
    """Read and check a model file of any kind.

    Raises:
        ModelFileError: the file is missing, damaged, of another version, or no model.
    """
    data = read_model_file(path)
    try:
        return KINDS[data["kind"]].from_json(data)
    except (ValueError, TypeError, IndexError, OverflowError) as error:
        raise contradicting(path, error) from error


__all__ = [
    "KINDS",
    "AnyModel",
    "BloomWisardModel",
    "ClassifierModel",
    "Dynamic",
    "FirstOrLast",
    "LogicModel",
    "LutGroupModel",
    "LutLayer",
    "Model",
    "NetworkModel",
    "SparseWisardModel",
    "SumLayer",
    "TableSumModel",
    "VotingModel",
    "load_model",
]
