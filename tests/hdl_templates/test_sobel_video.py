# amaranth: UnusedElaboratable=no
"""The baseline of video cores: Sobel's edges of whole frames."""

import numpy as np
import pytest
from numpy.lib.stride_tricks import sliding_window_view

from hdl_templates.sobel import Parameters
from hdl_templates.sobel_video import SobelCore
from wnn2hdl.ir import VideoFormat
from wnn2hdl.ir.video import Beats
from wnn2hdl.verify.stream import simulate_stream


@pytest.mark.parametrize("per_clock", [1, 2, 4])
def test_frames_are_answered_as_the_operator_answers_their_windows(per_clock: int) -> None:
    parameters = Parameters(500)
    core = SobelCore(video=VideoFormat(16, pixels_per_clock=per_clock), parameters=parameters)
    draw = np.random.default_rng(0)
    greys = [
        core.video.padded(draw.integers(0, 256, size, dtype=np.uint8)) for size in [(5, 7), (1, 3), (5, 16)]
    ]
    answers = [
        parameters.compute(sliding_window_view(np.pad(grey, 1, mode="edge"), (3, 3)).reshape(*grey.shape, 9))
        for grey in greys
    ]
    assert 0.1 < np.mean(answers[0]) < 0.9
    sent = [np.where(edges, np.uint8(255), np.uint8(0)) for edges in answers]
    beats = Beats.of([grey.astype(np.uint32) for grey in greys], sent, per_clock)
    assert simulate_stream(core, beats).vectors == len(beats)
