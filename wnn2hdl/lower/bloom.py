"""Discriminators of Bloom filters as tables over exclusive ors of the input bits.

A filter is made in one of two ways, whichever is estimated to take fewer LUTs for all classes together:

- *collapsed*: one table over the input bits of the filter, in which bits that cannot occur together are free;
- *hashed*: as it is trained, one look-up for each hash. A look-up reads a basis of what the bits of its hash
  span, whose exclusive ors are of fewer bits than the hash's own, and are shared by all classes.

Both read *forms*: exclusive ors of bits of the encoder, which are given as masks of these bits. A form of one
bit is that bit.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.ir import LUT_INPUTS, MAX_TABLE_INPUTS, TruthTable
from wnn2hdl.ir.care import CareSet, Everything, Implied
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.codes import codes_to_bits
from wnn2hdl.ir.linear import basis, combination
from wnn2hdl.ir.models import BloomWisardModel
from wnn2hdl.ir.models.base import ZERO
from wnn2hdl.ir.nodes import Table
from wnn2hdl.ir.wires import Port, Slice
from wnn2hdl.minimise.estimate import table_luts, xor_luts

BITS = "bits"
FORMS = "forms"
HASHES = "hashes"


@dataclass(frozen=True, eq=False)
class FilterTables:
    """The filters of all classes as tables.

    Attributes:
        forms: what the tables read, masks of the encoder's bits; those of one bit first, ascending.
        tables: in topological order; bit ``i`` of the net `BITS` is ``forms[i]``.
        voters: the net of each filter, class by class.
        care: what can occur on the net.
    """

    forms: tuple[int, ...]
    tables: tuple[Table, ...]
    voters: tuple[str, ...]
    care: CareSet


def filter_tables(model: BloomWisardModel, allowed: CareSet, known: dict[int, bool | int]) -> FilterTables:
    """Make the tables of all filters.

    Args:
        model: the model.
        allowed: what can occur on the encoder's bits.
        known: bits of the encoder that are constant, or equal to an earlier one.

    Raises:
        InputError: a hash reads more bits than a table can.
    """
    ways = [_Filter(model, number, known) for number in range(len(model.mapping))]
    collapsed = [each.collapses(allowed) for each in ways]
    read: dict[int, None] = {}
    for each, is_one_table in zip(ways, collapsed, strict=True):
        read |= dict.fromkeys(each.bits if is_one_table else each.forms)
    forms = sorted(read, key=lambda mask: (mask.bit_count() > 1, mask))
    place = {mask: Slice(BITS, number) for number, mask in enumerate(forms)}
    made = [
        each.collapsed(place, allowed) if is_one_table else each.hashed(place)
        for each, is_one_table in zip(ways, collapsed, strict=True)
    ]
    tables: list[Table] = []
    voters = []
    for owner in range(len(model.classes)):
        for of_filter in made:
            tables += of_filter[owner]
            voters.append(of_filter[owner][-1].name)
    return FilterTables(tuple(forms), tuple(tables), tuple(voters), _occurring(forms, allowed))


def hash_circuit(read: Sequence[int], forms: Sequence[int]) -> Circuit:
    """The circuit `HASHES`: `BITS`, those of the encoder at some positions, to `FORMS`."""
    port = Port(BITS, len(read))
    place = {position: Slice(BITS, number) for number, position in enumerate(read)}
    nodes: list[Table] = []
    word: list[Slice] = []
    for number, mask in enumerate(forms):
        bits = [place[position] for position in _members(mask)]
        while len(bits) > 1:
            taken, bits = bits[:LUT_INPUTS], bits[LUT_INPUTS:]
            odd = np.bitwise_count(np.arange(1 << len(taken))) & 1 == 1
            names = tuple(f"i{slot}" for slot in range(len(taken)))
            nodes.append(
                Table(
                    f"xor_{number}_{len(bits)}",
                    tuple(taken),
                    TruthTable.exact(names, ("odd",), odd[:, np.newaxis]),
                )
            )
            bits.append(Slice(nodes[-1].name))
        word += bits
    carries = {mask: Slice(FORMS, number) for number, mask in enumerate(forms)}
    summary = f"{len(forms)} exclusive ors of {len(read)} bits."
    return Circuit(HASHES, summary, (port,), tuple(nodes), {FORMS: tuple(word)}, carries=carries)


def positions(forms: Sequence[int]) -> tuple[int, ...]:
    """The encoder's bits that forms read, ascending."""
    together = 0
    for mask in forms:
        together |= mask
    return _members(together)


