"""Speed and memory of a scan: ``python benchmarks/scan.py`` and ``python benchmarks/scan.py --gigapixel``.

Prints megapixels per second of the embedded landscapes on one core and on all: ours, a plain look-up with
NumPy over the whole picture, and scikit-learn's logistic regression and random forest, trained on the same
pixels; in memory (an array to classes), and end to end (a GeoTIFF to a compressed GeoTIFF of classes, without
polygons). Ours also reports the share of colours that the model knows, which the others do not. End to end,
ours is the `wnn2hdl scan` command with everything it writes but polygons.

``--gigapixel`` makes a GeoTIFF of 31,744 x 31,744 pixels in a temporary folder and scans it with the command,
squares and polygons included; it prints time and peak memory. It takes 4 GB of disk.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import rasterio
from numpy.typing import NDArray
from rasterio.windows import Window as RasterWindow
from sklearn.ensemble import RandomForestClassifier
from sklearn.linear_model import LogisticRegression
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import PolynomialFeatures, StandardScaler

from wnn2hdl.apps.deforestation.classify import Method, classify_window
from wnn2hdl.apps.deforestation.windows import cut
from wnn2hdl.dataset import from_samples
from wnn2hdl.encode import high_bits
from wnn2hdl.evaluation.classifiers import PixelTable, model_classifier
from wnn2hdl.images import PlainPicture
from wnn2hdl.samples import landscape
from wnn2hdl.training.discriminators import train

TILE = 1024
"""Side of a generated landscape; larger pictures are laid of several, so that they are made quickly."""

LANDSCAPES = 16
SIDE = 4096
FOREST_SIDE = 1024
"""The random forest is measured on this much: it is that slow."""

GIGAPIXEL_SIDE = 31 * TILE
TRAINING_PIXELS = 60_000
TREES = 100
REPEATS = 3

Answer = Callable[[NDArray[np.uint8]], NDArray[np.uint8]]


def tiles() -> list[NDArray[np.uint8]]:
    """The landscapes that pictures are laid of."""
    return [landscape(TILE, TILE, seed).image for seed in range(LANDSCAPES)]


def write_scene(path: Path, side: int, pictures: list[NDArray[np.uint8]]) -> None:
    """A GeoTIFF of ``side`` pixels squared: tiled, compressed, 10 m per pixel in UTM."""
    options = {"driver": "GTiff", "count": 3, "height": side, "width": side, "dtype": "uint8"}
    layout = {
        "tiled": True,
        "blockxsize": 512,
        "blockysize": 512,
        "photometric": "rgb",
        "bigtiff": "if_safer",
    }
    place = {"crs": "EPSG:32720", "transform": rasterio.Affine(10, 0, 300_000, 0, -10, 9_100_000)}
    choice = np.random.default_rng(0)
    with rasterio.open(
        path, "w", **options, **layout, **place, compress="deflate", zlevel=1, num_threads="all_cpus"
    ) as target:
        for row in range(0, side, TILE):
            for column in range(0, side, TILE):
                picture = pictures[choice.integers(len(pictures))]
                window = RasterWindow(column, row, TILE, TILE)
                target.write(np.moveaxis(picture, 2, 0), window=window)


def rivals() -> tuple[PixelTable, dict[str, Answer]]:
    """Ours, and what it is compared with, trained on the same landscapes."""
    dataset = from_samples(12, 256, seed=0)
    model = train(
        dataset, high_bits(), address_bits=4, rams=16, bleaching=None, seed=0, progress=lambda *_: None
    )
    ours = model_classifier(model)
    assert isinstance(ours, PixelTable)
    pixels = np.concatenate([image.pixels for image in dataset])
    labels = np.concatenate([image.labels for image in dataset])
    chosen = np.random.default_rng(0).choice(len(pixels), TRAINING_PIXELS, replace=False)
    logistic = make_pipeline(PolynomialFeatures(2), StandardScaler(), LogisticRegression(max_iter=1000))
    forest = RandomForestClassifier(TREES, random_state=0, n_jobs=-1)
    for estimator in (logistic, forest):
        estimator.fit(pixels[chosen], labels[chosen])
    # In strips, since its squares of colours take 80 bytes per pixel.
    answers: dict[str, Answer] = {
        "NumPy look-up": ours.classify,
        "logistic regression": lambda picture: np.concatenate(
            [logistic.predict(strip.reshape(-1, 3)) for strip in np.array_split(picture, 16)]
        ).reshape(picture.shape[:2]),
        "random forest": lambda picture: forest.predict(picture.reshape(-1, 3)).reshape(picture.shape[:2]),
    }
    return ours, answers


def scan_in_memory(ours: PixelTable, picture: NDArray[np.uint8], method: Method, jobs: int) -> None:
    """All that `scan` does to a picture's windows, from array to compressed classes."""
    source = PlainPicture(picture)
    windows = [
        window for band in cut(source.height, source.width, (512, 512), method.side) for window in band
    ]
    with ThreadPoolExecutor(jobs) as pool:
        list(pool.map(lambda window: classify_window(source, ours, method, window), windows))


def best(work: Callable[[], object]) -> float:
    """Seconds of the quickest of some runs."""
    seconds = []
    for _ in range(REPEATS):
        started = time.perf_counter()
        work()
        seconds.append(time.perf_counter() - started)
    return min(seconds)


