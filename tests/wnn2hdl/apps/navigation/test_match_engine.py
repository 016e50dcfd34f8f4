"""Frames of a flight, located as a match engine locates them: in Verilator, and bit by bit."""

from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from hdl_templates.ip import EngineIp
from wnn2hdl.apps.navigation.camera import Camera
from wnn2hdl.apps.navigation.geometry import ground_patch
from wnn2hdl.apps.navigation.grid import MapGrid
from wnn2hdl.apps.navigation.matching import Match, SegmentIndex, Window
from wnn2hdl.apps.navigation.matching.spectra import cut
from wnn2hdl.apps.navigation.methods import brighter, compared_methods, engine_of, outlines
from wnn2hdl.apps.navigation.navigator import Navigator
from wnn2hdl.apps.navigation.poses import frame_files, read_poses
from wnn2hdl.apps.navigation.recording import Recording, poses_of
from wnn2hdl.apps.navigation.weightless import GSD_M, by_rule
from wnn2hdl.apps.navigation.world import WorldMap
from wnn2hdl.elaborate import match_engine
from wnn2hdl.emit import cells_model, engine_testbench, engine_vectors, verilog
from wnn2hdl.errors import InputError
from wnn2hdl.ir.engine import EngineFormat, Round
from wnn2hdl.ir.registers import engine_registers
from wnn2hdl.lower.deforestation import engine as engine_circuit
from wnn2hdl.lower.deforestation import lane
from wnn2hdl.samples.flight import make_flight
from wnn2hdl.schedule import for_clock, pipelined
from wnn2hdl.tools import run_verilator

Bits = NDArray[np.bool_]


def frames(recording: Recording, grid: MapGrid) -> Iterator[tuple[Bits, Bits, Window]]:
    """Bits of each frame, which of them count, and the window around where it was."""
    for pose in recording.poses:
        patch = ground_patch(recording.read(pose), pose, recording.camera, grid.gsd_m)
        row, column = (float(axis) for axis in grid.to_pixel(pose.latitude_deg, pose.longitude_deg))
        window = Window.around(row - patch.nadir_row, column - patch.nadir_col, 16)
        yield *brighter(patch.image, patch.valid, side=by_rule().side), window


def counted(engine: EngineFormat, index: SegmentIndex, template: Bits, mask: Bits, window: Window) -> Round:
    """What an engine is given for a frame whose positions take a single segment."""
    row, column = index.piece(mask)
    moved = Window(window.top + row, window.left + column, window.bottom + row, window.right + column)
    (segment,) = index.segments(moved)
    return Round(segment.bits, cut(template & mask, row, column, engine.template))


@pytest.mark.simulator
@pytest.mark.slow
def test_the_verilog_names_the_places_that_locate_names(tmp_path: Path) -> None:
    flight = make_flight(4, (600, 600), frames=3, frame_size=(150, 260), height_m=60)
    world = WorldMap.of_array(flight.map_image, flight.transform, f"EPSG:{flight.epsg}")
    numbers = {pose.frame: number for number, pose in enumerate(poses_of(flight))}
    recording = Recording(
        "rendered",
        world,
        Camera.of_focal(flight.camera.focal_px, 260, 150),
        poses_of(flight),
        lambda pose: flight.frame(numbers[pose.frame]),
    )
    grid = world.resampled(GSD_M)
    engine = EngineFormat((12, 16), (44, 48), lanes=11, columns=16)
    bits, valid = brighter(grid.image, grid.valid, side=by_rule().side)
    index = SegmentIndex(bits, valid, engine=engine)
    rounds, matches = [], []
    for template, mask, window in frames(recording, grid):
        rounds.append(counted(engine, index, template, mask, window))
        matches.append((index.search(template, mask, window=window), index.piece(mask), window))
    for (match, piece, window), answer in zip(matches, engine.answers(rounds), strict=True):
        assert match is not None
        top, left = window.top + piece[0], window.left + piece[1]
        assert (match.row + piece[0] - top, match.col + piece[1] - left) == answer.best
        assert match.score == answer.score

    circuit = engine_circuit(lane(engine.columns))
    circuit = pipelined(circuit, for_clock(circuit, 100.0))
    core = match_engine(circuit, engine, style="cells")
    registers = engine_registers(engine, "0" * 64)
    bench = engine_testbench(
        name="my_ip",
        engine=engine,
        cycles=engine.cycles(core.lanes[0].latency),
        rounds=rounds,
        registers=registers,
        vectors_file="vectors.hex",
        sources=["my.v"],
    )
    texts = {
        "my.v": verilog(EngineIp(core=core, registers=registers), prefix="my_", header=[]),
        "cells.v": cells_model(),
        "my_ip_tb.v": bench,
        "vectors.hex": engine_vectors(engine, rounds),
    }
    for name, text in texts.items():
        (tmp_path / name).write_text(text)
    sources = [tmp_path / name for name in texts if name.endswith(".v")]
    assert "PASS" in run_verilator(sources, "my_ip_tb", cwd=tmp_path, timeout=300).output


