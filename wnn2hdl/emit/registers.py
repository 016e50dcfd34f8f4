"""Drivers for the registers of a core: a C header, and Python for PYNQ; and their table in Markdown."""

from collections.abc import Iterator

from wnn2hdl.ir.registers import Access, Field, Register, RegisterMap
from wnn2hdl.markdown import head, row

_ACCESS: dict[Access, str] = {
    "constant": "read",
    "status": "read",
    "setting": "read, write",
    "event": "read; 1 clears",
    "action": "1 acts",
}

_DRIVER = '''\
"""The registers of {ip}, a {core}.

`{kind}` works with all that has ``read(offset)`` and ``write(offset, value)`` of 32-bit words: the IP of a
PYNQ overlay, ``pynq.MMIO``, or an object of your own. Made of the same description as the hardware.
"""


class {kind}:
    """A {core}.

    Args:
        mmio: reads and writes words at offsets in bytes.

    Raises:
        RuntimeError: another core is there, or one of another model.
    """

    def __init__(self, mmio):
        self._mmio = mmio
        for name, value in {constants}:
            found = getattr(self, name)
            if found != value:
                raise RuntimeError("not this core: {{}} is {{:#x}}, not {{:#x}}".format(name, found, value))

    def _get(self, offset, low, width):
        return self._mmio.read(offset) >> low & (1 << width) - 1

    def _set(self, offset, low, width, value):
        value = int(value)
        if value >> width:
            raise ValueError("{{}} has no place in {{}} bits".format(value, width))
        others = self._mmio.read(offset) & ~((1 << width) - 1 << low)
        self._mmio.write(offset, others | value << low)
'''


def c_header(registers: RegisterMap, name: str, ip: str) -> str:
    """Offsets in bytes, masks, shifts and constants as macros that begin with the design's name.

    Args:
        registers: of the core.
        name: of the design.
        ip: of its module.
    """
    prefix = name.upper()
    lines = [
        f"/* The registers of {ip}, a {registers.core}: 32-bit words at offsets in bytes.",
        " * Made by wnn2hdl of the same description as the hardware. */",
        f"#ifndef {prefix}_REGISTERS_H",
        f"#define {prefix}_REGISTERS_H",
    ]
    for register in registers.registers:
        lines += ["", f"#define {prefix}_{register.name.upper()}_OFFSET 0x{register.offset:02x}u"]
        for field in register.fields:
            what = f"{prefix}_{register.signal(field).upper()}"
            lines += [
                f"/* {field.meaning}: {_ACCESS[field.access]}. */",
                f"#define {what}_MASK 0x{field.mask:08x}u",
                f"#define {what}_SHIFT {field.low}u",
            ]
            if field.access == "constant":
                lines.append(f"#define {what}_VALUE 0x{field.value:x}u")
    return "\n".join([*lines, "", "#endif", ""])


def python_driver(registers: RegisterMap, ip: str) -> str:
    """A module with one class and no imports: properties, and methods that clear or act.

    Args:
        registers: of the core.
        ip: the module of the core.
    """
    constants = [
        (register.signal(field), field.value) for register, field in registers if field.access == "constant"
    ]
    listed = "".join(f"            ({name!r}, 0x{value:x}),\n" for name, value in constants)
    text = _DRIVER.format(
        ip=ip, core=registers.core, kind=driver_class(registers), constants=f"(\n{listed}        )"
    )
    return text + "".join("\n" + "\n".join(_members(register, field)) for register, field in registers)


def driver_class(registers: RegisterMap) -> str:
    """The class of `python_driver`."""
    return "VideoCore" if registers.core.startswith("video") else "MatchEngine"


def _members(register: Register, field: Field) -> Iterator[str]:
    name = register.signal(field)
    place = f"0x{register.offset:02x}, {field.low}, {field.width}"
    if field.access == "action":
        yield from (
            f"    def {name}(self):",
            f'        """{field.meaning}."""',
            f"        self._set({place}, 1)",
            "",
        )
        return
    yield from (
        "    @property",
        f"    def {name}(self):",
        f'        """{field.meaning}."""',
        f"        return self._get({place})",
        "",
    )
    if field.access == "setting":
        yield from (
            f"    @{name}.setter",
            f"    def {name}(self, value):",
            f"        self._set({place}, value)",
            "",
        )
    if field.access == "event":
        yield from (
            f"    def clear_{name}(self):",
            f'        """Forget `{name}`."""',
            f"        self._mmio.write(0x{register.offset:02x}, 0x{field.mask:x})",
            "",
        )


def registers_table(registers: RegisterMap) -> str:
    """The registers as a table in Markdown; a constant that depends on a build is not in it."""
    lines = [head(["offset", "register", "bits", "field", "access", "meaning"])]
    for register, field in registers:
        bits = f"{field.low + field.width - 1}:{field.low}" if field.width > 1 else str(field.low)
        first = field is register.fields[0]
        lines.append(
            row(
                [
                    f"0x{register.offset:02x}" if first else "",
                    register.name if first else "",
                    bits,
                    field.name,
                    _ACCESS[field.access],
                    field.meaning,
                ]
            )
        )
    return "\n".join(lines) + "\n"
