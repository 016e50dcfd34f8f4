"""What the pieces of a network have to compute, and why they make the model.

The pieces are an encoder, tables, a sum for each class and a winner; Bloom filters may read exclusive ors of
the encoder's bits, which are a piece between encoder and tables. A circuit drops tables that are constant,
lets equal tables be one, and makes only those bits of the encoder that it reads. Which of its bits are which
of the model's it says itself (`wnn2hdl.ir.circuit.Circuit.carries`); that is a hint, and part of what is
proved:

- encoder: for all features, each bit is the model's bit that it is said to be;
- hashes: for all bits, each exclusive or is that of the bits that it is said to be of;
- tables: for every table of the model's last layer, the bit or the constant that is said to stand for it
  equals it, for all bits that the encoder can give, and all values of exclusive ors;
- sum: for all bits, the sum of their weights and a constant;
- winner: for all numbers, the index of the largest, and of equal ones the one that the model takes.

Why this makes the model. The bits behind the encoder are those of the model for some features, so the claim
about the tables holds for them. Where a table reads exclusive ors, they are a basis of what the bits of a
hash span: which of them make a bit of the hash is found here from the model, and what is claimed for all
their values holds for those that occur. The sum of a class adds what stands for the model's tables that vote
for this class: its weights and its constant are counted here from the model, so its total is the number of
these tables that fire. The winner is then that of the model.

What an encoder can give is written as a function of ranks: how many of its different thresholds a feature
reaches. Every rank is that of some word and every word has a rank, so "for all ranks" is "for all bits that
the encoder can give".
"""

from collections import Counter
from collections.abc import Container

from wnn2hdl.ir import Thermometer, ThermometerBits
from wnn2hdl.ir.circuit import Circuit, Instance
from wnn2hdl.ir.encoder import Encoder
from wnn2hdl.ir.models import NetworkModel
from wnn2hdl.ir.wires import Slice
from wnn2hdl.verify.addition import Sums
from wnn2hdl.verify.composition import Box, Composition, Piece, bits
from wnn2hdl.verify.network_lines import (
    at_least,
    encoder_lines,
    features_width,
    owners_of,
    positions_read,
    table_lines,
)
from wnn2hdl.verify.reference import class_bits, module, weighted_sum, winning


