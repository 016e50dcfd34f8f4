"""Video cores: compiled, checked, and a picture through them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.build.compile import compile_model
from wnn2hdl.build.design import Mode
from wnn2hdl.build.emission import emit, outermost_part, video_part
from wnn2hdl.build.planning import CompileOptions, plan
from wnn2hdl.build.playback import Playback, play
from wnn2hdl.build.streaming import beats, framed_answers, sample_frames
from wnn2hdl.build.verification import open_build, verify_build
from wnn2hdl.emit import cells_model, stream_testbench, stream_vectors, verilog
from wnn2hdl.errors import CheckError, InputError, ToolError
from wnn2hdl.evaluation.accuracy import with_halo
from wnn2hdl.evaluation.classifiers import model_classifier
from wnn2hdl.evaluation.squares import vote
from wnn2hdl.images import read_rgb, write_png
from wnn2hdl.ir import BitSelect, Context, Neighbourhood, Tap, VideoFormat, WisardModel, window_codes
from wnn2hdl.ir.registers import video_registers
from wnn2hdl.ir.video import Answer, Beats
from wnn2hdl.ir.window import framed_window_codes
from wnn2hdl.tools import run_icarus, run_verilator
from wnn2hdl.verify.stream import run_stream, simulate_stream
from wnn2hdl.wisard import PixelClassifier


def silent(step: str, done: int, total: int) -> None:
    pass


@pytest.fixture(scope="module")
def video(model: WisardModel, imagery: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A video core in domain mode, compiled once."""
    folder = tmp_path_factory.mktemp("builds") / "video"
    options = CompileOptions(target="video", mode="domain", care=imagery, max_width=70)
    assert compile_model(model, folder, options, silent).failure is None
    return folder


def test_the_report_counts_the_core_with_its_buffers_beside_its_circuits(video: Path) -> None:
    _, _, report = open_build(video)
    parts = report["parts"]
    assert list(parts) == ["pixel", "edge", "video", "ip", "sobel"]
    assert parts["video"]["bram36"] == 0.5
    assert 0 < parts["video"]["ffs"] < parts["ip"]["ffs"]
    assert "simulated" in report["proof"]["method"]
    assert report["options"]["simulated_vectors"]["video"] > 500


def test_a_build_of_a_core_passes_its_checks_again(video: Path) -> None:
    problems, checked = verify_build(video, silent)
    assert not problems
    assert checked is not None
    assert checked.status == "proved"


@pytest.mark.simulator
def test_the_testbench_passes_and_finds_a_border_of_zeros(video: Path, tmp_path: Path) -> None:
    _, files, _ = open_build(video)
    (tmp_path / files.vectors.name).write_text(files.vectors.read_text())
    sources = [files.cells, files.verilog, files.testbench]
    top = files.testbench.stem
    assert "PASS" in run_icarus(sources, top, cwd=tmp_path, timeout=60).output
    text = files.verilog.read_text()
    wrong = text.replace("if (newest_last) right_1 <= newest_0", "if (newest_last) right_1 <= 3'h0")
    assert wrong != text
    (tmp_path / "wrong.v").write_text(wrong)
    with pytest.raises(ToolError) as failed:
        run_icarus([files.cells, tmp_path / "wrong.v", files.testbench], top, cwd=tmp_path, timeout=60)
    assert "FAIL" in failed.value.output


@pytest.mark.simulator
@pytest.mark.slow
def test_the_testbench_passes_in_verilator(video: Path, tmp_path: Path) -> None:
    _, files, _ = open_build(video)
    (tmp_path / files.vectors.name).write_text(files.vectors.read_text())
    sources = [files.cells, files.verilog, files.testbench]
    assert "PASS" in run_verilator(sources, files.testbench.stem, cwd=tmp_path, timeout=300).output


@pytest.mark.simulator
@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        # A frame begins without being enabled, the height has no effect, events are not counted.
        ("may_begin <= enable &", "may_begin <="),
        ("frame_height <= height", "frame_height <= 12'h000"),
        ("if (answered) frames <=", "if (gone_wrong) frames <="),
        ("10'h00a", "10'h00b"),
    ],
)
def test_the_testbench_finds_wrong_registers(video: Path, right: str, wrong: str, tmp_path: Path) -> None:
    _, files, _ = open_build(video)
    (tmp_path / files.vectors.name).write_text(files.vectors.read_text())
    text = files.verilog.read_text().replace("\n        ", " ")
    assert text.count(right) == 1
    (tmp_path / "wrong.v").write_text(text.replace(right, wrong))
    sources = [files.cells, tmp_path / "wrong.v", files.testbench]
    with pytest.raises(ToolError) as failed:
        run_icarus(sources, files.testbench.stem, cwd=tmp_path, timeout=60)
    assert "FAIL" in failed.value.output


