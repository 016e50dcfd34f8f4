"""What may stand in Verilog as it is: names of nets, and comments that are not commands to a tool."""

import re

from wnn2hdl.ir.identifiers import RESERVED

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*", re.ASCII)
_LONGEST = 200
_COMMANDS = frozenset(
    {"altera", "ambit", "cadence", "exemplar", "intel", "lint_off", "lint_on", "pragma", "quartus"}
    | {"rtl_synthesis", "synopsys", "synthesis", "translate_off", "translate_on", "vcs", "verilator"}
    | {"vivado", "xilinx"}
)
"""Words with which a comment speaks to a tool, as in ``// synthesis translate_off``."""


def check_identifier(name: object) -> None:
    """Raise ValueError unless a name of a port, a node or a net can stand in any HDL as it is."""
    plain = isinstance(name, str) and _NAME.fullmatch(name) and "__" not in name and name[-1] != "_"
    if not isinstance(name, str) or not plain or len(name) > _LONGEST:
        raise ValueError(
            f"{name!r:.80} is not a name: use letters, digits and single underscores, a letter first"
        )
    if name.lower() in RESERVED:
        raise ValueError(f"the name {name} is a reserved word of an HDL or of C++")


def check_comment(line: object) -> None:
    """Raise ValueError unless a text is one line of a comment, whatever tool reads it, and no command to one.

    Tools differ in which characters end a line, in whether a backslash joins it to the next one, and in the
    words that they obey inside a comment.
    """
    if not isinstance(line, str) or not (line.isascii() and line.isprintable()) or line.endswith("\\"):
        raise ValueError(f"{line!r:.80} is not a line of a comment")
    if not _COMMANDS.isdisjoint(re.findall(r"\w+", line.lower())[:1]):
        raise ValueError(f"the comment {line!r:.80} is a command to a tool")
