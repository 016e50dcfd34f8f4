"""Which specification belongs to a model: the one place where verification looks at the kind of a model."""

from collections.abc import Mapping

from wnn2hdl.errors import InputError
from wnn2hdl.ir import Context, EdgeFilter, FeatureEncoder, Neighbourhood, WisardModel, Words
from wnn2hdl.ir.care import CareSet
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.models import AnyModel, LogicModel, NetworkModel, TableSumModel
from wnn2hdl.verify.block import block_specification
from wnn2hdl.verify.context import context_specification
from wnn2hdl.verify.gates import gates_specification
from wnn2hdl.verify.lane import ENGINE, lane_specification
from wnn2hdl.verify.neighbourhood import neighbourhood_specification
from wnn2hdl.verify.network import network_specification
from wnn2hdl.verify.specification import Specification
from wnn2hdl.verify.sums import sums_specification


def specify(
    model: AnyModel,
    edges: EdgeFilter | None,
    care: Mapping[str, CareSet],
    circuit: Circuit | None = None,
) -> Specification:
    """What the circuits made from a model have to compute.

    Args:
        model: the model.
        edges: the edge filter of the design, if it has one.
        care: the care sets of circuits by name; where one is missing, everything matters.
        circuit: says which of its bits are which of the model's, so that it can be proved piece by piece;
            without it a network is compared as a whole.

    Raises:
        InputError: the model reads no pixels, or a care set is empty.
        ValueError: the circuit is not made of the pieces of the model's.
    """
    if circuit is not None and circuit.name == ENGINE:
        return lane_specification(circuit.inputs[0].width // 2)
    if isinstance(model, NetworkModel) and isinstance(model.encoder, FeatureEncoder):
        return network_specification(model, circuit)
    if isinstance(model, LogicModel):
        return gates_specification(model)
    if isinstance(model, TableSumModel) and isinstance(model.encoder, Words):
        return sums_specification(model)
    if not isinstance(model, WisardModel):
        raise InputError("models of this kind are not proved yet", value=model.kind)
    if isinstance(model.encoder, Neighbourhood):
        return neighbourhood_specification(model, edges, model.encoder, care)
    if isinstance(model.encoder, Context):
        return context_specification(model, edges, model.encoder, care)
    return block_specification(model, edges, care)


def care_sets(circuit: Circuit) -> dict[str, CareSet]:
    """The care set of each definition of a circuit that has one, by name."""
    return {
        name: definition.care[0].allowed
        for name, definition in circuit.definitions().items()
        if definition.care
    }
