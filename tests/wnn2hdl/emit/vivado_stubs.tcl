# Stubs of the Vivado commands (AMD UG835) that scripts may use: an unknown command or option, a missing value or
# file, and a wrong number of words are errors, and so are pins, interfaces and parameters that an IP does not have.
# What is asked of a design is printed for the test to look at.
# Usage: tclsh vivado_stubs.tcl SCRIPT [PORT ...], with the ports and interfaces of the core as it is in Verilog

# For each command: its options, each with the number of values, and the least and the most words besides.
set known {
    read_verilog {{-sv 0 -library 1 -quiet 0} 1 1}
    read_xdc {{-mode 1 -cells 1 -ref 1 -unmanaged 0 -quiet 0} 1 1}
    synth_design {{-top 1 -part 1 -mode 1 -flatten_hierarchy 1 -directive 1 -name 1} 0 0}
    opt_design {{-directive 1} 0 0}
    place_design {{-directive 1} 0 0}
    route_design {{-directive 1} 0 0}
    report_utilization {{-file 1 -hierarchical 0 -append 0} 0 0}
    report_timing_summary {{-file 1 -delay_type 1 -max_paths 1 -nworst 1} 0 0}
    write_checkpoint {{-force 0} 1 1}
    create_clock {{-name 1 -period 1 -waveform 1 -add 0} 0 1}
    get_ports {{-quiet 0 -regexp 0 -filter 1} 1 1}
    create_project {{-force 0 -part 1 -in_memory 0 -ip 0} 0 2}
    close_project {{-delete 0 -quiet 0} 0 0}
    current_project {{-quiet 0} 0 1}
    current_fileset {{-quiet 0} 0 0}
    add_files {{-norecurse 0 -fileset 1 -scan_for_includes 0} 1 1}
    get_files {{-quiet 0 -of_objects 1} 1 1}
    update_compile_order {{-fileset 1} 0 0}
    set_property {{-dict 1 -name 1 -value 1} 1 3}
    update_ip_catalog {{-rebuild 0 -repo_path 1} 0 0}
    ipx::package_project {{-root_dir 1 -vendor 1 -library 1 -taxonomy 1 -name 1 -version 1 -module 1 -import_files 0 -set_current 1 -force 0} 0 0}
    ipx::current_core {{-quiet 0} 0 1}
    ipx::remove_all_memory_map {{} 1 1}
    ipx::add_memory_map {{-quiet 0} 2 2}
    ipx::add_address_block {{-quiet 0} 2 2}
    ipx::add_register {{-quiet 0} 2 2}
    ipx::add_field {{-quiet 0} 2 2}
    ipx::get_bus_interfaces {{-quiet 0 -of_objects 1} 0 1}
    ipx::create_xgui_files {{-logo_file 1} 1 1}
    ipx::update_checksums {{-quiet 0} 1 1}
    ipx::check_integrity {{-quiet 0} 1 1}
    ipx::save_core {{-quiet 0} 1 1}
    create_bd_design {{-dir 1 -cell 1} 1 1}
    create_bd_cell {{-type 1 -vlnv 1 -reference 1} 1 1}
    apply_bd_automation {{-rule 1 -config 1 -dict 1} 0 1}
    get_bd_cells {{-quiet 0 -hierarchical 0} 1 1}
    get_bd_pins {{-quiet 0 -of_objects 1} 1 1}
    get_bd_intf_pins {{-quiet 0 -of_objects 1} 1 1}
    get_bd_nets {{-quiet 0 -of_objects 1} 0 1}
    connect_bd_net {{-net 1} 2 9}
    connect_bd_intf_net {{-intf_net 1} 2 2}
    assign_bd_address {{-offset 1 -range 1 -target_address_space 1} 0 1}
    validate_bd_design {{-force 0 -quiet 0} 0 0}
    save_bd_design {{-quiet 0} 0 1}
    make_wrapper {{-files 1 -top 0 -import 0 -fileset 1} 0 0}
}

