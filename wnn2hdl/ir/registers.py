"""The registers of a core: the one description of which hardware, drivers and tables are made.

Register generators were tried first. The SystemVerilog of PeakRDL-regblock 1.3 is refused by Yosys and by
Icarus, the driver of PeakRDL-python 4.0 is a package of 11,000 lines, and amaranth-soc has neither AXI nor
answers that are errors. What is left, a C header, would need a second language and its compiler in between.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from wnn2hdl.ir.engine import EngineFormat
from wnn2hdl.ir.video import HEIGHT_BITS, WIDTH_BITS

Access = Literal["constant", "status", "setting", "event", "action"]
"""``constant``: read only, known at build time. ``status``: read only. ``setting``: read and written.
``event``: set by the core, cleared by writing 1. ``action``: acts when 1 is written, reads as 0."""

ADDRESS_BITS = 12
"""Bits of an address in bytes: the least range that a master can be given is 4 KB."""

DATA_BITS = 32
"""Bits of a register."""

COUNT_BITS = 16
"""Bits of the counters of what is malformed."""

MAP_VERSION = 1
"""Of both maps below; it rises when a register changes its meaning or goes away."""


@dataclass(frozen=True)
class Field:
    """Bits of a register.

    Attributes:
        name: in lower case.
        low: the lowest bit.
        width: how many bits.
        access: what reading and writing do.
        meaning: a sentence without its stop.
        value: of a constant; of a setting the value after a reset.
    """

    name: str
    low: int
    width: int
    access: Access
    meaning: str
    value: int = 0

    @property
    def mask(self) -> int:
        """Its bits in the register."""
        return (1 << self.width) - 1 << self.low


@dataclass(frozen=True)
class Register:
    """A word of 32 bits.

    Attributes:
        name: in lower case.
        offset: its address in bytes, a multiple of 4.
        fields: from the lowest bit on; bits between them read as 0, and what is written there is ignored.
    """

    name: str
    offset: int
    fields: tuple[Field, ...]

    @property
    def writable(self) -> bool:
        """Whether it can be written; otherwise writing it is an error."""
        return any(field.access in ("setting", "event", "action") for field in self.fields)

    def signal(self, field: Field) -> str:
        """The name of a field in the hardware and in drivers."""
        return self.name if field.name == self.name else f"{self.name}_{field.name}"


@dataclass(frozen=True)
class RegisterMap:
    """All registers of a core.

    Attributes:
        core: what the core is, in words.
        registers: from the lowest address on; all other addresses are errors.
    """

    core: str
    registers: tuple[Register, ...]

    def __iter__(self) -> Iterator[tuple[Register, Field]]:
        """All fields with their registers."""
        return ((register, field) for register in self.registers for field in register.fields)

    def register(self, name: str) -> Register:
        """The register of a name; raises KeyError if there is none."""
        return {register.name: register for register in self.registers}[name]


def video_registers(digest: str) -> RegisterMap:
    """The registers of a video core.

    Args:
        digest: of the model, in hexadecimal.
    """
    common = _common(
        kind=1,
        digest=digest,
        enable="Whether the next frame is taken in; one that has begun is finished",
        frame=("frame", "The last answer of a frame was taken"),
        malformed="A malformed frame came",
        status=(_flag("running", 0, "status", "Whether a frame has begun and is not answered yet"),),
    )
    own = (
        _word("height", "setting", "Lines of a frame, 0 for 4096; used from the next frame on", HEIGHT_BITS),
        _word("width", "status", "Pixels of a line of the frame that came last, in whole beats", WIDTH_BITS),
        _word("frames", "status", "Frames that were answered since a reset, modulo 2^32"),
        _word(
            "malformed",
            "status",
            "Frames since a reset with fewer lines than height, or of unequal ones, modulo 2^16",
            COUNT_BITS,
        ),
    )
    return RegisterMap("video core", _placed(*common, *own))


def engine_registers(engine: EngineFormat, digest: str) -> RegisterMap:
    """The registers of a match engine.

    Args:
        engine: its sizes.
        digest: of the model, in hexadecimal.
    """
    common = _common(
        kind=2,
        digest=digest,
        enable="Whether the next template is taken in; one that has begun is finished",
        frame=("match", "A match has ended; its result stays, and the next one waits, until this is cleared"),
        malformed="A template or a segment of another size came",
        status=(
            _flag("running", 0, "status", "Whether a template is complete and has no result yet"),
            _flag("segment", 1, "status", "Whether a segment has come since a reset"),
        ),
    )
    second_score = (
        Field("second_score", 0, 31, "status", "Pixels that agree at the second best position"),
        _flag("none", 31, "status", "Whether there is no second best position"),
    )
    own = (
        _pair("template", "constant", "{} of a template", engine.template),
        _pair("segment", "constant", "{} of a segment", engine.segment),
        _word("results", "status", "Matches that have ended since a reset, modulo 2^32"),
        _word(
            "malformed",
            "status",
            "Templates and segments of another size since a reset, modulo 2^16",
            COUNT_BITS,
        ),
        _pair("best", "status", "{} of the best position"),
        _word("score", "status", "Pixels that agree at the best position"),
        _pair("second", "status", "{} of the second best position"),
        Register("second_score", 0, second_score),
        _word("total_low", "status", "Sum of the scores of all positions, low word"),
        _word("total_high", "status", "Its high word"),
        _word("squares_low", "status", "Sum of the squares of these scores, low word"),
        _word("squares_high", "status", "Its high word"),
    )
    return RegisterMap("match engine", _placed(*common, *own))


RESULT = ("best", "score", "second", "second_score", "total_low", "total_high", "squares_low", "squares_high")
"""The registers of a match engine that are the words of `wnn2hdl.ir.engine.EngineAnswer`, in their order."""


def _common(
    *, kind: int, digest: str, enable: str, frame: tuple[str, str], malformed: str, status: tuple[Field, ...]
) -> tuple[Register, ...]:
    """The registers that all cores have; ``frame`` is the event at the end of one, and what it means."""
    version = (
        Field("version", 0, 16, "constant", "Version of this table", MAP_VERSION),
        Field("kind", 16, 16, "constant", "1 for video cores, 2 for match engines", kind),
    )
    control = (
        _flag("enable", 0, "setting", enable),
        _flag("reset", 1, "action", "Forget what was taken in, and the counts; settings stay"),
    )
    name, ends = frame
    return (
        Register("version", 0, version),
        _word("model", "constant", "First 32 bits of the SHA-256 of the model", value=int(digest[:8], 16)),
        Register("control", 0, control),
        Register(
            "interrupt_enable",
            0,
            (
                _flag(name, 0, "setting", f"Whether interrupt.{name} drives irq"),
                _flag("malformed", 1, "setting", "Whether interrupt.malformed drives irq"),
            ),
        ),
        Register("interrupt", 0, (_flag(name, 0, "event", ends), _flag("malformed", 1, "event", malformed))),
        Register("status", 0, status),
    )


def _placed(*registers: Register) -> tuple[Register, ...]:
    """The registers one after the other."""
    return tuple(
        Register(register.name, DATA_BITS // 8 * place, register.fields)
        for place, register in enumerate(registers)
    )


def _word(name: str, access: Access, meaning: str, width: int = DATA_BITS, value: int = 0) -> Register:
    """A register of one field."""
    return Register(name, 0, (Field(name, 0, width, access, meaning, value),))


def _pair(name: str, access: Access, meaning: str, values: tuple[int, int] = (0, 0)) -> Register:
    """A register of a row in the low half and a column in the high half, or of how many there are."""
    many = "s" if access == "constant" else ""
    halves = zip(("row", "column"), (0, 16), values, strict=True)
    return Register(
        name,
        0,
        tuple(
            Field(half + many, low, 16, access, meaning.format(f"{half.capitalize()}{many}"), value)
            for half, low, value in halves
        ),
    )


def _flag(name: str, low: int, access: Access, meaning: str) -> Field:
    return Field(name, low, 1, access, meaning)
