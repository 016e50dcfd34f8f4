"""Template matching, ours against OpenCV's matchTemplate: ``python benchmarks/matching.py [paper/edges]``.

A frame of 220 x 220 edges in a whole map of 9872 x 10386, a sequence of 35 frames over this map, and windows
of 599 x 599, on one core. The map is Canny's edges of generated landscapes, laid side by side, each rolled,
flipped and turned differently, with noise over all; frames are cut out of it, bent by up to 1.5 pixels, a
part of their edges dropped and as many false ones added. Seconds are the process's own on one core, so that
other load matters less. Memory is what an index holds, and the peak of the whole process at the end.

With the folder of the reference's published edges (``uav_NN.png`` in ``map_NN.png``), each is matched in its
window. Their true offsets were not published, so no error can be stated.
"""

import resource
import sys
import time
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from wnn2hdl.apps.navigation.matching import MapIndex, Match, Score, Window
from wnn2hdl.edges import canny, grey
from wnn2hdl.images import read_rgb
from wnn2hdl.samples import landscape

MAP = 9872, 10386
FRAME = 220
SEQUENCE = 35
TILE = 1500
NOISE = 0.02
RIVALS: dict[Score, int] = {"correlation": cv2.TM_CCORR, "ncc": cv2.TM_CCOEFF_NORMED}
DAMAGE = (0.25, 0.5)
"""Shares of a frame's edges that are dropped, and replaced by as many false ones."""

Bits = NDArray[np.bool_]


def make_map() -> Bits:
    """Edges of four landscapes, tiled with differing offsets and orientations, and noise over all."""
    rng = np.random.default_rng(0)
    edges = [np.pad(canny(grey(landscape(TILE, TILE, seed).image)), 1) for seed in range(4)]
    whole = np.zeros(MAP, dtype=np.bool_)
    for top in range(0, MAP[0], TILE):
        for left in range(0, MAP[1], TILE):
            tile = np.rot90(edges[rng.integers(4)], int(rng.integers(4)))
            tile = np.roll(tile[:, :: rng.choice((-1, 1))], rng.integers(0, TILE, 2), axis=(0, 1))
            part = whole[top : top + TILE, left : left + TILE]
            part[:] = tile[: part.shape[0], : part.shape[1]]
    for top in range(0, MAP[0], TILE):
        part = whole[top : top + TILE]
        part ^= rng.random(part.shape, dtype=np.float32) < NOISE
    return whole


def take_frame(whole: Bits, row: int, col: int, damage: float, rng: np.random.Generator) -> Bits:
    """A piece of the map, bent and damaged."""
    margin = 8
    piece = whole[row - margin : row + FRAME + margin, col - margin : col + FRAME + margin].astype(np.uint8)
    y, x = np.indices(piece.shape, dtype=np.float32)
    bend = [1.5 * np.sin(axis / 45 + phase) for axis, phase in zip((x, y), rng.uniform(0, 6, 2), strict=True)]
    bent = cv2.remap(piece, x + bend[1].astype(np.float32), y + bend[0].astype(np.float32), cv2.INTER_NEAREST)
    frame = np.asarray(bent[margin:-margin, margin:-margin] > 0)
    share = float(frame.mean())
    kept = frame & (rng.random(frame.shape) >= damage)
    return np.asarray(kept | (rng.random(frame.shape) < damage * share))


def rival(whole: NDArray[np.uint8], frame: Bits, method: int) -> tuple[int, int]:
    """The winner of matchTemplate."""
    scores = cv2.matchTemplate(whole, frame.astype(np.uint8), method)
    col, row = cv2.minMaxLoc(scores)[3]
    return row, col


def place(match: Match | None) -> tuple[int, int]:
    """The winner of ours."""
    return (match.row, match.col) if match is not None else (-1, -1)