class Pieces:
    """The pieces of a network, and their wiring.

    Args:
        model: the model.
        circuit: the network made from it.

    Attributes:
        composition: what is claimed.

    Raises:
        ValueError: the circuit is not made of these pieces, or does not say what its bits are.
    """

    def __init__(self, model: NetworkModel, circuit: Circuit) -> None:
        self._model = model
        self._parts = circuit.definitions()
        self._forms: list[int] = []
        self._modules: list[str] = []
        if not {"encoder", "tables", "core", "winner"} <= self._parts.keys():
            raise ValueError(f"a network is not made of {', '.join(self._parts)}")
        self._sums = {
            node.name: node.circuit.name for node in self._parts["core"].nodes if isinstance(node, Instance)
        }
        read = self._read()
        pieces = {"encoder": self._encoder(read)}
        self._forms = [1 << number for number in read]
        if "hashes" in self._parts:
            self._forms = self._exclusive_ors(read)
            pieces["hashes"] = self._hashes(read)
        pieces["tables"] = self._tables(read)
        boxes = {"encode": Box("encoder", {"features": bits("features", features_width(model.encoder))})}
        encoded = bits("encode.bits", len(read))
        if "hashes" in self._parts:
            boxes["hash"] = Box("hashes", {"bits": encoded})
            encoded = bits("hash.forms", len(self._forms))
        boxes["decide.tables"] = Box("tables", {"bits": encoded})
        responses: dict[str, tuple[str, ...]] = {}
        added: dict[str, tuple[tuple[int, ...], int]] = {}
        for owner in range(len(model.classes)):
            name = f"votes_{owner}"
            if name not in self._sums:
                raise ValueError(f"there is no {name}")
            part = self._sums[name]
            places, weights, offset = self._votes(owner)
            if part not in pieces:
                pieces[part] = self._sum(part, weights, offset)
            if added.setdefault(part, (weights, offset)) != (weights, offset):
                raise ValueError(f"{name} is not the sum {part}")
            boxes[f"decide.{name}"] = Box(part, {"bits": tuple(f"decide.tables.votes[{k}]" for k in places)})
            responses[f"response_{owner}"] = bits(f"decide.{name}.total", pieces[part].outputs["total"])
        pieces["winner"] = self._winner({port: len(word) for port, word in responses.items()})
        boxes["decide.winner"] = Box("winner", responses)
        outputs = {"class_bits": bits("decide.winner.class_bits", class_bits(model))}
        self.composition = Composition(circuit.name, pieces, boxes, outputs, "".join(self._modules))

    def _read(self) -> list[int]:
        """Which of the encoder's bits the circuit makes, in its order."""
        carries = self._parts["encoder"].carries
        places = {bit.low: number for number, bit in carries.items() if isinstance(bit, Slice)}
        if sorted(places) != list(range(len(carries))) or not places:
            raise ValueError("the encoder does not say what its bits are")
        if not all(0 <= number < self._model.encoder.width for number in places.values()):
            raise ValueError("the encoder makes bits that the model has not")
        return [places[place] for place in range(len(places))]

    def _encoder(self, read: list[int]) -> Piece:
        inputs, outputs = {"features": features_width(self._model.encoder)}, {"bits": len(read)}
        lines, signals = encoder_lines(self._model.encoder, read)
        lines.append(f"  assign bits = {_joined([signals[number] for number in read])};")
        statement = "each bit is that of the model, for all features"
        return self._piece(statement, "encoder", inputs, outputs, lines)

    def _exclusive_ors(self, read: list[int]) -> list[int]:
        """Masks of the encoder's bits, in the order in which the circuit makes their exclusive ors."""
        carries = self._parts["hashes"].carries
        places = {bit.low: mask for mask, bit in carries.items() if isinstance(bit, Slice)}
        if sorted(places) != list(range(len(carries))) or not places:
            raise ValueError("the exclusive ors do not say what they are of")
        if any(mask & ~sum(1 << number for number in read) for mask in places.values()):
            raise ValueError("an exclusive or is of bits that are not made")
        return [places[place] for place in range(len(places))]

    def _hashes(self, read: list[int]) -> Piece:
        inputs, outputs = {"bits": len(read)}, {"forms": len(self._forms)}
        terms = [
            " ^ ".join(f"bits[{place}]" for place, number in enumerate(read) if mask >> number & 1)
            for mask in self._forms
        ]
        statement = "each exclusive or is of the bits that it is said to be of, for all bits"
        return self._piece(statement, "hashes", inputs, outputs, [f"  assign forms = {_joined(terms)};"])

    def _tables(self, read: list[int]) -> Piece:
        carries, count = self._parts["tables"].carries, len(owners_of(self._model))
        if carries.keys() != set(range(count)):
            raise ValueError("the tables do not say what stands for which table of the model")
        votes = 1 + max((bit.low for bit in carries.values() if isinstance(bit, Slice)), default=0)
        ranks, lines = _ranks(self._model.encoder, positions_read(self._model).union(read))
        free = [mask for mask in self._forms if mask.bit_count() > 1]
        inputs, outputs = {"ranks": ranks}, {"fires": count}
        forms = {mask: f"free[{place}]" for place, mask in enumerate(free)}
        width = self._model.encoder.width
        self._modules.append(module("proof__bits", inputs, {"bits": width}, lines))
        if free:
            inputs["free"] = len(free)
        given = [f"  wire [{width - 1}:0] given;", "  proof__bits ranked (.ranks(ranks), .bits(given));"]
        made, fires = table_lines(self._model, [f"given[{number}]" for number in range(width)], forms)
        lines = [*given, *made, f"  assign fires = {_joined(fires)};"]
        stand = [
            f"1'b{int(bit)}" if isinstance(bit, bool) else f"votes[{bit.low}]"
            for _, bit in sorted(carries.items())
        ]
        frame = (*given, f"  wire [{votes - 1}:0] votes;", f"  assign fires = {_joined(stand)};")
        made_of = [forms.get(mask, f"given[{mask.bit_length() - 1}]") for mask in self._forms]
        connections = {"bits": _joined(made_of), "votes": "votes"}
        statement = "what stands for a table of the model equals it, for all bits that the encoder can give"
        return self._piece(statement, "tables", inputs, outputs, lines, frame, connections)

    def _votes(self, owner: int) -> tuple[list[int], tuple[int, ...], int]:
        """Which votes a class adds, with which weights, and what is added to that, by the model's tables."""
        weights: Counter[int] = Counter()
        offset = 0
        for table, voted in enumerate(owners_of(self._model)):
            if voted == owner:
                bit = self._parts["tables"].carries[table]
                if isinstance(bit, bool):
                    offset += bit
                else:
                    weights[bit.low] += 1
        if not weights:
            raise ValueError(f"all tables that vote for class {owner} are constant")
        return list(weights), tuple(weights.values()), offset

    def _sum(self, part: str, weights: tuple[int, ...], offset: int) -> Piece:
        outputs = {"total": (sum(weights) + offset).bit_length()}
        added = weighted_sum([f"bits[{place}]" for place in range(len(weights))], weights, offset)
        lines = [f"  assign total = {added};"]
        statement = f"the sum of {len(weights)} bits by their weights, for all bits"
        sums = Sums.of_bits(weights, offset)
        return self._piece(statement, part, {"bits": len(weights)}, outputs, lines, sums=sums)

    def _winner(self, inputs: dict[str, int]) -> Piece:
        lines = winning(len(inputs), max(inputs.values()), ties=self._model.ties)
        outputs = {"class_bits": class_bits(self._model)}
        statement = f"the index of the largest number, of equal ones the {self._model.ties}, for all numbers"
        return self._piece(statement, "winner", inputs, outputs, lines)

    def _piece(
        self,
        statement: str,
        part: str,
        inputs: dict[str, int],
        outputs: dict[str, int],
        lines: list[str],
        frame: tuple[str, ...] = (),
        connections: dict[str, str] | None = None,
        sums: Sums | None = None,
    ) -> Piece:
        name = f"proof__{part}"
        self._modules.append(module(name, inputs, outputs, lines))
        return Piece(statement, name, inputs, outputs, frame, connections or {}, sums)


