"""Tcl for Vivado: synthesis and implementation out of context, packaging as an IP, a block design on a Zynq.

The commands are those of AMD UG835 (Tcl) and UG994 (IP Integrator). Each script finds its files beside
itself, so that the folder can be moved; what Vivado makes goes into folders there.
"""

from collections.abc import Mapping

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
ipx::create_xgui_files $core
ipx::update_checksums $core
ipx::check_integrity $core
ipx::save_core $core
close_project
"""

_BLOCK_DESIGN = """\
# A Zynq whose VDMA sends frames from memory through {top} and back. Run {package} first.
# A camera's stream goes to core/s_axis_video in the place of vdma/M_AXIS_MM2S.
{here}\
create_project -force board [file join $here board] -part {part}
set_property ip_repo_paths [list [file join $here ip]] [current_project]
update_ip_catalog
create_bd_design video

create_bd_cell -type ip -vlnv xilinx.com:ip:processing_system7 ps7
apply_bd_automation -rule xilinx.com:bd_rule:processing_system7 \\
    -config {{make_external "FIXED_IO, DDR"}} [get_bd_cells ps7]
set_property -dict [list \\
    CONFIG.PCW_FPGA0_PERIPHERAL_FREQMHZ {{{megahertz}}} \\
    CONFIG.PCW_USE_M_AXI_GP0 {{1}} \\
    CONFIG.PCW_USE_S_AXI_HP0 {{1}} \\
] [get_bd_cells ps7]

create_bd_cell -type ip -vlnv xilinx.com:ip:axi_vdma vdma
set_property -dict [list \\
    CONFIG.c_num_fstores {{3}} \\
    CONFIG.c_m_axis_mm2s_tdata_width {{{pixel_bits}}} \\
    CONFIG.c_mm2s_linebuffer_depth {{2048}} \\
    CONFIG.c_s2mm_linebuffer_depth {{2048}} \\
] [get_bd_cells vdma]

create_bd_cell -type ip -vlnv {vendor}:{library}:{top}:{version} core
connect_bd_intf_net [get_bd_intf_pins vdma/M_AXIS_MM2S] [get_bd_intf_pins core/s_axis_video]
connect_bd_intf_net [get_bd_intf_pins core/m_axis_video] [get_bd_intf_pins vdma/S_AXIS_S2MM]
{height}
apply_bd_automation -rule xilinx.com:bd_rule:axi4 \\
    -config {{Master /ps7/M_AXI_GP0 Clk /ps7/FCLK_CLK0}} [get_bd_intf_pins vdma/S_AXI_LITE]
apply_bd_automation -rule xilinx.com:bd_rule:axi4 \\
    -config {{Master /vdma/M_AXI_MM2S Clk /ps7/FCLK_CLK0}} [get_bd_intf_pins ps7/S_AXI_HP0]
apply_bd_automation -rule xilinx.com:bd_rule:axi4 \\
    -config {{Slave /ps7/S_AXI_HP0 Clk /ps7/FCLK_CLK0}} [get_bd_intf_pins vdma/M_AXI_S2MM]
foreach pin {{core/{clock} vdma/m_axis_mm2s_aclk vdma/s_axis_s2mm_aclk}} {{
    if {{[llength [get_bd_nets -quiet -of_objects [get_bd_pins $pin]]] == 0}} {{
        connect_bd_net [get_bd_pins ps7/FCLK_CLK0] [get_bd_pins $pin]
    }}
}}
create_bd_cell -type ip -vlnv xilinx.com:ip:proc_sys_reset reset
connect_bd_net [get_bd_pins ps7/FCLK_CLK0] [get_bd_pins reset/slowest_sync_clk]
connect_bd_net [get_bd_pins ps7/FCLK_RESET0_N] [get_bd_pins reset/ext_reset_in]
connect_bd_net [get_bd_pins reset/peripheral_aresetn] [get_bd_pins core/aresetn]

assign_bd_address
validate_bd_design
save_bd_design
add_files -norecurse [make_wrapper -files [get_files video.bd] -top]
update_compile_order -fileset sources_1
"""

_HEIGHT = """\

# The most lines of a frame, written by the processor.
create_bd_cell -type ip -vlnv xilinx.com:ip:axi_gpio height
set_property -dict [list \\
    CONFIG.C_ALL_OUTPUTS {{1}} \\
    CONFIG.C_GPIO_WIDTH {{{width}}} \\
] [get_bd_cells height]
connect_bd_net [get_bd_pins height/gpio_io_o] [get_bd_pins core/height]
apply_bd_automation -rule xilinx.com:bd_rule:axi4 \\
    -config {{Master /ps7/M_AXI_GP0 Clk /ps7/FCLK_CLK0}} [get_bd_intf_pins height/S_AXI]
"""


def vivado_scripts(
    top: str, ports: Ports, *, source: str, harness: str | None, megahertz: float
) -> Mapping[str, str]:
    """The scripts for a build by the names of their files.

    Args:
        top: the circuit's module.
        ports: its ports; those of a stream are named as `hdl_templates.video` names them.
        source: the file that holds it.
        harness: the module, and without its suffix the file, that puts registers around it to implement it;
            None of a video core, which is implemented itself and also gets a block design.
        megahertz: the clock that is asked for.
    """
    clock = ports.clock or "clk"
    implemented = harness or top
    sources = [source] if harness is None else [source, f"{harness}.v"]
    common = {"here": _HERE, "part": PART, "vendor": VENDOR, "library": LIBRARY, "version": VERSION}
    scripts = {
        CONSTRAINTS: (
            "# The clock alone: delays from and to ports are those of whatever is around.\n"
            f"create_clock -name {clock if harness is None else 'clk'} -period {1000 / megahertz:.3f} "
            f"[get_ports {clock if harness is None else 'clk'}]\n"
        ),
        IMPLEMENT: _IMPLEMENT.format(
            **common,
            top=implemented,
            sources=" ".join(f"[file join $here {file}]" for file in sources),
            constraints=CONSTRAINTS,
            utilisation=UTILISATION,
            timing=TIMING,
        ),
        PACKAGE: _PACKAGE.format(**common, top=top, source=source),
    }
    if harness is None:
        height = ports.inputs.get("height")
        scripts[BLOCK_DESIGN] = _BLOCK_DESIGN.format(
            **common,
            top=top,
            package=PACKAGE,
            clock=clock,
            megahertz=f"{megahertz:g}",
            pixel_bits=ports.inputs["s_axis_video_tdata"],
            height="" if height is None else _HEIGHT.format(width=height),
        )
    return scripts
