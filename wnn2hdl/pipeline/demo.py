"""The main job on the embedded default: landscapes to proved Verilog, without a file of the user's."""

from dataclasses import dataclass
from pathlib import Path

from wnn2hdl.dataset import from_samples
from wnn2hdl.encode import high_bits
from wnn2hdl.images import write_png
from wnn2hdl.ir.files import make_folder
from wnn2hdl.pipeline.budget import train_under_budget
from wnn2hdl.pipeline.compile import Build, compile_model
from wnn2hdl.pipeline.planning import CompileOptions
from wnn2hdl.pipeline.playback import Playback, play
from wnn2hdl.pipeline.training import Progress, train
from wnn2hdl.samples import landscape

SIDE = 256
TRAINING_SEED, TRAINING_IMAGES = 0, 12
TEST_SEED, TEST_IMAGES = 1000, 4
"""Landscapes to train on, and others to test on: different seeds, so no image is in both."""

MAX_LUTS = 2


@dataclass(frozen=True, eq=False)
class Demo:
    """What the demo made.

    Attributes:
        reference: the reference design's discriminators (n = 4, k = 16), in domain mode.
        smallest: the most accurate classifier of at most `MAX_LUTS` LUTs a pixel, on every input.
        playback: a landscape through the smallest circuit.
        pictures: the landscape, its foreground and its edges.
    """

    reference: Build
    smallest: Build
    playback: Playback
    pictures: tuple[Path, ...]


def run_demo(folder: Path, seed: int, progress: Progress) -> Demo:
    """Generate landscapes, train two classifiers, compile both, run a picture through the smaller one.

    Args:
        folder: gets ``reference`` and ``smallest``, two builds, and ``pictures``.
        seed: of the tuple mapping.
        progress: told of every stage.

    Raises:
        ToolError: an outside program is missing or failed.
    """
    training = from_samples(TRAINING_IMAGES, SIDE, seed=TRAINING_SEED)
    test = from_samples(TEST_IMAGES, SIDE, seed=TEST_SEED)
    imagery, pictures = folder / "imagery", folder / "pictures"
    for path in (imagery, pictures):
        make_folder(path)
    for i in range(TRAINING_IMAGES):
        write_png(imagery / f"landscape-{i:02d}.png", landscape(SIDE, SIDE, TRAINING_SEED + i).image)
    model = train(
        training, high_bits(), address_bits=4, rams=16, bleaching=None, seed=seed, progress=progress
    )
    options = CompileOptions(mode="domain", care=imagery)
    reference = compile_model(model, folder / "reference", options, progress, test)
    small = train_under_budget(training, MAX_LUTS, trials=0, seed=seed, progress=progress)
    smallest = compile_model(small, folder / "smallest", CompileOptions(), progress, test)
    scene = pictures / "landscape.png"
    write_png(scene, landscape(SIDE, SIDE, TEST_SEED).image)
    playback = play(folder / "smallest", scene, "amaranth", progress)
    answers = {"foreground": playback.foreground, "edges": playback.edges}
    for name, flags in answers.items():
        write_png(pictures / f"{name}.png", flags)
    return Demo(reference, smallest, playback, (scene, *(pictures / f"{name}.png" for name in answers)))
