# amaranth: UnusedElaboratable=no
"""Cores as IPs: with registers behind AXI4-Lite in the place of the ports that a processor serves."""

from collections.abc import Collection, Mapping, Sequence

from amaranth.hdl import Module, Signal
from amaranth.lib.wiring import Out

from hdl_templates.axi_lite import BUS, AxiLiteRegisters, bus_members
from hdl_templates.engine import MatchEngine
from hdl_templates.frames import FrameControl
from hdl_templates.hierarchy import Part, place
from hdl_templates.interfaces import pass_on, ports_of, vivado_interfaces
from hdl_templates.matches import MatchControl
from hdl_templates.video import VideoCore
from wnn2hdl.ir.registers import DATA_BITS, RESULT, RegisterMap
from wnn2hdl.ir.video import MAX_WIDTH


class _Ip(Part):
    """A core with registers: what is alike in all of them."""

    clocked = True
    clock = "aclk"
    module_name = "ip"

    def __init__(
        self, core: Part, registers: RegisterMap, *, streams: Sequence[str], served: Collection[str]
    ) -> None:
        """Take the ports of a core without those that its registers serve, and add those of the bus."""
        self.registers = registers
        self._summary, self._streams = core.summary, streams
        kept = {name: member for name, member in core.signature.members.items() if name not in served}
        super().__init__({**kept, **bus_members(), "irq": Out(1)})

    @property
    def summary(self) -> str:
        """See `Part.summary`."""
        return f"{self._summary} Registers behind AXI4-Lite."

    @property
    def port_attributes(self) -> Mapping[str, Mapping[str, str]]:
        """See `Part.port_attributes`."""
        return vivado_interfaces(self, streams=self._streams, bus=BUS)

    def _place(self, m: Module, platform: object, control: AxiLiteRegisters, core: Part, watch: Part) -> None:
        """Place a core, its registers, and what watches it; all but the registers are reset by these, too."""
        for name, part in (("core", core), ("control", control), ("watch", watch)):
            place(m, name, part, platform)
        pass_on(m, self, control, ["aresetn", *ports_of(self, BUS), "irq"])
        resetn = Signal()
        m.d.comb += [
            resetn.eq(self.aresetn & ~control.control_reset),
            core.aresetn.eq(resetn),
            watch.aresetn.eq(resetn),
        ]


class VideoIp(_Ip):
    """A video core with registers.

    Args:
        core: the core.
        registers: its registers, see `wnn2hdl.ir.registers.video_registers`.

    Members:
        aresetn: In, synchronous reset, active low.
        s_axis_video_*, m_axis_video_*, m_axis_squares_*: the core's streams.
        s_axi_control_*: the bus of the registers.
        irq: Out, the interrupt, as long as an event that is enabled was not cleared.
    """

    def __init__(self, *, core: VideoCore, registers: RegisterMap) -> None:
        self.core = core
        super().__init__(core, registers, streams=core.streams, served=("height",))

    def elaborate(self, platform: object) -> Module:
        """The core, its registers, and what watches its frames."""
        m = Module()
        core, control = self.core, AxiLiteRegisters(registers=self.registers)
        longest = core.places if core.has_lines else core.video.beats_of(MAX_WIDTH)
        frames = FrameControl(pixels=core.video.pixels_per_clock, longest=longest)
        self._place(m, platform, control, core, frames)
        if core.has_lines:
            m.d.comb += core.height.eq(frames.frame_height)
        pass_on(m, self, core, (f"s_axis_video_{name}" for name in ("tdata", "tuser", "tlast")))
        for stream in core.streams[1:]:
            pass_on(m, self, core, ports_of(core, stream))
        m.d.comb += [
            core.s_axis_video_tvalid.eq(self.s_axis_video_tvalid & frames.passes),
            self.s_axis_video_tready.eq(core.s_axis_video_tready & frames.passes),
            frames.s_tvalid.eq(self.s_axis_video_tvalid),
            frames.s_tready.eq(core.s_axis_video_tready),
            frames.s_tuser.eq(self.s_axis_video_tuser),
            frames.s_tlast.eq(self.s_axis_video_tlast),
            frames.m_tvalid.eq(core.m_axis_video_tvalid),
            frames.m_tready.eq(self.m_axis_video_tready),
            frames.m_tuser.eq(core.m_axis_video_tuser),
            frames.m_tlast.eq(core.m_axis_video_tlast),
            frames.enable.eq(control.control_enable),
            frames.height.eq(control.height),
            control.status_running.eq(frames.running),
            control.interrupt_frame.eq(frames.answered),
            control.interrupt_malformed.eq(frames.gone_wrong),
            control.frames.eq(frames.frames),
            control.malformed.eq(frames.malformed),
            control.width.eq(frames.width),
        ]
        return m


class EngineIp(_Ip):
    """A match engine with registers, from which results are read.

    Args:
        core: the engine.
        registers: its registers, see `wnn2hdl.ir.registers.engine_registers`.

    Members:
        aresetn: In, synchronous reset, active low.
        s_axis_segment_*, s_axis_template_*: the engine's streams.
        s_axi_control_*: the bus of the registers.
        irq: Out, the interrupt, as long as an event that is enabled was not cleared.
    """

    def __init__(self, *, core: MatchEngine, registers: RegisterMap) -> None:
        self.core = core
        super().__init__(
            core,
            registers,
            streams=("s_axis_segment", "s_axis_template"),
            served=ports_of(core, "m_axis_result"),
        )

    def elaborate(self, platform: object) -> Module:
        """The engine, its registers, and what watches its matches."""
        m = Module()
        core, control = self.core, AxiLiteRegisters(registers=self.registers)
        watch = MatchControl(engine=core.engine)
        self._place(m, platform, control, core, watch)
        pass_on(m, self, core, ports_of(core, "s_axis_segment"))
        pass_on(m, self, core, (f"s_axis_template_{name}" for name in ("tdata", "tuser", "tlast")))
        m.d.comb += [
            core.s_axis_template_tvalid.eq(self.s_axis_template_tvalid & watch.passes),
            self.s_axis_template_tready.eq(core.s_axis_template_tready & watch.passes),
            watch.template_tvalid.eq(self.s_axis_template_tvalid),
            watch.template_tready.eq(core.s_axis_template_tready),
            watch.template_tuser.eq(self.s_axis_template_tuser),
            watch.template_tlast.eq(self.s_axis_template_tlast),
            watch.segment_tvalid.eq(self.s_axis_segment_tvalid),
            watch.segment_tready.eq(core.s_axis_segment_tready),
            watch.segment_tlast.eq(self.s_axis_segment_tlast),
            watch.result_tvalid.eq(core.m_axis_result_tvalid),
            core.m_axis_result_tready.eq(watch.result_tready),
            watch.enable.eq(control.control_enable),
            watch.waits.eq(control.interrupt_match_waits),
            control.status_running.eq(watch.running),
            control.status_segment.eq(watch.has_segment),
            control.interrupt_match.eq(watch.ended),
            control.interrupt_malformed.eq(watch.gone_wrong),
            control.results.eq(watch.results),
            control.malformed.eq(watch.malformed),
        ]
        for position, name in enumerate(RESULT):
            register = self.registers.register(name)
            for field in register.fields:
                low = position * DATA_BITS + field.low
                bits = core.m_axis_result_tdata[low : low + field.width]
                m.d.comb += getattr(control, register.signal(field)).eq(bits)
        return m
