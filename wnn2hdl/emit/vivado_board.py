"""Tcl for Vivado's IP Integrator (AMD UG994): a Zynq around a video core."""

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
    CONFIG.PCW_USE_FABRIC_INTERRUPT {{1}} \\
    CONFIG.PCW_IRQ_F2P_INTR {{1}} \\
] [get_bd_cells ps7]

create_bd_cell -type ip -vlnv xilinx.com:ip:axi_vdma vdma
set_property -dict [list \\
    CONFIG.c_num_fstores {{3}} \\
    CONFIG.c_m_axis_mm2s_tdata_width {{{pixel_bits}}} \\
    CONFIG.c_mm2s_linebuffer_depth {{2048}} \\
    CONFIG.c_s2mm_linebuffer_depth {{2048}} \\
    CONFIG.c_use_s2mm_fsync {{2}} \\
] [get_bd_cells vdma]

create_bd_cell -type ip -vlnv {vlnv} core
connect_bd_intf_net [get_bd_intf_pins vdma/M_AXIS_MM2S] [get_bd_intf_pins core/s_axis_video]
connect_bd_intf_net [get_bd_intf_pins core/m_axis_video] [get_bd_intf_pins vdma/S_AXIS_S2MM]
apply_bd_automation -rule xilinx.com:bd_rule:axi4 \\
    -config {{Master /ps7/M_AXI_GP0 Clk /ps7/FCLK_CLK0}} [get_bd_intf_pins core/s_axi_control]
apply_bd_automation -rule xilinx.com:bd_rule:axi4 \\
    -config {{Master /ps7/M_AXI_GP0 Clk /ps7/FCLK_CLK0}} [get_bd_intf_pins vdma/S_AXI_LITE]
apply_bd_automation -rule xilinx.com:bd_rule:axi4 \\
    -config {{Master /vdma/M_AXI_MM2S Clk /ps7/FCLK_CLK0}} [get_bd_intf_pins ps7/S_AXI_HP0]
apply_bd_automation -rule xilinx.com:bd_rule:axi4 \\
    -config {{Slave /ps7/S_AXI_HP0 Clk /ps7/FCLK_CLK0}} [get_bd_intf_pins vdma/M_AXI_S2MM]
{squares}\
# What the automation has left without a clock or a reset.
foreach pin {{core/{clock} vdma/m_axis_mm2s_aclk vdma/s_axis_s2mm_aclk{clocked}}} {{
    if {{[llength [get_bd_nets -quiet -of_objects [get_bd_pins $pin]]] == 0}} {{
        connect_bd_net [get_bd_pins ps7/FCLK_CLK0] [get_bd_pins $pin]
    }}
}}
if {{[llength [get_bd_nets -quiet -of_objects [get_bd_pins core/aresetn]]] == 0}} {{
    create_bd_cell -type ip -vlnv xilinx.com:ip:proc_sys_reset reset
    connect_bd_net [get_bd_pins ps7/FCLK_CLK0] [get_bd_pins reset/slowest_sync_clk]
    connect_bd_net [get_bd_pins ps7/FCLK_RESET0_N] [get_bd_pins reset/ext_reset_in]
    connect_bd_net [get_bd_pins reset/peripheral_aresetn] [get_bd_pins core/aresetn]
}}

# Interrupts of the core, and of VDMAs when a frame was read and written.
create_bd_cell -type ip -vlnv xilinx.com:ip:xlconcat interrupts
set interrupts {{core/irq vdma/mm2s_introut vdma/s2mm_introut{interrupts}}}
set_property CONFIG.NUM_PORTS [llength $interrupts] [get_bd_cells interrupts]
foreach pin $interrupts {{
    connect_bd_net [get_bd_pins $pin] [get_bd_pins interrupts/In[lsearch $interrupts $pin]]
}}
connect_bd_net [get_bd_pins interrupts/dout] [get_bd_pins ps7/IRQ_F2P]

assign_bd_address
validate_bd_design
save_bd_design
add_files -norecurse [make_wrapper -files [get_files video.bd] -top]
update_compile_order -fileset sources_1
"""


_SQUARES = """\
# Majorities of squares go to memory by a VDMA of their own.
create_bd_cell -type ip -vlnv xilinx.com:ip:axi_vdma squares
set_property -dict [list \\
    CONFIG.c_include_mm2s {0} \\
    CONFIG.c_num_fstores {3} \\
    CONFIG.c_use_s2mm_fsync {2} \\
] [get_bd_cells squares]
connect_bd_intf_net [get_bd_intf_pins core/m_axis_squares] [get_bd_intf_pins squares/S_AXIS_S2MM]
apply_bd_automation -rule xilinx.com:bd_rule:axi4 \\
    -config {Master /ps7/M_AXI_GP0 Clk /ps7/FCLK_CLK0} [get_bd_intf_pins squares/S_AXI_LITE]
apply_bd_automation -rule xilinx.com:bd_rule:axi4 \\
    -config {Slave /ps7/S_AXI_HP0 Clk /ps7/FCLK_CLK0} [get_bd_intf_pins squares/M_AXI_S2MM]
"""


def block_design(
    top: str,
    *,
    vlnv: str,
    here: str,
    package: str,
    part: str,
    clock: str,
    pixel_bits: int,
    has_squares: bool,
    megahertz: float,
) -> str:
    """The script of a block design.

    Args:
        top: the core's module.
        vlnv: of the core as an IP.
        here: commands that find the script's folder, ``here``.
        package: the script that makes the IP.
        part: the device.
        clock: the core's port of its clock.
        pixel_bits: of a beat of the stream of pixels.
        has_squares: whether the core sends majorities of squares.
        megahertz: the clock that the processing system gives.
    """
    return _BLOCK_DESIGN.format(
        top=top,
        vlnv=vlnv,
        here=here,
        package=package,
        part=part,
        clock=clock,
        pixel_bits=pixel_bits,
        squares=_SQUARES if has_squares else "",
        clocked=" squares/s_axis_s2mm_aclk" if has_squares else "",
        interrupts=" squares/s2mm_introut" if has_squares else "",
        megahertz=f"{megahertz:g}",
    )
