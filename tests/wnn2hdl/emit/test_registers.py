"""Drivers of registers: what C and Python say of them is what the description says."""

import shutil
from pathlib import Path
from typing import Any

import pytest

from wnn2hdl.emit.registers import c_header, driver_class, python_driver, registers_table
from wnn2hdl.ir.engine import EngineFormat
from wnn2hdl.ir.registers import RegisterMap, engine_registers, video_registers
from wnn2hdl.tools import run

DIGEST = "0123456789abcdef" * 4
VIDEO = video_registers(DIGEST)
ENGINE = engine_registers(EngineFormat((4, 6), (9, 12), 4, 3), DIGEST)
MAPS = [VIDEO, ENGINE]


class Memory:
    """Registers that keep what is written, and know their constants."""

    def __init__(self, registers: RegisterMap) -> None:
        self.words = {register.offset: 0 for register in registers.registers}
        for register, field in registers:
            if field.access == "constant":
                self.words[register.offset] |= field.value << field.low
        self.written: list[tuple[int, int]] = []

    def read(self, offset: int) -> int:
        return self.words[offset]

    def write(self, offset: int, value: int) -> None:
        self.words[offset] = value
        self.written.append((offset, value))


def driver(registers: RegisterMap, memory: Memory) -> Any:
    names: dict[str, Any] = {}
    exec(python_driver(registers, "mine_ip"), names)
    return names[driver_class(registers)](memory)


@pytest.mark.parametrize("registers", MAPS)
def test_each_field_is_read_where_it_is(registers: RegisterMap) -> None:
    memory = Memory(registers)
    core = driver(registers, memory)
    for register, field in registers:
        memory.words[register.offset] = field.mask
        if field.access != "action":
            assert getattr(core, register.signal(field)) == (1 << field.width) - 1
        memory.words[register.offset] = ~field.mask & 0xFFFFFFFF
        if field.access != "action":
            assert getattr(core, register.signal(field)) == 0


def test_a_setting_leaves_its_neighbours_and_has_to_fit() -> None:
    memory = Memory(VIDEO)
    core = driver(VIDEO, memory)
    core.interrupt_enable_malformed = 1
    core.interrupt_enable_frame = 1
    assert memory.words[VIDEO.register("interrupt_enable").offset] == 3
    core.height = 4095
    for wrong in (4096, -1):
        with pytest.raises(ValueError, match="no place in 12 bits"):
            core.height = wrong
    with pytest.raises(AttributeError):
        core.width = 3


def test_clearing_an_event_leaves_the_others_and_a_reset_the_settings() -> None:
    memory = Memory(VIDEO)
    core = driver(VIDEO, memory)
    memory.words[VIDEO.register("interrupt").offset] = 3
    core.clear_interrupt_malformed()
    assert memory.written == [(VIDEO.register("interrupt").offset, 2)]
    core.control_enable = 1
    core.control_reset()
    assert memory.written[-1] == (VIDEO.register("control").offset, 3)


@pytest.mark.parametrize("name", ["version_kind", "model"])
def test_another_core_is_refused(name: str) -> None:
    memory = Memory(VIDEO)
    for register, field in VIDEO:
        if register.signal(field) == name:
            memory.words[register.offset] ^= 1 << field.low
    with pytest.raises(RuntimeError, match=f"not this core: {name}"):
        driver(VIDEO, memory)


@pytest.mark.skipif(shutil.which("cc") is None, reason="needs a C compiler")
@pytest.mark.parametrize("registers", MAPS)
def test_the_header_compiles_and_has_the_numbers_of_the_description(
    registers: RegisterMap, tmp_path: Path
) -> None:
    (tmp_path / "core_registers.h").write_text(c_header(registers, "core", "core_ip"))
    lines = ["#include <stdio.h>", '#include "core_registers.h"', "int main(void) {"]
    expected = []
    for register, field in registers:
        what = f"CORE_{register.signal(field).upper()}"
        lines.append(
            f'    printf("%x %x %u\\n", CORE_{register.name.upper()}_OFFSET, {what}_MASK, {what}_SHIFT);'
        )
        expected.append(f"{register.offset:x} {field.mask:x} {field.low}\n")
        if field.access == "constant":
            lines.append(f'    printf("%x\\n", {what}_VALUE);')
            expected.append(f"{field.value:x}\n")
    (tmp_path / "main.c").write_text("\n".join([*lines, "    return 0;", "}", ""]))
    strict = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic"]
    run(["cc", *strict, "-o", "main", "main.c"], cwd=tmp_path, timeout=60)
    assert run([tmp_path / "main"], timeout=60).output == "".join(expected)


@pytest.mark.parametrize(("page", "registers"), [("video.md", VIDEO), ("match-engine.md", ENGINE)])
def test_the_tables_in_the_documentation_are_those_of_the_description(
    page: str, registers: RegisterMap
) -> None:
    text = (Path(__file__).parents[3] / "docs" / page).read_text()
    assert registers_table(registers) in text