def _ranks(encoder: Encoder, read: Container[int]) -> tuple[int, list[str]]:
    """How many bits the ranks of all features have, and the lines that make the encoder's bits of them.

    Bits that are not read are 0.
    """
    if isinstance(encoder, ThermometerBits):
        width = encoder.levels.bit_length()
        reaches = [
            f"ranks[{width * (number + 1) - 1}:{width * number}] > {width}'d{level}"
            for level in range(encoder.levels)
            for number in range(encoder.thermometers)
        ]
        return width * encoder.thermometers, [f"  assign bits = {_joined(reaches)};"]
    if not isinstance(encoder, Thermometer):
        return features_width(encoder), ["  assign bits = ranks;"]
    form = encoder.input
    assert form is not None
    expressions: list[str] = []
    low = 0
    for levels in encoder.levels:
        reached = sorted({level for level in levels if form.lowest < level <= form.highest})
        width = len(reached).bit_length()
        for level in levels:
            if len(expressions) not in read:
                expressions.append("1'b0")
            elif form.lowest < level <= form.highest:
                rank = reached.index(level) + 1
                expressions.append(at_least("ranks", rank, width, low))
            else:
                expressions.append(f"1'b{int(level <= form.lowest)}")
        low += width
    return max(low, 1), [f"  assign bits = {_joined(expressions)};"]


def _joined(signals: list[str]) -> str:
    """Bits side by side; the first is the least significant."""
    return f"{{{', '.join(reversed(signals))}}}"
