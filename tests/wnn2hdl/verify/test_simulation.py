"""Simulation in Amaranth: what it accepts, finds and records."""

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.elaborate import CircuitComponent, component
from wnn2hdl.errors import CheckError, InputError
from wnn2hdl.ir import codes_to_bits
from wnn2hdl.ir.circuit import Circuit
from wnn2hdl.ir.nodes import Match
from wnn2hdl.ir.wires import Bits, Port, Slice
from wnn2hdl.verify.simulation import simulate

WIDTH = 3
REFERENCE, BITS = np.divmod(np.arange(64), 8)
INPUTS = {"bits": codes_to_bits(BITS, WIDTH), "reference_bits": codes_to_bits(REFERENCE, WIDTH)}
COUNTS = WIDTH - np.bitwise_count(BITS ^ REFERENCE)


def matcher() -> CircuitComponent:
    """In how many of three places two words agree."""
    bits, reference = Port("bits", WIDTH), Port("reference_bits", WIDTH)
    count = Match("agreement", bits.word, reference.word)
    return component(
        Circuit("match", "Counts.", (bits, reference), (count,), {"match_count": (Slice(count.name, 0, 2),)}),
        style="cells",
    )


def counts(values: NDArray[np.int64]) -> dict[str, Bits]:
    return {"match_count": codes_to_bits(values, 2)}


def test_agreement_is_counted_and_timed() -> None:
    result = simulate(matcher(), INPUTS, counts(COUNTS))
    assert result.vectors == 64
    assert result.vectors_per_second == 64 / result.seconds


def test_the_first_mismatch_is_shown() -> None:
    wrong = COUNTS.copy()
    wrong[[11, 40]] ^= 1
    with pytest.raises(CheckError) as caught:
        simulate(matcher(), INPUTS, counts(wrong))
    assert caught.value.line() == (
        "the circuit differs from the model at vector 11: match_count is 2'h2, the model says 2'h3, "
        "at bits = 3'h3, reference_bits = 3'h1"
    )


def test_progress_reaches_the_end() -> None:
    calls: list[tuple[int, int]] = []
    rows = np.resize(np.arange(64), 5000)
    simulate(
        matcher(),
        {port: bits[rows] for port, bits in INPUTS.items()},
        counts(COUNTS[rows]),
        progress=lambda done, total: calls.append((done, total)),
    )
    assert calls == [(2048, 5000), (4096, 5000), (5000, 5000)]


def test_waves_of_the_first_vectors_are_recorded(tmp_path: Path) -> None:
    path = tmp_path / "waves.vcd"
    simulate(matcher(), INPUTS, counts(COUNTS), vcd=path, vcd_vectors=5)
    text = path.read_text()
    assert "match_count" in text
    times = [int(line[1:]) for line in text.splitlines() if line.startswith("#")]
    assert times[:5] == [0, 10_000_000, 20_000_000, 30_000_000, 40_000_000]
    assert len(times) == 6


def test_a_mismatch_among_them_is_in_the_waves(tmp_path: Path) -> None:
    path = tmp_path / "waves.vcd"
    with pytest.raises(CheckError, match="vector 2"):
        simulate(matcher(), INPUTS, counts(np.where(np.arange(64) == 2, 3, COUNTS)), vcd=path)
    assert "#20000000" in path.read_text()


def test_a_folder_that_is_not_there_cannot_hold_waves(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot record the waves"):
        simulate(matcher(), INPUTS, counts(COUNTS), vcd=tmp_path / "absent" / "waves.vcd")
