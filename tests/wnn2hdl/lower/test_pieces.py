"""A network is divided at the ports of its tables, sums and winner, and says which table went where."""

from dataclasses import replace

import numpy as np
import pytest

from tests.small_networks import lut_network
from wnn2hdl.ir import codes_to_bits
from wnn2hdl.ir.circuit import Instance
from wnn2hdl.ir.models import LutGroupModel
from wnn2hdl.ir.wires import Slice
from wnn2hdl.lower.structural import network


def with_constant_class(model: LutGroupModel) -> LutGroupModel:
    """The model, all of whose tables that vote for the first class always or never fire."""
    tables = model.layers[0].tables.copy()
    tables[model.groups == 0] = (np.arange(int((model.groups == 0).sum())) % 2 == 0)[:, np.newaxis]
    return replace(model, layers=(replace(model.layers[0], tables=tables),))


def test_the_pieces_stand_innermost_first() -> None:
    names = list(network(lut_network(2)).definitions())
    assert names == ["encoder", "tables", "sum_0", "winner", "core", "network"]


def test_sums_of_equal_weights_are_one_circuit() -> None:
    core = network(with_constant_class(lut_network(2))).definitions()["core"]
    sums = [node.circuit.name for node in core.nodes if isinstance(node, Instance)][1:-1]
    assert sums == ["sum_0", "sum_1", "sum_1"]


@pytest.mark.parametrize("model", [lut_network(2), lut_network(8), with_constant_class(lut_network(2))])
def test_every_table_is_carried_by_a_bit_or_is_constant(model: LutGroupModel) -> None:
    circuit = network(model)
    parts = circuit.definitions()
    assert parts["tables"].carries.keys() == set(range(len(model.groups)))
    words = np.random.default_rng(0).integers(-32, 32, (500, 3))
    features = codes_to_bits(words & 63, 6).reshape(len(words), -1)
    made = parts["encoder"].evaluate({"features": features})["bits"]
    bits = model.encoder.bits_of_words(words)  # type: ignore[union-attr]
    for position, place in parts["encoder"].carries.items():
        assert isinstance(place, Slice)
        assert np.array_equal(made[:, place.low], bits[:, position])
    votes = parts["tables"].evaluate({"bits": made})["votes"]
    layer = model.layers[0]
    addresses = bits[:, layer.mapping] @ (1 << np.arange(3))
    for number, found in parts["tables"].carries.items():
        vote = np.full(len(words), found) if isinstance(found, bool) else votes[:, found.low]
        assert np.array_equal(vote, layer.tables[number, addresses[:, number]])


def test_a_class_whose_tables_are_constant_keeps_a_bit() -> None:
    model = with_constant_class(lut_network(2))
    tables = network(model).definitions()["tables"]
    voters = np.flatnonzero(model.groups == 0).tolist()
    assert [isinstance(tables.carries[voter], bool) for voter in voters] == [True] * (len(voters) - 1) + [
        False
    ]
