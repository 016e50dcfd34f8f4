"""Networks of any number of inputs, lowered node by node: encoder, tables, votes, winner."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.ir import MAX_TABLE_INPUTS, Thermometer, ThermometerBits, TruthTable, WisardModel
from wnn2hdl.ir.care import CareSet, Everything, Implied
from wnn2hdl.ir.circuit import Care, Circuit, Instance
from wnn2hdl.ir.encoder import Encoder
from wnn2hdl.ir.models import (
    BloomWisardModel,
    LutGroupModel,
    NetworkModel,
    SparseWisardModel,
    VotingModel,
)
from wnn2hdl.ir.models.base import ZERO
from wnn2hdl.ir.nodes import ArgMax, Sum, Table
from wnn2hdl.ir.wires import Port, Slice
from wnn2hdl.lower.bloom import FORMS, filter_tables, hash_circuit, positions
from wnn2hdl.lower.encoder import encoder_circuit, features_port
from wnn2hdl.lower.pieces import divided
from wnn2hdl.minimise.sharing import share

CORE = "core"
NETWORK = "network"


@dataclass(frozen=True, eq=False)
class Layer:
    """Tables side by side.

    Attributes:
        mapping: for each table the indices of its inputs, int ``[tables, n]``, or `ZERO`; entry 0 is the
            least significant address bit.
        contents: bool ``[tables, 2**n]``, the answer at each address.
    """

    mapping: NDArray[np.integer]
    contents: NDArray[np.bool_]


def network(model: NetworkModel) -> Circuit:
    """The whole network: ``features`` to ``class_bits``, the index of the class in binary.

    Tables are shared and lose what does not matter first, so that the encoder makes only bits that are read.

    Raises:
        InputError: as `core`, or the encoder reads numbers of no stated format.
    """
    features = features_port(model.encoder)
    known = known_bits(model.encoder)
    forms: tuple[int, ...] = ()
    if isinstance(model, BloomWisardModel):
        filters = filter_tables(model, implied(model.encoder), known)
        forms, voters = filters.forms, list(filters.voters)
        whole = _voting(model, filters.care, filters.tables, voters, _owners(model))
        shared = share(whole, filters.care, {})
    else:
        layers, owners = _layers(model)
        voters = _voters(layers)
        shared = share(_core(model, layers, owners), implied(model.encoder), known)
    carried = {index: shared.found.get(voter, Slice(voter)) for index, voter in enumerate(voters)}
    read = tuple(forms[place] for place in shared.read) if forms else tuple(1 << bit for bit in shared.read)
    encoded = positions(read)
    nodes = [Instance("encode", encoder_circuit(model.encoder, encoded), {"features": features.word})]
    word = (Slice("encode.bits", 0, len(encoded)),)
    if any(mask.bit_count() > 1 for mask in read):
        nodes.append(Instance("hash", hash_circuit(encoded, read), {"bits": word}))
        word = (Slice(f"hash.{FORMS}", 0, len(read)),)
    nodes.append(Instance("decide", divided(shared.circuit, carried), {"bits": word}))
    ((net, width),) = nodes[-1].drives.items()
    return Circuit(
        NETWORK,
        f"Network of {len(model.classes)} classes.",
        (features,),
        tuple(nodes),
        {"class_bits": (Slice(net, 0, width),)},
    )


def core(model: VotingModel) -> Circuit:
    """The network behind the encoder: ``bits``, all of the encoder's, to ``class_bits``.

    Raises:
        InputError: a table has more inputs than can be enumerated, or the bleaching is found again for each
            sample.
    """
    return _core(model, *_layers(model))


def _core(model: VotingModel, layers: list[Layer], owners: NDArray[np.integer]) -> Circuit:
    nets = [Slice("bits", position) for position in range(model.encoder.width)]
    nodes: list[Table] = []
    for number, layer in enumerate(layers):
        tables = []
        for index, (mapping, contents) in enumerate(zip(layer.mapping, layer.contents, strict=True)):
            read, reduced = _distinct(mapping, contents)
            names = tuple(f"i{position}" for position in range(len(read)))
            function = TruthTable.exact(names, ("fires",), reduced[:, np.newaxis])
            tables.append(Table(_name(number, index), tuple(nets[position] for position in read), function))
        nodes += tables
        nets = [Slice(table.name) for table in tables]
    return _voting(model, implied(model.encoder), nodes, _voters(layers), owners)


def _voting(
    model: NetworkModel,
    care: CareSet,
    tables: Sequence[Table],
    voters: Sequence[str],
    owners: NDArray[np.integer],
) -> Circuit:
    """The circuit `CORE` of some tables over ``bits``.

    Args:
        model: says which classes there are, and which of several equal ones wins.
        care: what can occur on ``bits``.
        tables: in topological order.
        voters: the nets that vote.
        owners: the class that each votes for.
    """
    bits = Port("bits", care.width)
    votes = []
    for owner in range(len(model.classes)):
        word = tuple(Slice(net) for net, voted in zip(voters, owners, strict=True) if voted == owner)
        if not word:
            raise InputError(
                "a class has no table that votes for it", value=model.classes[owner], hint="train it again"
            )
        votes.append(Sum(f"votes_{owner}", word))
    winner = ArgMax(
        "winner", tuple((Slice(vote.name, 0, vote.drives[vote.name]),) for vote in votes), model.ties
    )
    return Circuit(
        CORE,
        f"Tables, votes and winner of {len(model.classes)} classes.",
        (bits,),
        (*tables, *votes, winner),
        {"class_bits": (Slice("winner", 0, winner.drives["winner"]),)},
        (Care(bits.word, care),),
    )


def _owners(model: BloomWisardModel) -> NDArray[np.int64]:
    """The class of each filter, class by class."""
    return np.repeat(np.arange(len(model.classes)), len(model.mapping))


def _voters(layers: Sequence[Layer]) -> list[str]:
    return [_name(len(layers) - 1, index) for index in range(len(layers[-1].contents))]


def _name(layer: int, index: int) -> str:
    return f"node_{layer}_{index}"


def implied(encoder: Encoder) -> CareSet:
    """What can occur on an encoder's bits at all: the bits of a thermometer fall."""
    if isinstance(encoder, ThermometerBits):
        return Implied(encoder.width, encoder.falling)
    if not isinstance(encoder, Thermometer):
        return Everything(encoder.width)
    groups, start = [], 0
    for levels in encoder.thresholds:
        groups.append(tuple(range(start, start + len(levels))))
        start += len(levels)
    return Implied(encoder.width, tuple(groups))