def whole_map(whole: Bits) -> None:
    """One frame and a sequence over the whole map."""
    rng = np.random.default_rng(1)
    places = [(int(row), int(col)) for row, col in rng.integers(20, 9600, (SEQUENCE, 2))]
    raw = whole.astype(np.uint8)
    for damage in DAMAGE:
        frames = [take_frame(whole, row, col, damage, rng) for row, col in places]
        for score, method in RIVALS.items():
            started = time.process_time()
            theirs = [rival(raw, frame, method) for frame in frames]
            their_seconds = time.process_time() - started
            for reduction in (2, 4):
                index = MapIndex(whole, reduction=reduction)
                seconds, ours = [], []
                for frame in frames:
                    started = time.process_time()
                    ours.append(place(index.search(frame, score=score, min_overlap=1)))
                    seconds.append(time.process_time() - started)
                right = sum(
                    max(abs(row - true[0]), abs(col - true[1])) <= 5
                    for (row, col), true in zip(ours, places, strict=True)
                )
                same = sum(one == other for one, other in zip(ours, theirs, strict=True))
                print(
                    f"damage {damage:.0%}, {score}, reduction {reduction}: "
                    f"first frame {seconds[0]:.2f} s, sequence {sum(seconds):.1f} s, matchTemplate "
                    f"{their_seconds / SEQUENCE:.2f} s and {their_seconds:.1f} s: "
                    f"{their_seconds / sum(seconds):.1f} times as fast; same winner {same} of {SEQUENCE}, "
                    f"right {right}; index {index.nbytes / 1e6:.0f} MB",
                    flush=True,
                )


def windows(whole: Bits) -> None:
    """Frames per second in windows of 599 x 599."""
    rng = np.random.default_rng(2)
    index = MapIndex(whole)
    mask = np.ones((FRAME, FRAME), dtype=np.bool_)
    places = [(int(row), int(col)) for row, col in rng.integers(400, 9200, (SEQUENCE, 2))]
    frames = [take_frame(whole, row, col, 0.3, rng) for row, col in places]
    for score in ("correlation", "ncc", "match_count"):
        started = time.process_time()
        ours = [
            place(index.search(frame, mask, score, Window(row - 190, col - 190, row + 190, col + 190)))
            for frame, (row, col) in zip(frames, places, strict=True)
        ]
        rate = SEQUENCE / (time.process_time() - started)
        line = f"window, {score}: {rate:.0f} frames per second"
        if score in RIVALS:
            started = time.process_time()
            theirs = []
            for frame, (row, col) in zip(frames, places, strict=True):
                window = whole[row - 190 : row + 409, col - 190 : col + 409].astype(np.uint8)
                found = rival(window, frame, RIVALS[score])
                theirs.append((found[0] + row - 190, found[1] + col - 190))
            rate = SEQUENCE / (time.process_time() - started)
            same = sum(one == other for one, other in zip(ours, theirs, strict=True))
            line += f", matchTemplate {rate:.0f}; same winner {same} of {SEQUENCE}"
        print(line, flush=True)


def published(folder: Path) -> None:
    """The reference's edge images in their windows: peaks and confidences."""
    for score in ("correlation", "ncc", "match_count"):
        matches = []
        for file in sorted(folder.glob("uav_*.png")):
            edges, frame = (
                read_rgb(file.with_name(file.name.replace("uav", kind)))[..., 0] > 127
                for kind in ("map", "uav")
            )
            match = MapIndex(edges).search(frame, score=score, min_overlap=1)
            if match is not None:
                matches.append(match)
                print(
                    f"{file.stem} {score}: row {match.row}, col {match.col}, score {match.score:.4g}, "
                    f"psr {match.psr:.2f}, margin {match.margin:.2f}, confidence {match.confidence:.2f}"
                )
        confidences = [match.confidence for match in matches]
        low, middle, high = np.percentile(confidences, (10, 50, 90))
        print(
            f"{score}: {len(matches)} matches, confidence {low:.2f}, {middle:.2f}, {high:.2f} (10, 50, 90 %)"
        )


if __name__ == "__main__":
    cv2.setNumThreads(1)
    if len(sys.argv) > 1:
        published(Path(sys.argv[1]))
    else:
        its_map = make_map()
        print(f"map of {MAP[0]} x {MAP[1]}, {its_map.mean():.1%} edges", flush=True)
        windows(its_map)
        whole_map(its_map)
        print(f"peak of the process: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6:.2f} GB")
