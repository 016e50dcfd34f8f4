"""Simulations that passed before, by the hash of all that they depend on.

The matcher depends on no model: it is the same in every build, and its 2**18 vectors take most of the time of
all simulations. What passed once is not simulated again while its circuit, its vectors and the simulator are
the same to the byte. `wnn2hdl verify` does not look here.
"""

import hashlib
from collections.abc import Mapping
from importlib.metadata import version

from amaranth.back import rtlil
from amaranth.hdl import ClockDomain

from wnn2hdl.build.design import Design
from wnn2hdl.elaborate import component
from wnn2hdl.ir.wires import Bits
from wnn2hdl.synth import cache

_KIND = "simulations"
_PASSED = {"passed": True}


def simulation_key(design: Design, part: str) -> dict[str, str]:
    """All that the simulation of a circuit depends on: its RTLIL, its vectors, the simulator."""
    claim = design.specification.claims[part]
    assert claim.stimulus is not None
    inputs = claim.stimulus()
    text = rtlil.convert(
        component(design.parts[part], style=design.style),
        emit_src=False,
        missing_domain=lambda domain: ClockDomain(domain, reset_less=True),
    )
    return {
        "circuit": cache.digest(text),
        "inputs": _digest(inputs),
        "answers": _digest(claim.answers(inputs)),
        "simulator": version("amaranth"),
    }


def passed(key: Mapping[str, str]) -> bool:
    """Whether a simulation of this key has passed."""
    return cache.load(_KIND, key) == _PASSED


def remember(key: Mapping[str, str]) -> None:
    """Note that the simulation of this key has passed."""
    cache.store(_KIND, key, _PASSED)


def _digest(samples: Mapping[str, Bits]) -> str:
    digest = hashlib.sha256()
    for port, bits in samples.items():
        digest.update(f"{port} {bits.shape}".encode())
        digest.update(bits.tobytes())
    return digest.hexdigest()
