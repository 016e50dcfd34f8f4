"""The compiler from Python: a classifier from arrays of pixels, its table, its LUTs and a proved build.

Run it as ``python examples/from_arrays_to_verilog.py [FOLDER]``; the build goes to ``build/example``.
"""

import sys
from pathlib import Path

import numpy as np

from wnn2hdl.build.compile import compile_model
from wnn2hdl.build.planning import CompileOptions
from wnn2hdl.encode import parse_bits
from wnn2hdl.lower.table import pixel_table
from wnn2hdl.minimise import espresso, map_luts
from wnn2hdl.samples import landscape
from wnn2hdl.wisard import PixelClassifier, draw_mapping, train_histogram


def main(folder: Path) -> None:
    """Train on one landscape, look at each stage, compile, and judge on another landscape."""
    # Any pixels with labels will do: uint8 [n, 3] and a class index each.
    scene = landscape(256, 256, seed=1)
    pixels, labels = scene.image.reshape(-1, 3), scene.deforested.ravel()

    # Which bits of a pixel the network reads, and how often each code occurs in each class.
    encoder = parse_bits("R7,R6,R5,R4,G7,G6,G5,B7,B6,B5")
    codes = encoder.codes(pixels)
    histogram = np.stack([np.bincount(codes[labels == c], minlength=1 << encoder.width) for c in (0, 1)])

    # Sixteen RAMs of four address bits for each class; a RAM fires from 50 sightings of an address on.
    mapping = draw_mapping(encoder.width, 16, 4, seed=0)
    model = train_histogram(histogram, encoder, ("forest", "deforested"), mapping, bleaching=50)
    print(f"{model.rams} RAMs of {model.address_bits} address bits, {model.saturation.mean():.0%} set")

    # The whole network as one table; codes that never occur are free.
    table = pixel_table(model, care=histogram.sum(axis=0) > 0)
    cover, network = espresso(table).cover, map_luts(table).network
    print(f"{table.care.sum()} of {len(table.care)} codes occur")
    print(f"{len(cover.cubes)} cubes, {len(network.cells)} cells per pixel")

    # A build folder: Verilog, testbench, proof, counts.
    build = compile_model(model, folder, CompileOptions(target="pixel"), lambda *_: None)
    print(f"pixel: {build.report['parts']['pixel']['luts']} LUTs, {build.report['proof']['status']}")

    other = landscape(256, 256, seed=2)
    answers = PixelClassifier(model).classify(other.image)
    print(f"{np.mean((answers != 0) == other.deforested):.1%} right on another landscape")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("build/example"))
