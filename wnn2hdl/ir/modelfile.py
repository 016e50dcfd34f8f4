"""The model file: one JSON layout for every kind of model, checked against a schema, arrays packed."""

import base64
import binascii
import hashlib
import json
import math
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
from numpy.typing import NDArray

from wnn2hdl.errors import ModelFileError
from wnn2hdl.files import read_json

FORMAT = "wnn2hdl-model"
VERSION = 2

BESIDE_THE_ANSWERS = ("training", "origin", "colours")
"""Keys of a model file that decide no answer."""


def header(kind: str) -> dict[str, Any]:
    """What every model file starts with."""
    return {"format": FORMAT, "version": VERSION, "kind": kind}


def read_model_file(path: Path) -> dict[str, Any]:
    """The object in a model file, which fits the schema of its ``kind``.

    Raises:
        ModelFileError: the file is missing, damaged, of another version, or no model.
    """
    data = read_json(path, "a model")
    if data.get("format") != FORMAT:
        raise ModelFileError(
            "not a wnn2hdl model", value=f"{path} (format {data.get('format')!r})", hint="train or import one"
        )
    _check_version(data.get("version"), path)
    kind = data.get("kind")
    schemas = _schema()["$defs"]
    if not isinstance(kind, str) or f"{kind} model" not in schemas:
        known = ", ".join(name.removesuffix(" model") for name in schemas if name.endswith(" model"))
        raise ModelFileError(
            "no such kind of model", value=f"{path} (kind {kind!r})", hint=f"known are {known}"
        )
    worst = max(_validator(kind).iter_errors(data), key=jsonschema.exceptions.relevance, default=None)
    if worst is not None:
        error = _innermost(worst)
        where = "/".join(str(step) for step in error.absolute_path) or "the top level"
        # What is wrong stands behind the value, which may be long.
        text = error.message if len(error.message) <= 120 else f"{error.message[:60]} … {error.message[-60:]}"
        raise ModelFileError(
            "the model file is damaged", value=f"{path} (at {where}: {text})", hint="save it again"
        )
    return data


def _innermost(error: jsonschema.ValidationError) -> jsonschema.ValidationError:
    """Where none of several kinds fits, what is wrong by the kind that the object says it is."""
    others = {
        inner.schema_path[0]
        for inner in error.context
        if inner.validator == "const" and list(inner.path) == ["kind"]
    }
    inside = [inner for inner in error.context if inner.schema_path[0] not in others]
    return _innermost(max(inside, key=jsonschema.exceptions.relevance)) if inside else error


def contradicting(path: Path, error: Exception) -> ModelFileError:
    """The error for a file that fits its schema, and yet no model can be what it says."""
    return ModelFileError("the model contradicts itself", value=f"{path} ({str(error)[:160]})")


def answers_digest(data: dict[str, Any]) -> str:
    """SHA-256 of all in a model file that decides the model's answers, hexadecimal."""
    deciding = {key: value for key, value in data.items() if key not in BESIDE_THE_ANSWERS}
    return hashlib.sha256(json.dumps(deciding, sort_keys=True).encode()).hexdigest()


def pack(array: NDArray[Any]) -> dict[str, Any]:
    """An array as a JSON object: its shape, and its little-endian bytes in base64; bool as bits.

    Bits are packed eight per byte, the first in the byte's least significant bit.
    """
    if array.dtype == np.bool_:
        name, content = "bits", np.packbits(array, bitorder="little").tobytes()
    else:
        name, content = array.dtype.name, array.astype(array.dtype.newbyteorder("<")).tobytes()
    return {"type": name, "shape": list(array.shape), "base64": base64.b64encode(content).decode()}


def unpack(data: dict[str, Any], dtype: type[np.generic], dimensions: int) -> NDArray[Any]:
    """The array that `pack` wrote.

    Raises:
        ValueError: it has another type or number of dimensions, or its bytes do not fit its shape.
    """
    name = "bits" if dtype == np.bool_ else np.dtype(dtype).name
    shape = tuple(data["shape"])
    if data["type"] != name or len(shape) != dimensions:
        raise ValueError(f"an array of {data['type']} {list(shape)} is not {name} of {dimensions} dimensions")
    try:
        content = base64.b64decode(data["base64"], validate=True)
    except binascii.Error as error:
        raise ValueError(f"an array is not base64: {error}") from error
    size = math.prod(shape)
    expected = -(-size // 8) if dtype == np.bool_ else size * np.dtype(dtype).itemsize
    if len(content) != expected:
        raise ValueError(f"an array of {name} {list(shape)} takes {expected} bytes, not {len(content)}")
    if dtype == np.bool_:
        packed = np.frombuffer(content, dtype=np.uint8)
        return np.unpackbits(packed, count=size, bitorder="little").astype(np.bool_).reshape(shape)
    stored = np.frombuffer(content, dtype=np.dtype(dtype).newbyteorder("<"))
    return stored.astype(dtype).reshape(shape)


def _check_version(version: object, path: Path) -> None:
    if version == VERSION:
        return
    if not isinstance(version, int):
        raise ModelFileError("the model file is damaged", value=f"{path} (version {version!r})")
    other, hint = (
        ("a newer", "upgrade wnn2hdl") if version > VERSION else ("an older", "train or import it again")
    )
    raise ModelFileError(
        f"the model was saved by {other} wnn2hdl", value=f"{path} (version {version})", hint=hint
    )


@cache
def _schema() -> dict[str, Any]:
    text = files(__package__).joinpath("model.schema.json").read_text(encoding="utf-8")
    schema: dict[str, Any] = json.loads(text)
    return schema


@cache
def _validator(kind: str) -> jsonschema.Draft202012Validator:
    schema = {"$defs": _schema()["$defs"], "$ref": f"#/$defs/{kind} model"}
    return jsonschema.Draft202012Validator(schema)
