"""Minimising a table, unless the same table was minimised before.

A result from the cache is checked against its table on every cared-for code, as a new one is; one that is
wrong, damaged or of another form is made again.
"""

import json
from collections.abc import Mapping
from typing import Any

from wnn2hdl.build.remembered import code_digest
from wnn2hdl.errors import CheckError, ModelFileError
from wnn2hdl.ir import LUT_INPUTS, Cover, Cube, LutNetwork, TruthTable
from wnn2hdl.minimise import Minimised, generators, require_equal
from wnn2hdl.minimise.circuit import MinimisedTable, minimise_table
from wnn2hdl.synth import cache

_KIND = "tables"


def minimise_once(table: TruthTable, effort: int, lut_inputs: int = LUT_INPUTS) -> MinimisedTable:
    """As `wnn2hdl.minimise.circuit.minimise_table`, whose result is kept in the cache on disk."""
    key = {
        "table": cache.digest(json.dumps(table.to_json())),
        "effort": str(effort),
        "lut_inputs": str(lut_inputs),
        "code": code_digest(),
        **generators(),
    }
    kept = cache.load(_KIND, key)
    minimised = None if kept is None else _read(kept, table)
    if minimised is None:
        minimised = minimise_table(table, effort, lut_inputs)
        cache.store(_KIND, key, _to_json(minimised))
    return minimised


def _to_json(minimised: MinimisedTable) -> dict[str, Any]:
    return {
        "cover": [[cube.mask, cube.value, cube.outputs] for cube in minimised.cover.cover.cubes],
        "cover_by": minimised.cover.method,
        "network": minimised.network.to_json(),
        "network_by": minimised.method,
    }


def _read(kept: Mapping[str, Any], table: TruthTable) -> MinimisedTable | None:
    """What the cache holds for a table; None unless it is of this form and right."""
    try:
        cubes = tuple(Cube(int(mask), int(value), int(outputs)) for mask, value, outputs in kept["cover"])
        cover = Minimised.of(table, Cover(table.inputs, table.outputs, cubes), str(kept["cover_by"]))
        minimised = MinimisedTable(cover, LutNetwork.from_json(kept["network"]), str(kept["network_by"]))
        network = minimised.network
        if network.inputs != table.inputs or tuple(name for name, _ in network.outputs) != table.outputs:
            return None
        require_equal(table, cover.cover, "the cover in the cache")
        require_equal(table, network, "the network in the cache")
    except (CheckError, ModelFileError, AttributeError, KeyError, TypeError, ValueError, OverflowError):
        return None
    return minimised
