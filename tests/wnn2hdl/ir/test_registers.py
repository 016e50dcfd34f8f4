"""Registers: no two in one place, no two of one name, and each with its meaning."""

import keyword

import pytest

from wnn2hdl.ir.engine import RESULT_WORDS, EngineFormat
from wnn2hdl.ir.identifiers import RESERVED
from wnn2hdl.ir.registers import (
    DATA_BITS,
    RESULT,
    RegisterMap,
    engine_registers,
    video_registers,
)

DIGEST = "0123456789abcdef" * 4
VIDEO = video_registers(DIGEST)
ENGINE = engine_registers(EngineFormat((4, 6), (9, 12), 4, 3), DIGEST)


@pytest.mark.parametrize("registers", [VIDEO, ENGINE])
def test_registers_follow_each_other_and_fields_do_not_overlap(registers: RegisterMap) -> None:
    offsets = [register.offset for register in registers.registers]
    assert offsets == [4 * place for place in range(len(offsets))]
    for register in registers.registers:
        taken = 0
        for field in register.fields:
            assert not taken & field.mask
            assert taken < field.mask
            assert field.low + field.width <= DATA_BITS
            assert field.value >> field.width == 0
            taken |= field.mask
    names = [register.signal(field) for register, field in registers]
    assert len(set(names)) == len(names)
    assert not RESERVED & set(names)
    assert not any(map(keyword.iskeyword, names))


@pytest.mark.parametrize("registers", [VIDEO, ENGINE])
def test_each_event_can_interrupt(registers: RegisterMap) -> None:
    events, settings = registers.register("interrupt"), registers.register("interrupt_enable")
    assert [(field.name, field.low) for field in events.fields] == [
        (field.name, field.low) for field in settings.fields
    ]


def test_constants_name_the_model_and_the_sizes() -> None:
    (model,) = VIDEO.register("model").fields
    assert model.value == 0x01234567
    assert [field.value for field in ENGINE.register("segment").fields] == [9, 12]
    assert not ENGINE.register("segment").writable
    assert VIDEO.register("height").writable


def test_results_are_in_the_order_of_the_words_of_an_answer() -> None:
    offsets = [ENGINE.register(name).offset for name in RESULT]
    assert offsets == [offsets[0] + 4 * word for word in range(RESULT_WORDS)]
