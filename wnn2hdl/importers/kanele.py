"""Models of KANELÉ: ``truth_tables.json`` and the ``config.json`` beside it."""

import re
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from wnn2hdl.errors import InputError
from wnn2hdl.files import read_json
from wnn2hdl.importers.base import Importer, ImportOptions, Source, damage_reported, whole_numbers
from wnn2hdl.ir.features import Words
from wnn2hdl.ir.models import SumLayer, TableSumModel

KEY = re.compile(r"(\d{1,6})_(\d{1,6})_(\d{1,6})")
"""Of an edge: layer, input, output."""

ACTIVE = "acive"
"""Whether an edge counts; the spelling is the file's."""

VALUES = "values_int"

MAX_EDGES = 20_000_000


def recognises(source: Source) -> bool:
    """Whether the file holds truth tables of edges."""
    data = source.object
    if not data:
        return False
    key, edge = next(iter(data.items()))
    return KEY.fullmatch(key) is not None and isinstance(edge, dict) and {ACTIVE, VALUES} <= edge.keys()


def read(source: Source, options: ImportOptions) -> TableSumModel:
    """The model in truth tables of KANELÉ; it reads words that are quantised already."""
    config = _config(source, options.config)
    with damage_reported(source, "KANELÉ truth tables"):
        widths, bits = config["layers"], config["layers_bitwidth"]
        if len(widths) != len(bits) or len(widths) < 2 or min(*widths, *bits) < 1 or max(bits) > 16:
            raise ValueError("config.json: layers and layers_bitwidth do not describe a network")
        tables = source.json()
        expected = sum(before * after for before, after in pairwise(widths))
        if len(tables) != expected or expected > MAX_EDGES:
            raise ValueError(f"there are {len(tables)} edges; config.json asks for {expected}")
        sizes = zip(pairwise(widths), pairwise(bits), strict=True)
        layers = tuple(_layer(tables, index, nodes, words) for index, (nodes, words) in enumerate(sizes))
        return TableSumModel(
            encoder=Words(widths[0], bits[0]),
            classes=tuple(str(index) for index in range(widths[-1])),
            layers=layers,
            origin=source.origin(
                "KANELÉ",
                encoder="the files do not say how features are quantised: the model reads "
                f"{widths[0]} words of {bits[0]} bits that count from 0",
            ),
        )


def _config(source: Source, path: Path | None) -> dict[str, Any]:
    beside = source.path.with_name("config.json")
    if path is None and not beside.is_file():
        raise InputError(
            "truth tables do not say how wide the sums of each layer are",
            value=source.path,
            hint="give the model's config.json with --config",
        )
    config = read_json(path or beside, "the model's config.json")
    for key in ("layers", "layers_bitwidth"):
        values = config.get(key)
        if not isinstance(values, list) or not all(type(value) is int for value in values):
            raise InputError("not a config.json of KANELÉ", value=f"{path or beside} (no {key})")
    return config


def _layer(tables: dict[str, Any], index: int, nodes: tuple[int, int], bits: tuple[int, int]) -> SumLayer:
    """One layer of ``nodes[0]`` inputs of ``bits[0]`` bits and ``nodes[1]`` outputs of ``bits[1]``."""
    found = [
        (source, target, tables[f"{index}_{source}_{target}"][VALUES])
        for target in range(nodes[1])
        for source in range(nodes[0])
        if _active(tables[f"{index}_{source}_{target}"][ACTIVE])
    ]
    values = np.empty((len(found), 1 << bits[0]), dtype=np.int32)
    for row, (source, target, listed) in enumerate(found):
        exact = whole_numbers(listed, "an edge's values")
        if exact.shape != (1 << bits[0],):
            raise ValueError(f"edge {index}_{source}_{target} does not hold {1 << bits[0]} whole numbers")
        if np.abs(exact).max() >> 31:
            raise ValueError(f"edge {index}_{source}_{target} holds a value beyond 32 bits")
        values[row] = exact
    return SumLayer(
        nodes=nodes[1],
        output_bits=bits[1],
        sources=np.array([source for source, _, _ in found], dtype=np.int32),
        targets=np.array([target for _, target, _ in found], dtype=np.int32),
        values=values,
    )


def _active(value: object) -> bool:
    if value not in (0, 1):
        raise ValueError(f"an edge is active or not, 1 or 0, not {str(value)[:20]}")
    return bool(value)


IMPORTER = Importer("kanele", "KANELÉ truth tables (JSON)", recognises, read, options=frozenset({"config"}))