def known_bits(encoder: Encoder) -> dict[int, bool | int]:
    """Bits of an encoder that are the same for all words, or as an earlier bit, by position."""
    if not isinstance(encoder, Thermometer) or encoder.input is None:
        return {}
    known: dict[int, bool | int] = {}
    position = 0
    for levels in encoder.levels:
        first: dict[int, int] = {}
        for level in levels:
            if level <= encoder.input.lowest:
                known[position] = True
            elif level > encoder.input.highest:
                known[position] = False
            elif level in first:
                known[position] = first[level]
            else:
                first[level] = position
            position += 1
    return known


def _layers(model: VotingModel) -> tuple[list[Layer], NDArray[np.integer]]:
    """The tables by layer, and the class that each of the last layer votes for."""
    if isinstance(model, LutGroupModel):
        return [Layer(layer.mapping, layer.tables) for layer in model.layers], model.groups
    if isinstance(model.bleaching, int):
        mapping = np.concatenate(
            [model.mapping[owner if len(model.mapping) > 1 else 0] for owner in range(len(model.classes))]
        )
        owners = np.repeat(np.arange(len(model.classes)), model.rams)
        return [Layer(mapping, _fires(model, model.bleaching))], owners
    raise InputError(
        "the bleaching threshold is found again for each sample, which is not a circuit of tables",
        value=f"confidence {model.bleaching.confidence}",
        hint="import it with a fixed one, which makes another classifier: --bleach N; "
        "import --table says which N is most often right",
    )


def _fires(model: WisardModel | SparseWisardModel, bleaching: int) -> NDArray[np.bool_]:
    """The contents of all RAMs, bool ``[classes * k, 2**n]``."""
    if model.address_bits > MAX_TABLE_INPUTS:
        raise InputError(
            "a RAM has too many address bits for a table",
            value=model.address_bits,
            hint=f"use a model of at most {MAX_TABLE_INPUTS}",
        )
    rams = len(model.classes) * model.rams
    if isinstance(model, WisardModel):
        return (model.counts >= bleaching).reshape(rams, -1)
    fires = np.zeros((rams, 1 << model.address_bits), dtype=np.bool_)
    for ram in range(rams):
        addresses, counts = model.contents(*divmod(ram, model.rams))
        fires[ram, addresses[counts >= bleaching].astype(np.int64)] = True
    return fires


def _distinct(
    mapping: NDArray[np.integer], contents: NDArray[np.bool_]
) -> tuple[list[int], NDArray[np.bool_]]:
    """A table whose inputs may repeat, or be 0, as one over different inputs."""
    read = [int(position) for position in dict.fromkeys(mapping.tolist()) if position != ZERO]
    codes = np.arange(1 << len(read))
    address = np.zeros(len(codes), dtype=np.int64)
    for slot, position in enumerate(mapping.tolist()):
        if position != ZERO:
            address |= (codes >> read.index(position) & 1) << slot
    return read, contents[address]
