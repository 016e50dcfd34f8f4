# Stubs of the Vivado commands (AMD UG835) that scripts may use: an unknown command or option, a missing value or
# file, and a wrong number of words are errors. What is asked of a design is printed for the test to look at.
# Usage: tclsh vivado_stubs.tcl SCRIPT

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
        current_project - current_fileset - ipx::current_core { return $command }
        get_ports - get_files - get_bd_cells - get_bd_pins - get_bd_intf_pins { return [lindex $words 0] }
    }
    return ""
}

namespace eval ipx {}
foreach {command form} $known {
    lassign $form options least most
    proc $command args "called $command [list $options] $least $most \$args"
}
set script [lindex $argv 0]
source $script
