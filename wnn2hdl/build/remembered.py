"""Simulations and proofs that passed before, by the hash of all that they depend on.

What passed once is not done again while its circuit, what it was compared with, the tools and this program's
own code are the same to the byte. Only success is remembered, and `wnn2hdl verify` does not look here.
"""

import functools
import hashlib
import json
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

import hdl_templates
import wnn2hdl
from wnn2hdl.ir import Style, VideoFormat
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.circuit_file import circuit_to_json
from wnn2hdl.synth import cache
from wnn2hdl.tools import abc_version, find_yosys
from wnn2hdl.verify.equivalence import Circuit as Module

Key = Mapping[str, str]
Arrays = Mapping[str, NDArray[Any]]

_PASSED = {"passed": True}


@functools.cache
def code_digest() -> str:
    """The SHA-256 of this program's code: what another state of it found counts for nothing."""
    digest = hashlib.sha256()
    for package in (wnn2hdl, hdl_templates):
        root = Path(str(package.__file__)).parent
        for path in sorted(root.rglob("*.py")):
            content = path.read_bytes()
            digest.update(f"{path.relative_to(root.parent).as_posix()} {len(content)}\n".encode())
            digest.update(content)
    return digest.hexdigest()


def simulation_key(
    circuit: Circuit, style: Style, inputs: Arrays, answers: Arrays, video: VideoFormat | None = None
) -> Key:
    """All that a simulation depends on: the circuit and what draws it, vectors and answers, the simulator."""
    return {
        "check": "simulation",
        "circuit": cache.digest(json.dumps(circuit_to_json(circuit))),
        "style": style,
        "video": "" if video is None else json.dumps(video.to_json()),
        "inputs": _digest(inputs),
        "answers": _digest(answers),
        "simulator": version("amaranth"),
        "code": code_digest(),
    }


def proof_key(left: Module, right: Module) -> Key:
    """All that a proof of equality depends on: both modules with all their sources, the method, the tools."""
    yosys = find_yosys()
    return {
        "check": "proof",
        "left": _module_digest(left),
        "right": _module_digest(right),
        "Yosys": f"{yosys.name} {yosys.version}",
        "ABC": abc_version(),
        "code": code_digest(),
    }


def passed(key: Key) -> bool:
    """Whether a check of this key has passed."""
    return cache.load(key["check"], key) == _PASSED


def remember(key: Key) -> None:
    """Note that the check of this key has passed."""
    cache.store(key["check"], key, _PASSED)


def _module_digest(module: Module) -> str:
    digest = hashlib.sha256(f"{module.top} {module.latency}".encode())
    for text in module.sources:
        digest.update(hashlib.sha256(text.encode()).digest())
    return digest.hexdigest()


def _digest(samples: Arrays) -> str:
    digest = hashlib.sha256()
    for port, bits in samples.items():
        digest.update(f"{port} {bits.shape}".encode())
        digest.update(bits.tobytes())
    return digest.hexdigest()
