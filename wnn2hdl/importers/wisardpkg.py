"""Models of wisardpkg: the JSON that its ``json()`` writes."""

import base64
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.importers.base import Importer, ImportOptions, Source, damage_reported, whole_numbers
from wnn2hdl.ir.features import Words
from wnn2hdl.ir.models import Dynamic, SparseWisardModel
from wnn2hdl.ir.models.base import ZERO
from wnn2hdl.ir.models.wisard import MAX_ADDRESS_BITS

RECORD = np.dtype([("address", "<u8"), ("count", "<i4")])
"""A stored address in a RAM's data."""

MAX_SLOTS = 1 << 26
"""Address bits of all RAMs together."""

DATA_SUFFIX = ".wdpkg"
"""Of the files that hold a class's RAMs where the JSON does not."""


def recognises(source: Source) -> bool:
    """Whether the file is a model of wisardpkg."""
    data = source.object
    return data is not None and {"addressSize", "bleachingActivated", "classes"} <= data.keys()


def read(source: Source, options: ImportOptions) -> SparseWisardModel:
    """The model in a file of wisardpkg.

    Its classes are those of the file by name, and the last of several equal ones wins. Bleaching stays
    dynamic unless the options fix the threshold.
    """
    with damage_reported(source, "a wisardpkg model"):
        data = source.json()
        if data["base"] != 2:
            raise InputError("the model reads digits, not bits", value=f"{source.path} (base {data['base']})")
        labels = sorted(data["classes"], key=lambda label: label.encode())
        discriminators = [data["classes"][label] for label in labels]
        widths = whole_numbers([each["entrySize"] for each in discriminators], "entrySize")
        if len(set(widths.tolist())) != 1:
            raise ValueError(f"classes read inputs of {widths.min()} to {widths.max()} bits")
        contents = [_contents(source, each, bool(data["ignoreZero"])) for each in discriminators]
        mapping = _mapping([each["mapping"] for each in discriminators])
        rams = mapping.shape[1]
        stored = [ram for owner in contents for ram in owner + [_NOTHING] * (rams - len(owner))]
        entries = np.concatenate(stored)
        bleaching = _bleaching(data, options)
        origin = source.origin(
            "wisardpkg",
            version=str(data.get("version", "")),
            bleaching=f"fixed at {bleaching} by request: not the classifier of the file"
            if options.bleach is not None
            else "as in the file",
            encoder="the file holds none: the model reads bits",
        )
        return SparseWisardModel(
            encoder=Words(int(widths[0])),
            classes=tuple(labels),
            mapping=mapping,
            offsets=np.cumsum([0, *map(len, stored)], dtype=np.int64),
            addresses=entries["address"].astype(np.uint64),
            counts=entries["count"].astype(np.int64),
            bleaching=bleaching,
            ties="last",
            origin=origin,
        )


def _bleaching(data: dict[str, Any], options: ImportOptions) -> int | Dynamic:
    if options.bleach is not None:
        return options.bleach
    return Dynamic(int(data.get("confidence", 1))) if data["bleachingActivated"] else 1


def _mapping(lists: list[list[list[int]]]) -> NDArray[np.int32]:
    """Mappings of all classes, ``[classes, k, n]``; where one is shorter, the rest reads nothing."""
    rams = max(len(owner) for owner in lists)
    bits = max(len(inputs) for owner in lists for inputs in owner)
    if bits > MAX_ADDRESS_BITS:
        raise ValueError(f"a RAM has {bits} address bits; there are at most {MAX_ADDRESS_BITS}")
    if len(lists) * rams * bits > MAX_SLOTS:
        raise ValueError(f"{len(lists)} classes of up to {rams} RAMs are too many")
    mapping = np.full((len(lists), rams, bits), ZERO, dtype=np.int32)
    for index, owner in enumerate(lists):
        for ram, inputs in enumerate(owner):
            numbers = whole_numbers(inputs, "a RAM's mapping")
            if numbers.min() < 0:
                raise ValueError(f"a RAM reads input {numbers.min()}")
            mapping[index, ram, : len(inputs)] = numbers
    same = all(np.array_equal(owner, mapping[0]) for owner in mapping)
    return mapping[:1] if same else mapping


_NOTHING: NDArray[Any] = np.empty(0, dtype=RECORD)


def _contents(source: Source, discriminator: dict[str, Any], ignore_zero: bool) -> list[NDArray[Any]]:
    """What each RAM of a class stores: records by rising address."""
    text: str = discriminator["data"]
    if text.endswith(DATA_SUFFIX):
        text = _beside(source, text)
    rams = text.split(".")
    if len(rams) != len(discriminator["mapping"]):
        raise ValueError(
            f"there are data of {len(rams)} RAMs; the mapping asks for {len(discriminator['mapping'])}"
        )
    return [_ram(ram, ignore_zero) for ram in rams]


def _beside(source: Source, name: str) -> str:
    # The file names where its data were when it was written; only the folder it is in is looked at.
    path = source.path.parent / name.replace("\\", "/").rpartition("/")[2]
    return Source(path).content.decode("ascii").strip()


def _ram(text: str, ignore_zero: bool) -> NDArray[Any]:
    records = np.frombuffer(base64.b64decode(text, validate=True), dtype=RECORD)
    firing = records["count"] > 0
    if ignore_zero:
        firing &= records["address"] != 0
    kept = records[firing]
    kept = kept[np.argsort(kept["address"], kind="stable")]
    if (kept["address"][1:] == kept["address"][:-1]).any():
        raise ValueError("a RAM stores an address twice")
    return kept


IMPORTER = Importer("wisardpkg", "a wisardpkg model (JSON)", recognises, read, options=frozenset({"bleach"}))
