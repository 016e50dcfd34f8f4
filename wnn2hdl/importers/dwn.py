"""Differentiable weightless networks: checkpoints of torch_dwn, of dwn2rtl, and dictionaries like theirs."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import InputError
from wnn2hdl.importers.arrays import array_of
from wnn2hdl.importers.base import Importer, ImportOptions, Source, damage_reported
from wnn2hdl.importers.checkpoints import is_checkpoint, read_checkpoint
from wnn2hdl.importers.pickles import Record
from wnn2hdl.ir.features import FeatureEncoder, Thermometer, Words
from wnn2hdl.ir.models import LutGroupModel, LutLayer

TABLES = re.compile(r"(?P<layer>(?:.*\.)?(?P<number>\d{1,4}))\.luts")
"""Key of a layer's tables in a state dictionary."""

MAX_DEPTH = 20
"""How deep modules may contain others."""


def recognises(source: Source) -> bool:
    """Whether the file is a checkpoint of PyTorch."""
    return is_checkpoint(source.content)


def read(source: Source, options: ImportOptions) -> LutGroupModel:
    """The network in a checkpoint.

    A table's bit is set where its weight is above 0; a learned mapping takes the input of the highest weight,
    the first among equals; a feature sets a thermometer bit if it is above the threshold.
    """
    with damage_reported(source, "a DWN checkpoint"):
        parts = _Parts.of(read_checkpoint(source.content))
        layers = tuple(_layers(parts.state))
        classes = _classes(source, parts, options)
        width, encoder_note = _input_width(parts)
        encoder: FeatureEncoder = (
            Words(width) if parts.thresholds is None else _thermometer(parts.thresholds, width)
        )
        notes: dict[str, Any] = {"encoder": encoder_note} if encoder_note else {}
        if parts.scaler is not None:
            notes["scaler"] = parts.scaler
            notes["features"] = "scaled: (x - mean) / scale comes before the thermometer"
        nodes = layers[-1].nodes
        return LutGroupModel(
            encoder=encoder,
            classes=classes,
            layers=layers,
            groups=(np.arange(nodes) // -(-nodes // len(classes))).astype(np.int32),
            origin=source.origin("DWN", **notes),
        )


@dataclass(frozen=True, eq=False)
class _Parts:
    """What a checkpoint holds, whatever its form.

    Attributes:
        state: tensors by name, as of ``state_dict``.
        thresholds: float64 ``[features, bits]`` or ``[bits]``; None if there is no thermometer.
        scaler: ``mean`` and ``scale`` of each feature; None if there is none.
        classes: how many, if it says so.
        names: of classes, if it says so.
    """

    state: dict[str, Any]
    thresholds: NDArray[np.float64] | None
    scaler: dict[str, list[float]] | None
    classes: int | None
    names: tuple[str, ...] | None

    @classmethod
    def of(cls, data: object) -> "_Parts":
        """The parts of a module, of a state dictionary, or of a dictionary with one of them in it."""
        if isinstance(data, Record) or any(TABLES.fullmatch(str(key)) for key in _dictionary(data)):
            data = {"model": data}
        data = _dictionary(data)
        model = data.get("state_dict", data.get("model"))
        config = _dictionary(data.get("config", {}))
        count = config.get("num_classes", _groups(model) if isinstance(model, Record) else None)
        return cls(
            state=dict(_state(model)) if isinstance(model, Record) else _dictionary(model),
            thresholds=_thresholds(data.get("thermometer", data.get("thermometre"))),
            scaler=_scaler(data.get("scaler")),
            classes=count if type(count) is int else None,
            names=_texts(data.get("classes")),
        )


def _dictionary(value: object) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise ValueError(f"there is a {type(value).__name__} where a dictionary should be")
    return value


def _texts(value: object) -> tuple[str, ...] | None:
    """The texts in a list; None for anything else."""
    texts = isinstance(value, list | tuple) and value and all(isinstance(each, str) for each in value)
    return tuple(value) if texts and isinstance(value, list | tuple) else None


def _modules(module: Record, prefix: str = "", depth: int = 0) -> Iterator[tuple[str, Record]]:
    """A module and those in it, with what their tensors' names start with."""
    if depth > MAX_DEPTH:
        raise ValueError("modules contain one another too deeply")
    yield prefix, module
    for name, inner in _dictionary(module.state.get("_modules", {})).items():
        if isinstance(inner, Record):
            yield from _modules(inner, f"{prefix}{name}.", depth + 1)


def _state(module: Record) -> Iterator[tuple[str, Any]]:
    """The tensors of a module, named as ``state_dict`` would."""
    for prefix, each in _modules(module):
        for kind in ("_parameters", "_buffers"):
            for name, tensor in _dictionary(each.state.get(kind, {})).items():
                yield f"{prefix}{name}", tensor


def _groups(module: Record) -> object:
    """``k`` of the only GroupSum in a module; None if there is not just one."""
    found = [each.state for _, each in _modules(module) if each.name.rpartition(".")[2] == "GroupSum"]
    return found[0].get("k") if len(found) == 1 else None


def _thresholds(thermometer: object) -> NDArray[np.float64] | None:
    if thermometer is None:
        return None
    if isinstance(thermometer, Record):
        thermometer = thermometer.state
    if isinstance(thermometer, dict):
        thermometer = thermometer["thresholds"]
    values = array_of(thermometer, "thermometer thresholds").astype(np.float64)
    if values.ndim not in (1, 2) or not values.size or not np.isfinite(values).all():
        raise ValueError(
            f"thermometer thresholds of shape {values.shape} are not finite numbers for each feature"
        )
    return values


def _scaler(scaler: object) -> dict[str, list[float]] | None:
    if scaler is None:
        return None
    state = scaler.state if isinstance(scaler, Record) else _dictionary(scaler)
    found = {}
    for name in ("mean", "scale"):
        value = state.get(name, state.get(f"{name}_"))
        numbers = np.asarray(value if isinstance(value, list) else array_of(value, f"the scaler's {name}"))
        found[name] = numbers.astype(np.float64).ravel().tolist()
    if not np.isfinite([*found["mean"], *found["scale"]]).all() or 0 in found["scale"]:
        raise ValueError("the scaler divides by 0, or its numbers are not finite")
    return found


def _layers(state: dict[str, Any]) -> Iterator[LutLayer]:
    found = sorted(
        (int(match["number"]), match["layer"]) for key in state if (match := TABLES.fullmatch(str(key)))
    )
    if not found or len({number for number, _ in found}) != len(found):
        raise ValueError("its tensors are not those of LUT layers, such as 0.luts")
    for _, layer in found:
        weights = _finite(state, f"{layer}.luts")
        if weights.ndim != 2 or weights.shape[1] < 2 or weights.shape[1] & (weights.shape[1] - 1):
            raise ValueError(f"{layer}.luts has shape {weights.shape}; it must be [nodes, power of two]")
        nodes, inputs = len(weights), int(weights.shape[1]).bit_length() - 1
        yield LutLayer(_mapping(state, layer, nodes, inputs), weights > 0)


def _mapping(state: dict[str, Any], layer: str, nodes: int, inputs: int) -> NDArray[np.int32]:
    # `_LUTLayer__dummy_mapping` has the shape of a mapping and is none.
    if f"{layer}.mapping.weights" in state:
        weights = _finite(state, f"{layer}.mapping.weights")
        if weights.ndim != 2 or weights.shape[1] != nodes * inputs or not len(weights):
            raise ValueError(
                f"{layer}.mapping.weights has shape {weights.shape}; there are {nodes * inputs} slots"
            )
        return np.asarray(weights.argmax(axis=0), dtype=np.int32).reshape(nodes, inputs)
    mapping = array_of(state[f"{layer}.mapping"], f"{layer}.mapping")
    if mapping.shape != (nodes, inputs) or mapping.dtype.kind not in "iu":
        raise ValueError(
            f"{layer}.mapping has shape {mapping.shape}; there are {nodes} nodes of {inputs} inputs"
        )
    if mapping.min() < 0 or mapping.max() >= 1 << 31:
        raise ValueError(f"{layer}.mapping reads inputs {mapping.min()} to {mapping.max()}")
    return mapping.astype(np.int32)


def _finite(state: dict[str, Any], key: str) -> NDArray[Any]:
    weights = array_of(state[key], key)
    if weights.dtype.kind != "f" or not np.isfinite(weights).all():
        raise ValueError(f"{key} holds numbers that are not finite")
    return weights


def _classes(source: Source, parts: _Parts, options: ImportOptions) -> tuple[str, ...]:
    count = parts.classes
    if count is None and parts.names is not None:
        count = len(parts.names)
    if options.classes is not None:
        if count not in (None, options.classes):
            raise InputError(
                "the checkpoint says otherwise", value=f"--classes {options.classes}, not {count}"
            )
        count = options.classes
    if count is None:
        raise InputError(
            "the checkpoint does not say how many classes its nodes vote for",
            value=source.path,
            hint="give their number with --classes",
        )
    if not 2 <= count <= 1 << 20:
        raise ValueError(f"there are {count} classes")
    if parts.names is not None and len(parts.names) == count:
        return parts.names
    return tuple(str(index) for index in range(count))


def _input_width(parts: _Parts) -> tuple[int, str]:
    """Input bits of the network, and what to note of its encoder."""
    first = min((key for key in parts.state if TABLES.fullmatch(str(key))), key=_number).removesuffix("luts")
    weights = parts.state.get(f"{first}mapping.weights")
    learned = len(array_of(weights, "mapping weights")) if weights is not None else None
    thresholds = parts.thresholds
    if thresholds is not None and thresholds.ndim == 2:
        if learned not in (None, thresholds.size):
            raise ValueError(f"the thermometer has {thresholds.size} bits; the network reads {learned}")
        return thresholds.size, ""
    if thresholds is not None:
        if learned is None or learned % len(thresholds):
            raise ValueError(
                "all features share the thresholds, and nothing says how many features there are"
            )
        return learned, ""
    note = "the file holds no thresholds: the model reads bits"
    if learned is None:
        learned = int(array_of(parts.state[f"{first}mapping"], "mapping").max()) + 1
        note += ", as many as its first layer names"
    return learned, note


def _number(key: str) -> int:
    match = TABLES.fullmatch(key)
    assert match is not None
    return int(match["number"])


def _thermometer(thresholds: NDArray[np.float64], width: int) -> Thermometer:
    rows = np.broadcast_to(thresholds, (width // thresholds.shape[-1], thresholds.shape[-1]))
    return Thermometer(tuple(tuple(row) for row in rows.tolist()), strict=True)


IMPORTER = Importer("dwn", "a DWN checkpoint (PyTorch)", recognises, read, options=frozenset({"classes"}))
