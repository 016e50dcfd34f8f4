"""Models of BTHOWeN: a pickle, compressed by lzma."""

import lzma
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.importers.arrays import NUMPY, array_of
from wnn2hdl.importers.base import Importer, ImportOptions, Source, damage_reported
from wnn2hdl.importers.pickles import Record, StandIn, read_pickle, record
from wnn2hdl.ir.features import ThermometerBits
from wnn2hdl.ir.models import BloomWisardModel
from wnn2hdl.ir.models.base import ZERO

MAX_PICKLE_BYTES = 1 << 28
"""The largest pickle; the largest published one has 12 MB."""

MAGIC = (b"\xfd7zXZ\x00", b"\x5d\x00\x00")

ALLOWED: dict[str, StandIn] = NUMPY | {
    name: record(name) for name in ("wisard.WiSARD", "wisard.Discriminator", "bloom_filter.BloomFilter")
}
"""All that such a pickle names."""


def recognises(source: Source) -> bool:
    """Whether the file is compressed by lzma, as no other format is."""
    return source.content.startswith(MAGIC)


def read(source: Source, _: ImportOptions) -> BloomWisardModel:
    """The model in a file of BTHOWeN; it reads thermometer bits, whose thresholds the file does not hold."""
    with damage_reported(source, "a BTHOWeN model"):
        data = read_pickle(_decompressed(source), ALLOWED.get)
        info, model = data["info"], data["model"]
        width = int(info["num_inputs"]) * int(info["bits_per_input"])
        inputs, entries = int(info["num_filter_inputs"]), int(info["num_filter_entries"])
        discriminators = model.state["discriminators"]
        if len(discriminators) != info["num_classes"]:
            raise ValueError(
                f"there are {len(discriminators)} discriminators for {info['num_classes']} classes"
            )
        if width < 1 or inputs < 1 or entries < 2:
            raise ValueError("no model has its sizes")
        mapping = _mapping(model, width, inputs)
        if len(discriminators) * len(mapping) * entries > MAX_PICKLE_BYTES:
            raise ValueError("it claims more entries than the file can hold")
        hashes = _hashes(array_of(info["hash_values"], "hash_values"), entries)
        contents = np.stack([_contents(each, len(mapping), entries, hashes) for each in discriminators])
        return BloomWisardModel(
            encoder=ThermometerBits(int(info["num_inputs"]), int(info["bits_per_input"])),
            classes=tuple(str(index) for index in range(len(contents))),
            mapping=mapping,
            hashes=hashes,
            contents=contents,
            origin=source.origin(
                "BTHOWeN",
                encoder="the file holds no thresholds: the model reads bits, "
                f"{info['bits_per_input']} for each of {info['num_inputs']} features; "
                "bit t of feature i is input t * features + i, set if the feature is at least threshold t",
            ),
        )


def _decompressed(source: Source) -> bytes:
    decompressor = lzma.LZMADecompressor(memlimit=MAX_PICKLE_BYTES)
    try:
        content = decompressor.decompress(source.content, max_length=MAX_PICKLE_BYTES)
    except lzma.LZMAError as error:
        raise ValueError(f"cannot decompress it: {error}") from error
    if not decompressor.eof:
        reason = (
            "it ends too early"
            if decompressor.needs_input
            else f"it holds more than {MAX_PICKLE_BYTES} bytes"
        )
        raise InputError("the compressed file is damaged or too large", value=f"{source.path} ({reason})")
    return content


def _mapping(model: Record, width: int, inputs: int) -> NDArray[np.int32]:
    """Inputs of each filter: the padded inputs in their order, cut into filters."""
    order = array_of(model.state["input_order"], "input_order")
    padded = -(-width // inputs) * inputs
    if order.shape != (padded,) or not np.array_equal(np.sort(order), np.arange(padded)):
        raise ValueError(f"input_order is not an order of {padded} inputs")
    return np.where(order < width, order, ZERO).astype(np.int32).reshape(-1, inputs)


def _hashes(values: NDArray[Any], entries: int) -> NDArray[np.uint32]:
    if values.dtype.kind not in "iu" or values.ndim != 2 or values.size == 0:
        raise ValueError(f"hash_values has shape {values.shape}")
    if values.min() < 0 or values.max() >= entries:
        raise ValueError(f"a hash constant is not an index of {entries} entries")
    return values.astype(np.uint32)


def _contents(
    discriminator: Record, filters: int, entries: int, hashes: NDArray[np.uint32]
) -> NDArray[np.bool_]:
    """What fires in each filter of a class: bool ``[filters, entries]``."""
    found = discriminator.state["filters"]
    if len(found) != filters:
        raise ValueError(f"a discriminator has {len(found)} filters, not {filters}")
    return np.stack([_filter(each.state, entries, hashes) for each in found])


def _filter(state: dict[str, Any], entries: int, hashes: NDArray[np.uint32]) -> NDArray[np.bool_]:
    data = array_of(state["data"], "a filter's data")
    if data.shape != (entries,) or not np.array_equal(array_of(state["hash_values"], "hash_values"), hashes):
        raise ValueError(f"a filter holds {data.shape} entries, not {entries}, or has its own hashes")
    bleach = state["bleach"]
    return np.asarray(data >= (bleach if type(bleach) is int else array_of(bleach, "bleach").reshape(())))


IMPORTER = Importer("bthowen", "a BTHOWeN model (.pickle.lzma)", recognises, read)