@pytest.mark.simulator
def test_a_picture_passes_as_a_frame_and_its_inner_edges_are_those_of_windows(
    video: Path, model: WisardModel, imagery: Path
) -> None:
    picture = imagery / "7.png"
    result = play(video, picture, "icarus", silent)
    classes = PixelClassifier(model).classify(read_rgb(picture))
    design = open_build(video)[0]
    assert result.windows == 64 * 64
    assert result.cared == 1.0
    assert np.array_equal(result.foreground, classes != 0)
    assert result.edges is not None
    assert result.frame is not None
    assert np.array_equal(result.frame & 127, classes)
    assert np.array_equal(result.frame >> 7, result.edges)
    assert design.edges is not None
    inner = design.edges.evaluate(window_codes(classes != 0))
    assert np.array_equal(result.edges[1:-1, 1:-1], inner)


def test_the_waves_of_a_small_picture_are_recorded(video: Path, tmp_path: Path) -> None:
    picture = tmp_path / "small.png"
    write_png(picture, np.random.default_rng(0).integers(0, 256, (5, 6, 3), dtype=np.uint8))
    assert play(video, picture, "amaranth", silent, tmp_path / "waves.vcd").windows == 30
    assert "m_axis_video_tvalid" in (tmp_path / "waves.vcd").read_text()


@pytest.mark.simulator
@pytest.mark.parametrize(
    "extreme",
    [
        # Lines of one beat, and a queue behind the longest pipeline.
        CompileOptions(target="video", max_width=2, pixels_per_clock=4, answer="class", square=4),
        CompileOptions(target="video", max_width=2, stages=64, answer="class", square=2),
    ],
)
def test_the_shortest_lines_and_the_longest_pipelines_are_right(
    extreme: CompileOptions, model: WisardModel, tmp_path: Path
) -> None:
    design = plan(model, "core", replace(extreme, effort=0), silent).design
    frames = beats(design, [np.random.default_rng(0).integers(0, 256, (3, 2, 3), dtype=np.uint8)] * 2)
    simulate_stream(video_part(design), frames)
    files = emit(design, tmp_path, sobel_threshold=128)
    assert design.video is not None
    assert design.registers is not None
    run_stream(frames, design.video, design.registers, design.outermost, files.simulated, "icarus")


def test_a_picture_wider_than_the_lines_is_refused(video: Path, tmp_path: Path) -> None:
    picture = tmp_path / "wide.png"
    write_png(picture, np.zeros((2, 71, 3), dtype=np.uint8))
    with pytest.raises(InputError, match="larger than the frames"):
        play(video, picture, "icarus", silent)


@pytest.mark.simulator
def test_a_wrong_answer_is_found_in_icarus(video: Path) -> None:
    design, files, _ = open_build(video)
    assert design.video is not None
    assert design.registers is not None
    frames = sample_frames(design)
    wrong = Beats(frames.pixels, frames.answers ^ np.uint8(1), frames.starts, frames.ends, frames.height)
    with pytest.raises(CheckError, match="icarus disagrees"):
        run_stream(wrong, design.video, design.registers, design.outermost, files.simulated, "icarus")


def test_a_wrong_answer_and_a_missing_one_are_found(video: Path) -> None:
    design, _, _ = open_build(video)
    assert design.video is not None
    frames = sample_frames(design)
    wrong = Beats(frames.pixels, frames.answers ^ np.uint8(1), frames.starts, frames.ends, frames.height)
    with pytest.raises(CheckError, match="at beat 0"):
        simulate_stream(video_part(design), wrong)
    endless = Beats(frames.pixels, frames.answers, frames.starts, frames.ends, frames.height + 1)
    with pytest.raises(CheckError, match="stops after"):
        simulate_stream(video_part(design), endless)


