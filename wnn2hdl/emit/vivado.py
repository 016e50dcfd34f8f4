"""Tcl for Vivado: synthesis and implementation out of context, packaging as an IP, a block design on a Zynq.

The commands are those of AMD UG835 (Tcl), UG1118 (packager) and UG994 (IP Integrator). Each script finds its
files beside itself, so that the folder can be moved; what Vivado makes goes into folders there.
"""

from collections.abc import Mapping

from wnn2hdl.emit.vivado_board import block_design
from wnn2hdl.ir.registers import ADDRESS_BITS, DATA_BITS, Access, RegisterMap
from wnn2hdl.synth.harness import Ports

PART = "xc7z020clg484-1"

IMPLEMENT = "implement.tcl"
PACKAGE = "package_ip.tcl"
BLOCK_DESIGN = "block_design.tcl"
CONSTRAINTS = "out_of_context.xdc"
UTILISATION = "utilization.rpt"
TIMING = "timing.rpt"

VENDOR, LIBRARY, VERSION = "wnn2hdl", "user", "1.0"

_HERE = "set here [file dirname [file normalize [info script]]]\n"

_COMMON = {"here": _HERE, "part": PART, "vendor": VENDOR, "library": LIBRARY, "version": VERSION}

_IMPLEMENT = """\
# Synthesis and implementation of {top} out of context: no pads, nothing around it.
{here}\
read_verilog [list {sources}]
read_xdc -mode out_of_context [file join $here {constraints}]
synth_design -top {top} -part {part} -mode out_of_context
opt_design
place_design
route_design
report_utilization -file [file join $here {utilisation}]
report_timing_summary -delay_type min_max -file [file join $here {timing}]
write_checkpoint -force [file join $here {top}.dcp]
"""

_PACKAGE = """\
# {top} as an IP for Vivado's catalogue, in the folder ip.
{here}\
create_project -force packaging [file join $here packaging] -part {part}
add_files -norecurse [file join $here {source}]
set_property top {top} [current_fileset]
update_compile_order -fileset sources_1
ipx::package_project -root_dir [file join $here ip] -vendor {vendor} -library {library} -taxonomy /UserIP \\
    -import_files -set_current true -force
set core [ipx::current_core]
set_property name {top} $core
set_property version {version} $core
set_property display_name {{{top}}} $core
set_property description {{Made by wnn2hdl: proved equal to its model}} $core
set_property supported_families {{zynq Production artix7 Production kintex7 Production}} $core
{registers}\
ipx::create_xgui_files $core
ipx::update_checksums $core
ipx::check_integrity $core
ipx::save_core $core
close_project
"""

_REGISTERS = """\
# Its registers, for the address editor and for software.
ipx::remove_all_memory_map $core
set map [ipx::add_memory_map s_axi_control $core]
set_property slave_memory_map_ref s_axi_control [ipx::get_bus_interfaces s_axi_control -of_objects $core]
set block [ipx::add_address_block reg0 $map]
set_property usage register $block
set_property range {range} $block
set_property width {width} $block
set registers {{
{listed}\
}}
foreach {{name offset access fields}} $registers {{
    set register [ipx::add_register $name $block]
    set_property address_offset $offset $register
    set_property size {width} $register
    set_property access $access $register
    foreach {{name low width access write meaning}} $fields {{
        set field [ipx::add_field $name $register]
        set_property bit_offset $low $field
        set_property bit_width $width $field
        set_property access $access $field
        set_property modified_write_value $write $field
        set_property description $meaning $field
    }}
}}
"""

_ACCESS: dict[Access, str] = {
    "constant": "read-only modify",
    "status": "read-only modify",
    "setting": "read-write modify",
    "event": "read-write oneToClear",
    "action": "write-only modify",
}
"""Access and modified write value (IEEE 1685)."""


def circuit_scripts(top: str, *, source: str, harness: str, megahertz: float) -> Mapping[str, str]:
    """The scripts for a circuit without streams by the names of their files.

    Args:
        top: the circuit's module.
        source: the file that holds it.
        harness: the module, and without its suffix the file, that puts registers around it to implement it.
        megahertz: the clock that is asked for.
    """
    return {
        **_implementation(harness, [source, f"{harness}.v"], "clk", megahertz),
        PACKAGE: _PACKAGE.format(**_COMMON, top=top, source=source, registers=""),
    }


def core_scripts(
    top: str, ports: Ports, registers: RegisterMap, *, source: str, megahertz: float
) -> Mapping[str, str]:
    """The scripts for a core with registers by the names of their files; of a video core a block design, too.

    Args:
        top: the core's module.
        ports: its ports, named as `hdl_templates.ip` names them.
        registers: its registers.
        source: the file that holds it.
        megahertz: the clock that is asked for.
    """
    assert ports.clock is not None
    scripts = {
        **_implementation(top, [source], ports.clock, megahertz),
        PACKAGE: _PACKAGE.format(**_COMMON, top=top, source=source, registers=_memory_map(registers)),
    }
    if "s_axis_video_tdata" in ports.inputs:
        scripts[BLOCK_DESIGN] = block_design(
            top,
            vlnv=f"{VENDOR}:{LIBRARY}:{top}:{VERSION}",
            here=_HERE,
            package=PACKAGE,
            part=PART,
            clock=ports.clock,
            pixel_bits=ports.inputs["s_axis_video_tdata"],
            has_squares="m_axis_squares_tdata" in ports.outputs,
            megahertz=megahertz,
        )
    return scripts


def _implementation(top: str, sources: list[str], clock: str, megahertz: float) -> Mapping[str, str]:
    """The script that implements a module out of context, and its constraints."""
    return {
        CONSTRAINTS: (
            "# The clock alone: delays from and to ports are those of whatever is around.\n"
            f"create_clock -name {clock} -period {1000 / megahertz:.3f} [get_ports {clock}]\n"
        ),
        IMPLEMENT: _IMPLEMENT.format(
            **_COMMON,
            top=top,
            sources=" ".join(f"[file join $here {file}]" for file in sources),
            constraints=CONSTRAINTS,
            utilisation=UTILISATION,
            timing=TIMING,
        ),
    }


def _memory_map(registers: RegisterMap) -> str:
    """What tells the packager which registers there are, as IP-XACT (IEEE 1685) has them."""
    lines = []
    for register in registers.registers:
        access = "read-write" if register.writable else "read-only"
        lines.append(f"    {register.name.upper()} 0x{register.offset:03x} {access} {{")
        for field in register.fields:
            bits = f"{field.low} {field.width}"
            lines.append(f"        {field.name.upper()} {bits} {_ACCESS[field.access]} {{{field.meaning}}}")
        lines.append("    }")
    listed = "".join(f"{line}\n" for line in lines)
    return _REGISTERS.format(range=1 << ADDRESS_BITS, width=DATA_BITS, listed=listed)
