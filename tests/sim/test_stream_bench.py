# amaranth: UnusedElaboratable=no
"""Video cores between the AXI4-Streams of another project: whole and malformed frames, and resets."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from hdl_templates.video import VideoCore
from sim.run import SimulatorName, run_test
from sim.stream_bench import LINES
from tests.sim.test_properties import Pixel, Window
from wnn2hdl.emit import verilog
from wnn2hdl.ir import VideoFormat

pytestmark = pytest.mark.simulator

HEIGHT = 4
WIDTH = 16
"""Of the memory, in beats."""

Line = tuple[str, bool]


def frame(height: int, width: int, seed: int) -> NDArray[np.uint8]:
    return np.random.default_rng(seed).integers(0, 256, (height, width, 3), dtype=np.uint8)


def sent(video: VideoFormat, pixels: NDArray[np.uint8]) -> list[Line]:
    words = video.pixels(video.padded(pixels))
    rows = [b"".join(int(word).to_bytes(3, "little") for word in row).hex() for row in words]
    return [(row, number == 0) for number, row in enumerate(rows)]


def answered(video: VideoFormat, pixels: NDArray[np.uint8]) -> list[Line]:
    """The class of a pixel, which is its edge bit, too."""
    bits = video.padded(pixels)[..., 0] >> np.uint8(7)
    rows = [bytes(row).hex() for row in bits * np.uint8(0x81)]
    return [(row, number == 0) for number, row in enumerate(rows)]


def run(
    video: VideoFormat,
    lines: list[Line | None],
    expected: list[Line],
    simulator: SimulatorName,
    folder: Path,
    wrong: str = "",
) -> None:
    per_clock = video.pixels_per_clock
    part = VideoCore(
        video=video, pixels=[Pixel() for _ in range(per_clock)], windows=[Window() for _ in range(per_clock)]
    )
    text = verilog(part, prefix="bench_", header=[])
    (folder / "core.v").write_text(text.replace(wrong, "flush") if wrong else text, encoding="utf-8")
    (folder / "lines.json").write_text(json.dumps({"height": HEIGHT, "sent": lines, "expected": expected}))
    variables = {LINES: str(folder / "lines.json")}
    run_test("sim.stream_bench", variables, "bench_video", [folder / "core.v"], simulator, folder)


@pytest.mark.parametrize(
    ("per_clock", "simulator"),
    [
        (1, "icarus"),
        pytest.param(2, "icarus", marks=pytest.mark.slow),
        pytest.param(4, "icarus", marks=pytest.mark.slow),
        pytest.param(2, "verilator", marks=pytest.mark.slow),
    ],
)
def test_frames_of_any_kind_one_behind_the_other(
    per_clock: int, simulator: SimulatorName, tmp_path: Path
) -> None:
    video = VideoFormat(max_width=WIDTH * per_clock, pixels_per_clock=per_clock)
    # Two of a size, odd sizes, lines of one beat, as long as can be, fewer lines than can be.
    sizes = [
        (4, 7),
        (4, 7),
        (4, 1),
        (1, 5),
        (3, 2 * per_clock),
        (2, WIDTH * per_clock),
        (4, 3 * per_clock + 1),
    ]
    whole = [frame(height, width, seed) for seed, (height, width) in enumerate(sizes)]
    lines: list[Line | None] = [line for pixels in whole for line in sent(video, pixels)]
    expected = [line for pixels in whole for line in answered(video, pixels)]
    # A frame too high, and one after a reset.
    high, last = frame(6, 9, 7), frame(4, 5, 8)
    lines += [*sent(video, high), None, *sent(video, last)]
    expected += [*answered(video, high[:HEIGHT]), *answered(video, last)]
    run(video, lines, expected, simulator, tmp_path)


def test_a_wrong_core_is_found(tmp_path: Path) -> None:
    video = VideoFormat(max_width=WIDTH)
    lines: list[Line | None] = [*sent(video, frame(4, 7, 0)), *sent(video, frame(4, 7, 1))]
    expected = [*answered(video, frame(4, 7, 0)), *answered(video, frame(4, 7, 1))]
    with pytest.raises(AssertionError, match="differs from the model in icarus"):
        run(video, lines, expected, "icarus", tmp_path, wrong="(flush & ~done)")