def test_a_core_of_classes_alone_has_no_edge_filter(model: WisardModel) -> None:
    options = CompileOptions(target="video", answer="class")
    design = plan(model, "mine", options, silent).design
    assert design.edges is None
    assert list(design.parts) == ["pixel"]
    pixels = np.random.default_rng(0).integers(0, 256, (3, 4, 3), dtype=np.uint8)
    assert framed_answers(design, pixels).edges is None


def test_vectors_and_testbench_agree_on_the_width_of_a_word() -> None:
    frame = np.array([[0xABCDEF, 1]], dtype=np.uint32)
    sent = Beats.of([frame], [np.array([[0x80, 1]], dtype=np.uint8)])
    video = VideoFormat(answer="class")
    assert stream_vectors(sent, video) == "280abcdef\n101000001\n"
    text = stream_testbench(
        name="x",
        video=video,
        beats=sent,
        registers=video_registers("0" * 64),
        vectors_file="x.hex",
        sources=["x.v"],
    )
    assert "reg [33:0] vectors [0:1];" in text
    video = VideoFormat(answer="class", pixels_per_clock=2, format="mono")
    frame = np.array([[0xAB, 1]], dtype=np.uint32)
    sent = Beats.of([frame], [np.array([[0x80, 1]], dtype=np.uint8)], 2)
    assert stream_vectors(sent, video) == "3018001ab\n"


@pytest.mark.simulator
def test_two_pixels_per_clock_with_registers_are_as_one(
    model: WisardModel, imagery: Path, tmp_path: Path
) -> None:
    options = CompileOptions(target="video", max_width=40, pixels_per_clock=2, stages=2)
    build = compile_model(model, tmp_path / "fast", options, silent)
    assert build.failure is None
    assert build.report["latency"] >= 2
    assert "Registers in its circuits" in (tmp_path / "fast" / "fast.v").read_text()
    picture = tmp_path / "odd.png"
    write_png(picture, read_rgb(imagery / "7.png")[:5, :39])
    result = play(tmp_path / "fast", picture, "icarus", silent)
    assert result.frame is not None
    assert result.frame.shape == (5, 39)
    framed = framed_answers(open_build(tmp_path / "fast")[0], read_rgb(picture))
    assert framed.edges is not None
    assert np.array_equal(result.frame, framed.classes | framed.edges.astype(np.uint8) << 7)


@pytest.mark.simulator
def test_grey_pixels_are_three_equal_channels_and_colours_are_refused(
    model: WisardModel, imagery: Path, tmp_path: Path
) -> None:
    options = CompileOptions(target="video", max_width=64, format="mono", pixels_per_clock=4)
    assert compile_model(model, tmp_path / "grey", options, silent).failure is None
    design, _, report = open_build(tmp_path / "grey")
    assert isinstance(model.encoder, BitSelect)
    greys = np.repeat(np.arange(256, dtype=np.uint8)[:, np.newaxis], 3, axis=1)
    assert report["care"]["codes"] == len(np.unique(model.encoder.codes(greys))) < report["care"]["of"]
    assert report["proof"]["status"] == "proved"
    assert "on every grey pixel." in (tmp_path / "grey" / "grey.v").read_text()
    colours = plan(model, "mine", replace(options, format="GBR"), silent).design
    assert len(design.networks["pixel"].cells) < len(colours.networks["pixel"].cells)
    assert not verify_build(tmp_path / "grey", silent)[0]
    picture = imagery / "7.png"
    with pytest.raises(InputError, match="takes grey pixels"):
        play(tmp_path / "grey", picture, "icarus", silent)
    grey = np.repeat(read_rgb(picture)[:7, :, :1], 3, axis=2)
    write_png(tmp_path / "grey.png", grey)
    result = play(tmp_path / "grey", tmp_path / "grey.png", "icarus", silent)
    assert np.array_equal(result.foreground, PixelClassifier(model).classify(grey) != 0)


def test_grey_pixels_need_grey_imagery_for_a_care_set(model: WisardModel, tmp_path: Path) -> None:
    write_png(tmp_path / "red.png", np.full((4, 4, 3), [[[255, 0, 0]]], dtype=np.uint8))
    options = CompileOptions(target="video", mode="domain", care=tmp_path, format="mono")
    with pytest.raises(InputError, match="no grey pixel"):
        plan(model, "mine", options, silent)


