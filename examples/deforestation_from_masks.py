"""A map of deforestation from pictures with masks, by a circuit of ten LUTs.

Run it as ``python examples/deforestation_from_masks.py [FOLDER]``; the map and the build go there.
"""

import sys
from pathlib import Path

from wnn2hdl.api import compile, evaluate, scan, train  # noqa: A004
from wnn2hdl.images import write_png
from wnn2hdl.samples import landscape


def main(folder: Path) -> None:
    """Train, compile, measure and map."""
    # Any pictures will do: uint8 [height, width, 3], with a class index for each pixel.
    scenes = [landscape(128, 128, seed) for seed in range(6)]
    model = train(
        [scene.image for scene in scenes], [scene.deforested for scene in scenes], luts_per_pixel=1, trials=0
    )
    print(model)

    build = compile(model, folder / "forest")
    print(build)

    # The circuit itself is measured, on landscapes that had no part in the training.
    others = [landscape(128, 128, seed) for seed in (1000, 1001)]
    print(evaluate(build, [other.image for other in others], [other.deforested for other in others]))

    seen = scan(build, landscape(256, 256, 2000).image)
    print(seen)
    write_png(folder / "map.png", seen.overlay)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("build/example"))
