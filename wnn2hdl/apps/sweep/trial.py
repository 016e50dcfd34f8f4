"""One trial: train a mapping, judge it on the held-out pixels, map its table to LUTs."""

import functools
import hashlib
from collections.abc import Iterable
from dataclasses import asdict, dataclass, fields
from typing import Any, Literal, Self

import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.sweep.grid import Trial
from wnn2hdl.apps.sweep.pixels import CodeCounts, PixelSets, code_counts
from wnn2hdl.errors import Wnn2hdlError
from wnn2hdl.ir import LutNetwork, TruthTable, WisardModel, bits_to_codes
from wnn2hdl.lower.table import care_set, pixel_table
from wnn2hdl.minimise import map_luts
from wnn2hdl.training.budget import SATURATION
from wnn2hdl.wisard import choose_bleaching, draw_mapping, train_histogram

Status = Literal["valid", "saturated", "failed"]

EFFORT = 0
"""Of LUT mapping; more effort finds smaller circuits for the few that are built."""

_KEPT_TABLES = 1 << 12


@dataclass(frozen=True)
class Record:
    """The outcome of a trial: a row of the results.

    Attributes:
        name: as in `Trial`, like ``address_bits``, ``rams``, ``seed``, ``bits`` and ``care_minimum``.
        status: ``saturated`` trials are left out of any selection; a ``failed`` one has only an ``error``.
        bleaching: the threshold used.
        saturation: share of the addresses that fire, in the discriminator where it is highest.
        accuracy: share of the held-out pixels that the trained classifier gets right.
        circuit_accuracy: the same of the mapped circuit, which is free outside of the care set.
        luts: LUTs per pixel of the circuit.
        muxes: MUXF7 and MUXF8 beside them.
        levels: LUTs on the longest path.
        answers: digest of the classifier's answer to every code, to check a rebuilt one by.
        error: what went wrong, empty if nothing did.
    """

    name: str
    address_bits: int
    rams: int
    seed: int
    bits: tuple[str, ...]
    care_minimum: int | None
    status: Status
    bleaching: int | None = None
    saturation: float | None = None
    accuracy: float | None = None
    circuit_accuracy: float | None = None
    luts: int | None = None
    muxes: int | None = None
    levels: int | None = None
    answers: str = ""
    error: str = ""

    def to_json(self) -> dict[str, Any]:
        """A JSON object in the order of the attributes."""
        return asdict(self) | {"bits": ",".join(self.bits)}

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Self:
        """The inverse of `to_json`; raises KeyError or TypeError on anything else."""
        return cls(**{**data, "bits": tuple(data["bits"].split(","))})


COLUMNS = tuple(field.name for field in fields(Record))


def run_trials(sets: PixelSets, trials: Iterable[Trial]) -> list[Record]:
    """Run trials one after the other, in this process."""
    return [run_trial(sets, trial) for trial in trials]


def run_trial(sets: PixelSets, trial: Trial) -> Record:
    """Run a trial; whatever goes wrong in it becomes part of its record."""
    try:
        return _run(sets, trial)
    except Exception as error:  # a defect that one trial meets must not end a sweep of thousands
        return failed(trial, error)


def failed(trial: Trial, error: BaseException) -> Record:
    """The record of a trial that failed."""
    text = error.line() if isinstance(error, Wnn2hdlError) else f"{type(error).__name__}: {error}"
    return Record(
        trial.name,
        trial.address_bits,
        trial.rams,
        trial.seed,
        trial.bits,
        trial.care_minimum,
        "failed",
        error=" ".join(text.split()),
    )


def rebuild(sets: PixelSets, trial: Trial) -> WisardModel:
    """The model of a trial, exactly.

    Raises:
        InputError: n does not fit the number of bits.
    """
    counts = code_counts(sets, trial.bits)
    mapping = draw_mapping(counts.encoder.width, trial.rams, trial.address_bits, trial.seed)
    threshold = choose_bleaching(counts.training, mapping) if trial.bleaching is None else trial.bleaching
    training = {
        "trial": trial.name,
        "seed": trial.seed,
        "images": list(sets.training_images),
        "held_out_images": list(sets.held_out_images),
        "pixels": sets.pixels,
        "bleaching": "auto" if trial.bleaching is None else "given",
    }
    histogram = counts.training.sum(axis=0)
    return train_histogram(histogram, counts.encoder, sets.classes, mapping, threshold, training)