@pytest.mark.simulator
@pytest.mark.parametrize("answer", ["class", "both"])
def test_squares_of_a_picture_are_those_of_the_software(
    neighbours: WisardModel, imagery: Path, tmp_path: Path, answer: Answer
) -> None:
    options = CompileOptions(target="video", max_width=64, square=20, answer=answer, pixels_per_clock=2)
    build = compile_model(neighbours, tmp_path / "squares", options, silent)
    assert build.failure is None
    picture = tmp_path / "odd.png"
    rgb = read_rgb(imagery / "7.png")[:57, :62]
    write_png(picture, rgb)
    result = play(tmp_path / "squares", picture, "icarus", silent)
    classes = model_classifier(neighbours).classify(with_halo(rgb, 2))
    voted = vote(classes, None, side=20, share=1.0, seed=0, count=2)[::20, ::20]
    assert result.squares is not None
    assert result.squares.shape == (3, 4)
    assert np.array_equal(result.squares, voted)
    assert 0 < voted.mean() < 1
    design, files, _ = open_build(tmp_path / "squares")
    frames = sample_frames(design)
    wrong = replace(frames, squares=(*frames.squares[:-1], frames.squares[-1] ^ np.uint8(1)))
    with pytest.raises(CheckError, match="vote at square"):
        simulate_stream(video_part(design), wrong)
    assert design.video is not None
    assert design.registers is not None
    with pytest.raises(CheckError, match=r"icarus disagrees: .*square"):
        run_stream(wrong, design.video, design.registers, design.outermost, files.simulated, "icarus")


def test_squares_are_as_wide_as_whole_beats(model: WisardModel) -> None:
    with pytest.raises(InputError, match="whole beats: --square 5 --pixels-per-clock 2"):
        plan(model, "mine", CompileOptions(target="video", square=5, pixels_per_clock=2), silent)


@pytest.mark.simulator
@pytest.mark.realdata
@pytest.mark.slow
@pytest.mark.parametrize("per_clock", [1, 2, 4])
def test_a_real_chip_of_odd_width_passes_in_verilator(
    model: WisardModel, realdata: Path, tmp_path: Path, per_clock: int
) -> None:
    chip = read_rgb(sorted((realdata / "paper" / "chips").glob("*.jpg"))[0])[:101, :147]
    options = CompileOptions(target="video", max_width=150, pixels_per_clock=per_clock, square=20, effort=0)
    design = plan(model, "real", options, silent).design
    sources = [tmp_path / "cells.v", tmp_path / "core.v"]
    for source, text in zip(
        sources, (cells_model(), verilog(outermost_part(design), prefix="real_", header=())), strict=True
    ):
        source.write_text(text)
    assert design.video is not None
    frame = beats(design, [chip[:7], chip])
    assert design.registers is not None
    run_stream(frame, design.video, design.registers, design.outermost, sources, "verilator")
    # What came out is what the software answers.
    padded = design.video.padded(chip)
    classes = PixelClassifier(model).classify(padded)
    assert design.edges is not None
    edges = design.edges.evaluate(framed_window_codes(classes != 0))
    found = frame.answers.reshape(-1, classes.shape[1])[7:]
    assert np.array_equal(found, classes | edges.astype(np.uint8) << 7)
    assert 0 < classes.mean() < 1
    voted = vote(classes, None, side=20, share=1.0, seed=0, count=2)[::20, ::20]
    assert np.array_equal(frame.squares[1], voted)


@pytest.fixture(scope="module")
def neighbours() -> WisardModel:
    """A model of 5x5 neighbourhoods that tell bright pixels from dark ones, in the middle and around it."""
    draw = np.random.default_rng(3)
    bits = BitSelect(("R7", "G7", "G6", "B7"))
    places = [(2, 2), (2, 2), (0, 2), (4, 2), (2, 0), (2, 4)]
    tables = [draw.permutation(np.arange(16) % 2 == 0) for _ in places[:-2]]
    taps = [Tap.of(*place, bits, tables[i % 4]) for i, place in enumerate(places)]
    counts = np.stack([value := draw.permutation(np.arange(64) % 2), 1 - value])[:, np.newaxis]
    return WisardModel(
        Neighbourhood(5, tuple(taps)),
        ("forest", "deforested"),
        np.arange(6)[np.newaxis, np.newaxis],
        counts,
        1,
    )


