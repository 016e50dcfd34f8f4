"""The embedded landscapes as a folder of files, laid out as the commands read them."""

from pathlib import Path

import numpy as np

from wnn2hdl.files import make_folder, output_folder, write_json
from wnn2hdl.images import Palette, write_png
from wnn2hdl.progress import Progress, reported
from wnn2hdl.samples import CLASSES, landscape

IMAGES, MASKS, KINDS, PALETTE = "images", "masks", "kinds", "palette.json"


def write_landscapes(folder: Path, count: int, side: int, *, seed: int, progress: Progress) -> None:
    """Write landscapes and their labels.

    `IMAGES` gets the pictures; `MASKS` their masks of two classes, 0 forest and 255 deforested; `KINDS` their
    masks of all `wnn2hdl.samples.CLASSES`, in the colours that `PALETTE` names. All of one landscape have the
    same name.

    Args:
        folder: gets the three folders and the file; files of the same names are replaced.
        count: landscapes.
        side: their height and width in pixels.
        seed: of the first; the others follow.
        progress: called with each landscape.

    Raises:
        InputError: a side without pixels, a negative seed, or a folder that cannot be written.
    """
    palette = Palette.of(CLASSES)
    with output_folder(folder, "set of landscapes"):
        for name in (IMAGES, MASKS, KINDS):
            make_folder(folder / name)
        for i in reported(range(count), "landscapes", count, progress):
            scene = landscape(side, side, seed + i)
            name = f"landscape-{seed + i:05d}.png"
            write_png(folder / IMAGES / name, scene.image)
            write_png(folder / MASKS / name, scene.deforested.astype(np.uint8) * 255)
            write_png(folder / KINDS / name, palette.paint(scene.labels))
        write_json(folder / PALETTE, palette.to_json())