class _Filter:
    """One filter of all discriminators.

    Args:
        model: the model.
        number: of the filter.
        known: see `filter_tables`.

    Attributes:
        bits: the masks of the input bits that it reads, one for each bit, ascending.
        forms: what its look-ups read, hash by hash.
    """

    def __init__(self, model: BloomWisardModel, number: int, known: dict[int, bool | int]) -> None:
        self._model, self._number = model, number
        self._hashes: list[dict[int, int]] = []
        self._offsets: list[int] = []
        for constants in model.hashes.tolist():
            of_bit: dict[int, int] = {}
            offset = 0
            for position, constant in zip(model.mapping[number].tolist(), constants, strict=True):
                found = known.get(position, position)
                if isinstance(found, bool):
                    offset ^= constant * found
                elif position != ZERO:
                    of_bit[found] = of_bit.get(found, 0) ^ constant
            self._hashes.append(of_bit)
            self._offsets.append(offset)
        # A filter of constants reads a bit that does not matter.
        read = sorted({bit for of_bit in self._hashes for bit, constant in of_bit.items() if constant}) or [0]
        self.bits = [1 << bit for bit in read]
        self._bases = [basis(rows) or (self.bits[0],) for rows in self._rows()]
        self.forms = [mask for masks in self._bases for mask in masks]

    def collapses(self, allowed: CareSet) -> bool:
        """Whether one table over the input bits is estimated to take fewer LUTs than look-ups."""
        inputs = len(self.bits)
        if inputs <= LUT_INPUTS:
            return True
        if inputs > MAX_TABLE_INPUTS:
            return False
        owners = len(self._model.classes)
        hashed = sum(xor_luts(mask.bit_count()) for mask in set(self.forms))
        for masks in self._bases:
            hashed += owners * table_luts(len(masks), 1 << len(masks))
        hashed += owners * (len(self._bases) > 1)
        codes = np.flatnonzero(allowed.project(_bits_of(self.bits)))
        fires = self._fires(codes_to_bits(codes, inputs))
        return sum(table_luts(inputs, min(x, len(codes) - x)) for x in fires.sum(axis=1).tolist()) <= hashed

    def collapsed(self, place: dict[int, Slice], allowed: CareSet) -> list[list[Table]]:
        """One table for each class."""
        inputs = len(self.bits)
        word = tuple(place[mask] for mask in self.bits)
        care = allowed.project(_bits_of(self.bits))
        fires = self._fires(codes_to_bits(np.arange(1 << inputs), inputs))
        return [[self._table(owner, "", word, own, care)] for owner, own in enumerate(fires)]

    def hashed(self, place: dict[int, Slice]) -> list[list[Table]]:
        """For each class its look-ups, and the table that joins them."""
        made: list[list[Table]] = [[] for _ in self._model.classes]
        for number, (masks, rows) in enumerate(zip(self._bases, self._rows(), strict=True)):
            if len(masks) > MAX_TABLE_INPUTS:
                raise InputError("a hash reads too many bits for a table", value=len(masks))
            word = tuple(place[mask] for mask in masks)
            codes = np.arange(1 << len(masks))
            address = np.full(len(codes), self._offsets[number])
            for index, row in enumerate(rows):
                address ^= (np.bitwise_count(codes & combination(row, masks)) & 1).astype(np.int64) << index
            for owner, contents in enumerate(self._model.contents[:, self._number]):
                made[owner].append(self._table(owner, f"_hash_{number}", word, contents[address]))
        if len(self._bases) > 1:
            every = np.arange(1 << len(self._bases)) == (1 << len(self._bases)) - 1
            for owner, tables in enumerate(made):
                tables.append(self._table(owner, "", tuple(Slice(table.name) for table in tables), every))
        return made

    def _rows(self) -> list[list[int]]:
        """For each hash and each of its bits the encoder's bits of which it is the exclusive or."""
        size = self._model.contents.shape[2].bit_length() - 1
        return [
            [
                sum(1 << bit for bit, constant in of_bit.items() if constant >> index & 1)
                for index in range(size)
            ]
            for of_bit in self._hashes
        ]

    def _fires(self, rows: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Answers of all classes for values of `bits`, bool ``[samples, bits]``: ``[classes, samples]``."""
        fires = np.ones((len(self._model.classes), len(rows)), dtype=np.bool_)
        for of_bit, offset in zip(self._hashes, self._offsets, strict=True):
            address = np.full(len(rows), offset)
            for place, bit in enumerate(_bits_of(self.bits)):
                address ^= rows[:, place] * np.int64(of_bit.get(bit, 0))
            fires &= self._model.contents[:, self._number][:, address]
        return fires

    def _table(
        self,
        owner: int,
        suffix: str,
        word: tuple[Slice, ...],
        fires: NDArray[np.bool_],
        care: NDArray[np.bool_] | None = None,
    ) -> Table:
        names = tuple(f"i{slot}" for slot in range(len(word)))
        cared = np.ones(len(fires), dtype=np.bool_) if care is None else care
        function = TruthTable(names, ("fires",), (fires & cared)[:, np.newaxis], cared)
        return Table(f"filter_{owner}_{self._number}{suffix}", word, function)


def _occurring(forms: Sequence[int], allowed: CareSet) -> CareSet:
    """What can occur on forms: those of one bit are bits of the encoder, the others count as independent."""
    if not isinstance(allowed, Implied):
        return Everything(len(forms))
    place = {mask.bit_length() - 1: number for number, mask in enumerate(forms) if mask.bit_count() == 1}
    groups = [tuple(place[bit] for bit in group if bit in place) for group in allowed.falling]
    return Implied(len(forms), tuple(group for group in groups if group))


def _bits_of(masks: Sequence[int]) -> tuple[int, ...]:
    return tuple(mask.bit_length() - 1 for mask in masks)


def _members(mask: int) -> tuple[int, ...]:
    """The positions of a mask's bits, ascending."""
    return tuple(position for position in range(mask.bit_length()) if mask >> position & 1)