def played_as_classified(
    folder: Path, model: WisardModel, halo: int, imagery: Path, mode: Mode
) -> tuple[Playback, NDArray[np.uint8]]:
    """A picture that went through a core, which answered as the model does, and the model's classes."""
    # A care set knows the whole picture with its borders, but not those of a crop.
    crop = np.s_[:37, :61] if mode == "exact" else np.s_[:, :]
    rgb = read_rgb(imagery / "7.png")[crop]
    picture = folder.parent / "picture.png"
    write_png(picture, rgb)
    result = play(folder, picture, "icarus", silent)
    classes = model_classifier(model).classify(with_halo(rgb, halo))
    assert np.array_equal(result.foreground, classes != 0)
    assert 0.1 < result.foreground.mean() < 0.9
    assert result.cared == 1.0
    return result, classes


@pytest.mark.simulator
@pytest.mark.parametrize(("per_clock", "stages", "mode"), [(1, None, "exact"), (2, 2, "domain")])
def test_a_picture_through_a_core_of_neighbourhoods_is_classified_as_by_its_model(
    neighbours: WisardModel, imagery: Path, tmp_path: Path, per_clock: int, stages: int | None, mode: Mode
) -> None:
    options = CompileOptions(
        target="video",
        max_width=64,
        pixels_per_clock=per_clock,
        stages=stages,
        mode=mode,
        care=imagery if mode == "domain" else None,
    )
    build = compile_model(neighbours, tmp_path / "near", options, silent)
    assert build.failure is None
    assert list(build.report["parts"]) == ["taps", "decision", "edge", "video", "ip", "sobel"]
    assert [claim["part"] for claim in build.report["proof"]["claims"]][-3:] == ["taps", "decision", "edge"]
    assert build.report["proof"]["status"] == "proved"
    result, classes = played_as_classified(build.folder, neighbours, 2, imagery, mode)
    design = open_build(tmp_path / "near")[0]
    assert design.edges is not None
    assert result.edges is not None
    edges = design.edges.evaluate(framed_window_codes(classes != 0))
    assert np.array_equal(result.edges, edges)
    if mode == "exact":
        problems, _ = verify_build(tmp_path / "near", silent)
        assert not problems


@pytest.fixture(scope="module")
def counts() -> WisardModel:
    """A model that counts two ratios of channels around a pixel."""
    names = ["R[7:4]>=B[7:4]", "7x7(R[7:4]>=B[7:4])>=20", "7x7(R[7:4]>=B[7:4])>=30", "3x3(G7)>=5", "R7"]
    draw = np.random.default_rng(3)
    answers = np.stack([value := draw.permutation(np.arange(32) % 2), 1 - value])[:, np.newaxis]
    encoder = Context(tuple(names))
    return WisardModel(encoder, ("forest", "deforested"), np.arange(5).reshape(1, 1, 5), answers, 1)


@pytest.mark.simulator
@pytest.mark.parametrize(
    ("answer", "stages", "square", "mode"), [("class", None, 20, "exact"), ("both", 2, None, "domain")]
)
def test_a_picture_through_a_core_that_counts_is_classified_as_by_its_model(
    counts: WisardModel,
    imagery: Path,
    tmp_path: Path,
    answer: Answer,
    stages: int | None,
    square: int | None,
    mode: Mode,
) -> None:
    options = CompileOptions(
        target="video",
        max_width=64,
        answer=answer,
        stages=stages,
        square=square,
        mode=mode,
        care=imagery if mode == "domain" else None,
    )
    build = compile_model(counts, tmp_path / "counts", options, silent)
    assert build.failure is None
    edges = ["edge"] if answer == "both" else []
    assert list(build.report["parts"]) == ["planes", "context", *edges, "video", "ip", "sobel"]
    assert build.report["proof"]["status"] == "proved"
    result, classes = played_as_classified(build.folder, counts, 3, imagery, mode)
    assert result.frame is not None
    assert np.array_equal(result.frame & 127, classes)
    if square:
        assert result.squares is not None
        voted = vote(classes, None, side=square, share=1.0, seed=0, count=2)[::square, ::square]
        assert np.array_equal(result.squares, voted)


def test_a_clock_beyond_that_of_the_core_is_refused(model: WisardModel) -> None:
    with pytest.raises(InputError, match="not made for this clock: 301 MHz"):
        plan(model, "mine", CompileOptions(target="video", clock=301), silent)