# Pins, interfaces and parameters of AMD's IP (PG021 VDMA, PG082 processing system 7, PG164 reset, PG099 concat)
# as far as scripts may use them.
set ip {
    xilinx.com:ip:processing_system7 {
        FCLK_CLK0 FCLK_RESET0_N IRQ_F2P M_AXI_GP0 S_AXI_HP0 M_AXI_GP0_ACLK S_AXI_HP0_ACLK DDR FIXED_IO
        CONFIG.PCW_FPGA0_PERIPHERAL_FREQMHZ CONFIG.PCW_USE_M_AXI_GP0 CONFIG.PCW_USE_S_AXI_HP0
        CONFIG.PCW_USE_FABRIC_INTERRUPT CONFIG.PCW_IRQ_F2P_INTR
    }
    xilinx.com:ip:axi_vdma {
        s_axi_lite_aclk m_axi_mm2s_aclk m_axi_s2mm_aclk m_axis_mm2s_aclk s_axis_s2mm_aclk axi_resetn
        mm2s_introut s2mm_introut S_AXI_LITE M_AXI_MM2S M_AXI_S2MM M_AXIS_MM2S S_AXIS_S2MM
        CONFIG.c_num_fstores CONFIG.c_m_axis_mm2s_tdata_width CONFIG.c_mm2s_linebuffer_depth
        CONFIG.c_s2mm_linebuffer_depth CONFIG.c_use_s2mm_fsync CONFIG.c_include_mm2s CONFIG.c_include_s2mm
    }
    xilinx.com:ip:proc_sys_reset {slowest_sync_clk ext_reset_in aux_reset_in peripheral_aresetn interconnect_aresetn}
    xilinx.com:ip:xlconcat {In0 In1 In2 In3 dout CONFIG.NUM_PORTS}
}
set cells {}
# The properties of what a package holds (IEEE 1685), and the values of some of them.
set properties {
    ipx::current_core {name version display_name description supported_families}
    ipx::add_address_block {usage range width access description}
    ipx::add_register {address_offset size access description}
    ipx::add_field {bit_offset bit_width access modified_write_value description}
    ipx::get_bus_interfaces {slave_memory_map_ref}
}
set values {
    access {read-only read-write write-only writeOnce read-writeOnce}
    modified_write_value {modify oneToClear oneToSet oneToToggle zeroToClear clear set}
    usage {register memory reserved}
}

# Whether a cell of a block design has a pin, interface or parameter.
proc owned {cell what} {
    if {![dict exists $::cells $cell]} { error "there is no cell $cell" }
    if {$what ni [dict get $::cells $cell]} { error "$cell has no $what" }
}

# What is set has to be known of what it is set on.
proc assigned {name value object} {
    if {[dict exists $::cells $object]} { owned $object $name }
    if {[dict exists $::properties $object]} {
        if {$name ni [dict get $::properties $object]} { error "$object has no property $name" }
        if {[dict exists $::values $name] && $value ni [dict get $::values $name]} {
            error "$name cannot be $value"
        }
    }
}

proc called {command options least most arguments} {
    set words {}
    set given {}
    while {[llength $arguments]} {
        set arguments [lassign $arguments word]
        if {[string match -* $word] && ![string is double $word]} {
            if {![dict exists $options $word]} { error "$command has no option $word" }
            if {[dict get $options $word]} {
                if {![llength $arguments]} { error "$command $word lacks its value" }
                set arguments [lassign $arguments value]
                dict set given $word $value
            } else {
                dict set given $word 1
            }
        } else {
            lappend words $word
        }
    }
    if {[llength $words] < $least || [llength $words] > $most} {
        error "$command takes $least to $most words, not [llength $words]"
    }
    puts [list CALL $command $given $words]
    switch $command {
        read_verilog - add_files {
            foreach file [lindex $words 0] {
                if {![string match made/* $file] && ![file isfile $file]} { error "$file is missing" }
            }
        }
        read_xdc { uplevel #0 [list source [lindex $words 0]] }
        make_wrapper { return made/wrapper.v }
        create_bd_cell {
            set vlnv [dict get $given -vlnv]
            if {[dict exists $::ip $vlnv]} {
                dict set ::cells [lindex $words 0] [dict get $::ip $vlnv]
            } elseif {[string match wnn2hdl:* $vlnv]} {
                dict set ::cells [lindex $words 0] $::ports
            } else {
                error "there is no IP $vlnv"
            }
        }
        get_bd_pins - get_bd_intf_pins {
            lassign [split [lindex $words 0] /] cell what
            owned $cell $what
            return [lindex $words 0]
        }
        get_bd_cells {
            if {![dict exists $::cells [lindex $words 0]]} { error "there is no cell [lindex $words 0]" }
            return [lindex $words 0]
        }
        get_ports {
            if {[llength $::ports] && [lindex $words 0] ni $::ports} { error "there is no port [lindex $words 0]" }
            return [lindex $words 0]
        }
        set_property {
            if {[dict exists $given -dict]} {
                foreach {name value} [dict get $given -dict] { assigned $name $value [lindex $words 0] }
            } elseif {[llength $words] == 3} {
                assigned {*}$words
            }
        }
        current_project - current_fileset - ipx::current_core { return $command }
        ipx::add_memory_map - ipx::add_address_block - ipx::add_register - ipx::add_field {
            return $command
        }
        ipx::get_bus_interfaces {
            if {[llength $::ports] && [lindex $words 0] ni $::ports} { error "no interface [lindex $words 0]" }
            return $command
        }
        get_files { return [lindex $words 0] }
    }
    return ""
}

namespace eval ipx {}
foreach {command form} $known {
    lassign $form options least most
    proc $command args "called $command [list $options] $least $most \$args"
}
set ports [lassign $argv script]
source $script