@pytest.mark.realdata
def test_the_real_flight_is_answered_by_the_definition(realdata: Path) -> None:
    """Counts of a loop over positions, without any transform."""
    folder = realdata / "flight_fengyuan"
    poses = read_poses(folder / "poses.csv")[::10]
    recording = Recording.of_files(folder / "map.tif", frame_files(poses, folder / "frames"), 750.0)
    grid = recording.world.resampled(GSD_M)
    engine = engine_of((32, 32), (64, 64), ["engine"])
    assert engine is not None
    bits, valid = brighter(grid.image, grid.valid, side=by_rule().side)
    index = SegmentIndex(bits, valid, engine=engine)
    for template, mask, window in frames(recording, grid):
        match = index.search(template, mask, window=window)
        assert match is not None
        given = counted(engine, index, template, mask, window)
        assert given.segment is not None
        scores = np.array(
            [
                [
                    np.count_nonzero(given.template == given.segment[row : row + 32, column : column + 32])
                    for column in range(33)
                ]
                for row in range(33)
            ]
        )
        assert divmod(int(scores.argmax()), 33) == (match.row - window.top, match.col - window.left)
        assert match.score == scores.max()
        assert match.mean == pytest.approx(scores.mean())


def test_the_navigator_locates_by_an_engine() -> None:
    flight = make_flight(2, (500, 500), frames=1, frame_size=(180, 320), height_m=60, tilt_deg=6)
    world = WorldMap.of_array(flight.map_image, flight.transform, f"EPSG:{flight.epsg}")
    grids = {None: world.resampled(), GSD_M: world.resampled(GSD_M)}
    keys = ["engine", "engine-edges"]
    engine = engine_of((16, 20), (48, 52), keys)
    methods = compared_methods(by_rule(), keys, engine)
    assert [method.key for method in methods] == keys
    pose, lens = poses_of(flight)[0], flight.camera
    camera = Camera.of_focal(lens.focal_px, lens.width, lens.height, lens.tilt_deg)
    window = (pose.latitude_deg, pose.longitude_deg, 32.0)
    found = Navigator(grids, methods).locate(
        flight.frame(0), pose, (camera,), {"window": window, "map": None}
    )
    located = found["map", "engine"]
    assert located is not None
    grid = grids[None]
    truth = grid.to_metres(*grid.to_pixel(pose.latitude_deg, pose.longitude_deg))
    assert np.hypot(located.places[0][0] - truth[0], located.places[0][1] - truth[1]) < 6
    assert isinstance(located.match, Match)


@pytest.mark.parametrize(
    ("sizes", "keys", "fault"),
    [
        ((None, (64, 64)), ["engine"], "has a template and a segment"),
        ((None, None), ["engine", "grey"], "has a template and a segment"),
        (((32, 32), (64, 64)), ["grey"], "--template and --segment are for a match engine"),
        (
            ((64, 64), (32, 64)),
            ["engine"],
            "no such match engine: a template of 64x64 does not move",
        ),
    ],
)
def test_sizes_that_do_not_fit_are_refused(
    sizes: tuple[tuple[int, int] | None, tuple[int, int] | None], keys: list[str], fault: str
) -> None:
    with pytest.raises(InputError) as refused:
        engine_of(*sizes, keys)
    assert fault in refused.value.line()


@pytest.mark.parametrize("describe", [brighter, outlines])
def test_bits_tell_what_is_brighter_than_its_surroundings(describe: object) -> None:
    assert callable(describe)
    picture = np.full((40, 40, 3), 40, dtype=np.uint8)
    picture[10:20, 10:20] = 200
    valid = np.ones((40, 40), dtype=np.bool_)
    bits, inside = partial(describe, side=15)(picture, valid)
    rows, columns = np.nonzero(bits)
    assert rows.min() == columns.min() == 10
    assert rows.max() == columns.max() == 19
    assert bool(bits[15, 15]) is (describe is brighter)
    assert inside[5:35, 5:35].all()
