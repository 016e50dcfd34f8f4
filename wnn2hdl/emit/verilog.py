"""An Amaranth component as one readable Verilog-2001 file."""

import re
from collections.abc import Mapping, Sequence

from amaranth.back import verilog as back_end
from amaranth.hdl import Fragment
from amaranth.lib.wiring import Component

from hdl_templates.hierarchy import Emission, Part
from hdl_templates.vectors import port_widths
from wnn2hdl.emit.netlist import parse, write
from wnn2hdl.emit.tidy import UNUSED, tidy

LINT = """\
// Several modules share this file, and C++ has a word for the port called `reference`.
/* verilator lint_off DECLFILENAME */
/* verilator lint_off SYMRSVDWORD */
"""
"""What ``verilator -Wall`` remarks on although it is meant so."""

_DECIMAL = re.compile(r"\b(32)'d(\d+)")


def verilog(component: Component, *, name: str, header: Sequence[str]) -> str:
    """The Verilog of a combinational component and of the parts inside it.

    Args:
        component: what to write.
        name: name of its module.
        header: lines of the comment at the top of the file. The text depends on them and the component only.

    Returns:
        Verilog-2001: the parts first, each once, the component last; ports in the order of declaration.

    Raises:
        NotImplementedError: the component holds state.
    """
    emission = Emission()
    Fragment.get(component, emission)
    modules = [_module(part, module_name, emission.parts) for module_name, part in emission.parts.items()]
    modules.append(_module(component, name, emission.parts))
    comment = "".join(f"// {line}".rstrip() + "\n" for line in header)
    return "\n".join([comment + LINT, *modules])


def vendor_cells_model() -> str:
    """Behavioural LUT1 … LUT6, MUXF7 and MUXF8, for simulators without the vendor's library.

    Synthesisers skip the modules and take their own primitives: Yosys defines ``SYNTHESIS``, and Vivado
    honours ``translate_off``.
    """
    modules = []
    for inputs in range(1, 7):
        names = [f"I{i}" for i in range(inputs)]
        size = 1 << inputs
        address = names[0] if inputs == 1 else f"{{{', '.join(reversed(names))}}}"
        modules.append(
            f"module LUT{inputs} #(parameter [{size - 1}:0] INIT = {size}'h0) (\n"
            f"    output wire O,\n" + ",\n".join(f"    input  wire {pin}" for pin in names) + "\n);\n"
            f"    assign O = INIT[{address}];\nendmodule\n"
        )
    pins = "    output wire O,\n    input  wire I0,\n    input  wire I1,\n    input  wire S"
    modules += [
        f"module {kind} (\n{pins}\n);\n    assign O = S ? I1 : I0;\nendmodule\n"
        for kind in ("MUXF7", "MUXF8")
    ]
    return "\n".join(
        [
            "// Models of the 7-series cells, for simulation only.",
            "/* verilator lint_off DECLFILENAME */",
            "// synthesis translate_off",
            "`ifndef SYNTHESIS",
            *modules,
            "`endif",
            "// synthesis translate_on\n",
        ]
    )


def _module(component: Component, name: str, parts: Mapping[str, Part]) -> str:
    text = back_end.convert(
        component, name=name, platform=Emission(), emit_src=False, strip_internal_attrs=True
    )
    # Contents of 32 bits are written as decimal numbers, all others in hexadecimal.
    text = _DECIMAL.sub(lambda match: f"{match[1]}'h{int(match[2]):08x}", text)
    ports = {module: port_widths(part) for module, part in parts.items()}
    netlist = parse(text, *port_widths(component), ports)
    tidy(netlist)
    first_line = (type(component).__doc__ or "").partition("\n")[0]
    comment = f"// {first_line}\n" if first_line else ""
    keep = isinstance(component, Part) and component.keep_hierarchy
    attribute = '(* keep_hierarchy = "yes" *)\n' if keep else ""
    return comment + attribute + write(netlist, name, last={UNUSED})
