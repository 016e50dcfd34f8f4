"""Yosys as the measuring instrument: Verilog in; resource counts, logic delay and the mapped netlist out."""

from wnn2hdl.synth.devices import XC7Z020, Device, Utilisation, shares, utilisation
from wnn2hdl.synth.fabrics import FABRICS, Fabric
from wnn2hdl.synth.flow import OPTIONS, Job, Synthesis, synthesise, synthesise_all, synthesise_job
from wnn2hdl.synth.harness import Harnessed, Ports, harness
from wnn2hdl.synth.mapping import Mapped, map_to
from wnn2hdl.synth.placing import SEED, Placed, place_and_route
from wnn2hdl.synth.resources import Resources, count_cells

__all__ = [
    "FABRICS",
    "OPTIONS",
    "SEED",
    "XC7Z020",
    "Device",
    "Fabric",
    "Harnessed",
    "Job",
    "Mapped",
    "Placed",
    "Ports",
    "Resources",
    "Synthesis",
    "Utilisation",
    "count_cells",
    "harness",
    "map_to",
    "place_and_route",
    "shares",
    "synthesise",
    "synthesise_all",
    "synthesise_job",
    "utilisation",
]
