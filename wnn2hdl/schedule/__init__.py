"""Where the registers of a pipeline go: a pass from circuit to circuit."""

from wnn2hdl.schedule.choose import MAX_STAGES, for_clock, for_instances, for_stages
from wnn2hdl.schedule.delays import XC7, Delays
from wnn2hdl.schedule.registers import pipelined
from wnn2hdl.schedule.stages import Stages

__all__ = ["MAX_STAGES", "XC7", "Delays", "Stages", "for_clock", "for_instances", "for_stages", "pipelined"]