def in_memory(cores: int) -> None:
    """Print speeds from array to classes."""
    ours, answers = rivals()
    row = tiles()[: SIDE // TILE]
    picture = np.tile(np.concatenate(row, axis=1), (SIDE // TILE, 1, 1))
    size = picture.shape[0] * picture.shape[1] / 1e6
    for label, method in (("ours, pixels", Method()), ("ours, squares of 20", Method(square=20))):
        for jobs in sorted({1, cores}):
            seconds = best(lambda m=method, j=jobs: scan_in_memory(ours, picture, m, j))  # type: ignore[misc]
            print(
                f"in memory: {label}, {jobs} threads: {size / seconds:.1f} megapixels per second", flush=True
            )
    for name, answer in answers.items():
        part = picture[:FOREST_SIDE, :FOREST_SIDE] if "forest" in name else picture
        seconds = best(lambda a=answer, p=part: a(p))  # type: ignore[misc]
        speed = part.shape[0] * part.shape[1] / 1e6 / seconds
        print(f"in memory: {name}: {speed:.2f} megapixels per second", flush=True)


def plain_scan(name: str, source: Path, output: Path) -> None:
    """A rival end to end: read the raster, answer, write classes."""
    _, answers = rivals()
    started = time.perf_counter()
    with rasterio.open(source) as scene:
        profile = scene.profile | {"count": 1, "photometric": "minisblack", "compress": "deflate"}
        side = FOREST_SIDE if "forest" in name else SIDE
        picture = np.moveaxis(scene.read(window=((0, side), (0, side))), 0, 2)
    with rasterio.open(output, "w", **profile | {"height": side, "width": side}) as target:
        target.write(answers[name](picture).astype(np.uint8), 1)
    seconds = time.perf_counter() - started
    print(f"{side * side / 1e6 / seconds:.2f}", flush=True)


def run(command: list[str], cores: int) -> tuple[str, float, str]:
    """Standard output and seconds of a child process on this many cores, and what it took of the machine.

    Seconds of the processor tell the speed even where other programs were running.
    """
    allowed = sorted(os.sched_getaffinity(0))[:cores]
    started = time.perf_counter()
    child = subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        preexec_fn=lambda: os.sched_setaffinity(0, allowed),
    )
    assert child.stdout is not None
    output = child.stdout.read()
    _, status, usage = os.wait4(child.pid, 0)
    seconds = time.perf_counter() - started
    child.returncode = os.waitstatus_to_exitcode(status)
    assert child.returncode == 0
    processor = usage.ru_utime + usage.ru_stime
    return (
        output,
        seconds,
        f"{processor:.1f} s of processor time, peak memory {usage.ru_maxrss / 1024:.0f} MB",
    )


def scan_command(model: Path, scene: Path, output: Path, *options: str) -> list[str]:
    """The command line as users start it."""
    program = "import sys; from wnn2hdl.cli import main; sys.exit(main())"
    return [sys.executable, "-c", program, "scan", str(model), str(scene), "-o", str(output), *options]


def save_model(folder: Path) -> Path:
    """The model file that the command scans with."""
    model = train(
        from_samples(12, 256, seed=0),
        high_bits(),
        address_bits=4,
        rams=16,
        bleaching=None,
        seed=0,
        progress=lambda *_: None,
    )
    model.save(folder / "model.json")
    return folder / "model.json"


def end_to_end(folder: Path, cores: int) -> None:
    """Print speeds from file to file."""
    scene, model = folder / "scene.tif", save_model(folder)
    write_scene(scene, SIDE, tiles())
    for count in sorted({1, cores}):
        for label, options in (("pixels", []), ("squares of 20", ["--square", "20"])):
            output = folder / f"{label}-{count}"
            command = scan_command(model, scene, output, "--vector", "none", *options)
            _, seconds, taken = run(command, count)
            print(
                f"end to end: ours, {label}, {count} cores: {SIDE * SIDE / 1e6 / seconds:.1f} megapixels a "
                f"second, start of the command and overlay included; {taken}",
                flush=True,
            )
        for name in ("NumPy look-up", "logistic regression", "random forest"):
            rival = [sys.executable, __file__, "--rival", name, str(scene), str(folder / "rival.tif")]
            speed, _, taken = run(rival, count)
            print(
                f"end to end: {name}, {count} cores: {speed.strip()} megapixels per second, "
                f"without the start; "
                f"{taken}, training included",
                flush=True,
            )


def gigapixel(folder: Path, cores: int) -> None:
    """Print time and memory of a scan of 10**9 pixels."""
    scene, model = folder / "scene.tif", save_model(folder)
    started = time.perf_counter()
    write_scene(scene, GIGAPIXEL_SIDE, tiles())
    print(
        f"{GIGAPIXEL_SIDE:,} x {GIGAPIXEL_SIDE:,} pixels made in {time.perf_counter() - started:.0f} s, "
        f"{scene.stat().st_size / 1e9:.2f} GB",
        flush=True,
    )
    _, seconds, taken = run(scan_command(model, scene, folder / "map", "--square", "20"), cores)
    print((folder / "map" / "summary.md").read_text(encoding="utf-8"))
    for file in sorted((folder / "map").iterdir()):
        print(f"{file.name}: {file.stat().st_size / 1e6:.1f} MB")
    print(
        f"scanned end to end in {seconds:.0f} s, {GIGAPIXEL_SIDE**2 / 1e6 / seconds:.1f} megapixels a "
        f"second; {taken}"
    )


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--gigapixel", action="store_true")
    parser.add_argument("--rival", nargs=3, metavar=("NAME", "SCENE", "OUTPUT"), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.rival:
        name, source, output = options.rival
        plain_scan(name, Path(source), Path(output))
        return
    cores = len(os.sched_getaffinity(0))
    print(f"load average before: {os.getloadavg()[0]:.1f} on {cores} cores")
    with tempfile.TemporaryDirectory() as folder:
        if options.gigapixel:
            gigapixel(Path(folder), cores)
            return
        in_memory(cores)
        end_to_end(Path(folder), cores)


if __name__ == "__main__":
    main()
