"""Models of the 7-series cells that emitted Verilog uses, for simulators without the vendor's library."""

CELLS_FILE = "xilinx_cells_sim.v"
"""The file of the models: equal in all builds, so that a project adds it once, and to its simulation only."""


def cells_model() -> str:
    """Behavioural LUT1 … LUT6, LUT6_2, MUXF7 and MUXF8 (UG953), Verilog-2001."""
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
    modules.append(
        "module LUT6_2 #(parameter [63:0] INIT = 64'h0) (\n"
        "    output wire O5,\n    output wire O6,\n"
        + ",\n".join(f"    input  wire I{i}" for i in range(6))
        + "\n);\n    assign O5 = INIT[{1'b0, I4, I3, I2, I1, I0}];\n"
        "    assign O6 = INIT[{I5, I4, I3, I2, I1, I0}];\nendmodule\n"
    )
    pins = "    output wire O,\n    input  wire I0,\n    input  wire I1,\n    input  wire S"
    modules += [
        f"module {kind} (\n{pins}\n);\n    assign O = S ? I1 : I0;\nendmodule\n"
        for kind in ("MUXF7", "MUXF8")
    ]
    return "\n".join(
        [
            "// Models of 7-series cells, for simulators without the vendor's library. Not for synthesis:",
            "// add this file to the simulation sources alone, and once for all circuits of a project.",
            "/* verilator lint_off DECLFILENAME */",
            *modules,
        ]
    )
