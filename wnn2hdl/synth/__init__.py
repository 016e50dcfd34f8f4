"""Yosys as the measuring instrument: Verilog in; resource counts, logic delay and the mapped netlist out."""

from wnn2hdl.synth.devices import XC7Z020, Device, Utilisation, shares, utilisation
from wnn2hdl.synth.flow import OPTIONS, Job, Synthesis, synthesise, synthesise_all, synthesise_job
from wnn2hdl.synth.resources import Resources, count_cells

__all__ = [
    "OPTIONS",
    "XC7Z020",
    "Device",
    "Job",
    "Resources",
    "Synthesis",
    "Utilisation",
    "count_cells",
    "shares",
    "synthesise",
    "synthesise_all",
    "synthesise_job",
    "utilisation",
]