def table_and_network(sets: PixelSets, trial: Trial) -> tuple[TruthTable, LutNetwork]:
    """The truth table of a trial with its don't-cares, and the circuit that was costed.

    Raises:
        InputError: the trial cannot be trained, or no code occurs often enough to be cared for.
    """
    counts = code_counts(sets, trial.bits)
    table = _cared(counts, pixel_table(rebuild(sets, trial)), trial.care_minimum)
    return table, map_luts(table, effort=EFFORT).network


def _run(sets: PixelSets, trial: Trial) -> Record:
    counts = code_counts(sets, trial.bits)
    model = rebuild(sets, trial)
    answers = pixel_table(model)
    table = _cared(counts, answers, trial.care_minimum)
    care, values = np.packbits(table.care).tobytes(), np.packbits(table.values).tobytes()
    circuit = _mapped(table.inputs, table.outputs, care, values)
    saturation = float(model.saturation.mean(axis=1).max())
    return Record(
        name=trial.name,
        address_bits=trial.address_bits,
        rams=trial.rams,
        seed=trial.seed,
        bits=trial.bits,
        care_minimum=trial.care_minimum,
        status="saturated" if saturation > SATURATION else "valid",
        bleaching=model.bleaching,
        saturation=saturation,
        accuracy=_accuracy(counts, answers.values),
        circuit_accuracy=_accuracy(counts, circuit.values()),
        luts=circuit.luts,
        muxes=circuit.muxes,
        levels=circuit.levels,
        answers=answers_digest(answers),
    )


def _cared(counts: CodeCounts, table: TruthTable, care_minimum: int | None) -> TruthTable:
    """The table with its don't-cares at 0: tables are equal whenever they agree on what they care for."""
    if care_minimum is None:
        return table
    care = care_set(counts.imagery, care_minimum)
    return TruthTable(table.inputs, table.outputs, table.values & care[:, np.newaxis], care)


def _accuracy(counts: CodeCounts, values: NDArray[np.bool_]) -> float:
    """Share of the held-out pixels that a table puts into their class; one that does not exist is wrong."""
    answers = bits_to_codes(values)
    exists = np.flatnonzero(answers < len(counts.held_out))
    return int(counts.held_out[answers[exists], exists].sum()) / int(counts.held_out.sum())


def answers_digest(answers: TruthTable) -> str:
    """A digest of the answers to every code, as `pixel_table` gives them: 16 hexadecimal digits."""
    return hashlib.blake2b(np.packbits(answers.values).tobytes(), digest_size=8).hexdigest()


@dataclass(frozen=True)
class _Circuit:
    """What is kept of a mapped network: its figures, and its answers packed eight to a byte."""

    luts: int
    muxes: int
    levels: int
    packed: bytes
    shape: tuple[int, int]

    def values(self) -> NDArray[np.bool_]:
        """The answers, bool ``[2**width, outputs]``."""
        flags = np.unpackbits(np.frombuffer(self.packed, np.uint8), count=self.shape[0] * self.shape[1])
        return flags.reshape(self.shape).astype(np.bool_)


@functools.lru_cache(maxsize=_KEPT_TABLES)
def _mapped(inputs: tuple[str, ...], outputs: tuple[str, ...], care: bytes, values: bytes) -> _Circuit:
    """The circuit of a table, its flags packed eight to a byte; equal tables are mapped once per process."""
    size = 1 << len(inputs)
    flags = np.unpackbits(np.frombuffer(values, np.uint8), count=size * len(outputs)).astype(np.bool_)
    table = TruthTable(
        inputs,
        outputs,
        flags.reshape(size, len(outputs)),
        np.unpackbits(np.frombuffer(care, np.uint8), count=size).astype(np.bool_),
    )
    network = map_luts(table, effort=EFFORT).network
    answers = network.evaluate(np.arange(size))
    packed = np.packbits(answers).tobytes()
    return _Circuit(len(network.luts), len(network.muxes), network.depth, packed, answers.shape)
