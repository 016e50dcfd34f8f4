"""What may stand in Verilog: names, and lines of comments that no tool takes for a command."""

import re
from importlib.resources import files

from wnn2hdl.errors import InputError

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*", re.ASCII)
_LONGEST = 60
_LONGEST_NET = 200
_COMMANDS = frozenset(
    {"altera", "ambit", "cadence", "exemplar", "intel", "lint_off", "lint_on", "pragma", "quartus"}
    | {"rtl_synthesis", "synopsys", "synthesis", "translate_off", "translate_on", "vcs", "verilator"}
    | {"vivado", "xilinx"}
)
"""Words with which a comment speaks to a tool, as in ``// synthesis translate_off``."""

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
        InputError: it is no identifier of Verilog and VHDL alike, or too long.
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


def check_identifier(name: object) -> None:
    """Raise ValueError unless a name of a port, a node or a net can stand in any HDL as it is."""
    if not isinstance(name, str) or not _NAME.fullmatch(name) or len(name) > _LONGEST_NET:
        raise ValueError(
            f"{name!r} is no name: letters, digits and underscores, a letter first"[:_LONGEST_NET]
        )
    if name.lower() in RESERVED:
        raise ValueError(f"the name {name} is a reserved word of an HDL or of C++")


def check_comment(line: object) -> None:
    """Raise ValueError unless a text is one line of a comment, whatever tool reads it, and no command to one.

    Tools differ in which characters end a line, in whether a backslash joins it to the next one, and in the
    words that they obey inside a comment.
    """
    if not isinstance(line, str) or not (line.isascii() and line.isprintable()) or line.endswith("\\"):
        raise ValueError(f"{line!r:.80} is no line of a comment")
    if not _COMMANDS.isdisjoint(re.findall(r"\w+", line.lower())[:1]):
        raise ValueError(f"the comment {line!r:.80} is a command to a tool")
