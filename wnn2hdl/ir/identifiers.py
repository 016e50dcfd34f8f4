"""Names of Verilog modules: what is one, and which words HDLs and C++ reserve."""

import re
from importlib.resources import files

from wnn2hdl.errors import InputError

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*", re.ASCII)
_LONGEST = 60

RESERVED = frozenset(
    word
    for line in files(__package__).joinpath("reserved_words.txt").read_text(encoding="utf-8").splitlines()
    if not line.startswith("#")
    for word in line.split()
)
"""Words of SystemVerilog, VHDL and C++; VHDL's are reserved in any case."""


def require_name(name: str) -> str:
    """A name that modules can begin with, as it was given.

    Raises:
        InputError: it is not an identifier of Verilog and VHDL alike, or too long.
    """
    plain = _NAME.fullmatch(name) and "__" not in name and not name.endswith("_")
    if not plain or len(name) > _LONGEST:
        raise InputError(
            "not a name that Verilog modules can begin with",
            value=repr(name if len(name) <= _LONGEST else name[:_LONGEST] + "…"),
            hint=f"use letters, digits and single underscores, a letter first, {_LONGEST} at most",
        )
    return name


def require_unreserved(module: str) -> None:
    """Raise InputError if a whole name, such as ``first_match``, is a reserved word."""
    if module.lower() in RESERVED:
        raise InputError(
            "a module would be called like a reserved word", value=module, hint="choose another --name"
        )


def name_from(text: str) -> str:
    """A name made from any text, such as that of a folder: other characters become underscores."""
    joined = "_".join(part for part in re.split(r"[^A-Za-z0-9]+", text) if part)[:_LONGEST].rstrip("_")
    if not joined or not joined[0].isalpha():
        joined = f"wnn_{joined}".rstrip("_")[:_LONGEST]
    return joined
