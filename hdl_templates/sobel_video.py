# amaranth: UnusedElaboratable=no
"""The Sobel operator as a video core: the baseline of cores that send edges.

It has the same streams, frames and scan as `hdl_templates.video.VideoCore`, reads grey pixels of 8 bits, and
keeps these in its lines instead of one bit of each.
"""

from dataclasses import replace

from amaranth.hdl import Module
from amaranth.lib.wiring import In, Out

from hdl_templates.hierarchy import Part
from hdl_templates.ports import tie_off
from hdl_templates.sobel import GREY_BITS, Parameters
from hdl_templates.video import VideoCore
from wnn2hdl.ir import PIXEL_BITS, VideoFormat
from wnn2hdl.ir.video import MONO


class Grey(Part):
    """A grey pixel, as it is.

    Members:
        rgb: In, the pixel in three equal channels.
        grey: Out, one of them.
    """

    module_name = "grey"

    def __init__(self) -> None:
        super().__init__({"rgb": In(PIXEL_BITS), "grey": Out(GREY_BITS)})

    def elaborate(self, platform: object) -> Module:
        """The lowest channel."""
        m = Module()
        m.d.comb += self.grey.eq(self.rgb[:GREY_BITS])
        tie_off(m, [self.rgb[GREY_BITS:]], platform)
        return m


class SobelCore(VideoCore):
    """A video core that sends the Sobel operator's edges of grey pixels.

    Args:
        video: the streams of the core that it is compared with; pixels and answers are those of this one.
        parameters: the threshold.
    """

    module_name = "sobel_video"

    def __init__(self, *, video: VideoFormat, parameters: Parameters) -> None:
        super().__init__(
            video=replace(video, format=MONO, answer="edge"),
            pixels=[Grey() for _ in range(video.pixels_per_clock)],
            windows=[parameters.create() for _ in range(video.pixels_per_clock)],
        )
