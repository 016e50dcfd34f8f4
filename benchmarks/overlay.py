"""Our map of the reference design's satellite view beside its authors' own, compared square by square.

    python benchmarks/overlay.py PAPER CHIPS TAGS [-o build/overlay.png] [--mappings 20] [--seed 0]

PAPER holds `earthimage.jpg`, the authors' overlay `10_ram_4_bits.jpg`, and their training chips (`chips`,
`regions.csv`). Ours is what the overlay's name says: 10 RAMs of 4 address bits, trained on those chips, the
best of some random mappings; best by the area under the ROC curve on other chips with tags, so that neither
the view nor the overlay has a say. What is evidently tree or open ground is decided by a threshold that a
look at the view confirms; the authors' obvious mistakes are the squares where their map contradicts it.
"""

import argparse
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from sklearn.metrics import cohen_kappa_score

from wnn2hdl.apps.deforestation.overlay import overlay, overlay_palette
from wnn2hdl.dataset import CLASSES, from_regions
from wnn2hdl.encode import high_bits
from wnn2hdl.evaluation.classifiers import model_classifier
from wnn2hdl.evaluation.squares import vote
from wnn2hdl.evaluation.tagged import evaluate_tagged
from wnn2hdl.files import make_folder
from wnn2hdl.images import read_rgb, write_png
from wnn2hdl.ir import WisardModel
from wnn2hdl.markdown import head, row
from wnn2hdl.training.discriminators import image_histograms
from wnn2hdl.wisard import choose_bleaching, draw_mapping, train_histogram

RAMS, ADDRESS_BITS = 10, 4

SIDE = 50
"""Pixels of a square in the authors' overlay (measured; their paper says 20)."""

TREE_RED = 75
"""Crowns and their shadows are less red than this in the view, grass and bare ground more."""

EVIDENTLY_TREE, EVIDENTLY_OPEN = 0.75, 0.1
"""Share of a square's pixels below `TREE_RED`."""

Squares = NDArray[np.bool_]


def main() -> None:
    """Print the comparison and write the pictures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("paper", type=Path)
    parser.add_argument("chips", type=Path)
    parser.add_argument("tags", type=Path)
    parser.add_argument("-o", "--output", type=Path, default=Path("build/overlay.png"))
    parser.add_argument("--mappings", type=int, default=20)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    view = read_rgb(given.paper / "earthimage.jpg")
    drawn = read_rgb(given.paper / "10_ram_4_bits.jpg")
    theirs = majority(drawn[..., 0] > drawn[..., 1])
    trees = share(view[..., 0] < TREE_RED)
    without = "agreement without obvious mistakes"
    print(head(["mapping", "AUC on tagged chips", "agreement", "kappa", without, "kappa"]))
    ranked = []
    for seed in range(given.seed, given.seed + given.mappings):
        model = trained(given.paper, seed, given.seed)
        tagged = evaluate_tagged(model_classifier(model), given.chips, given.tags, given.seed, silent)
        ours = deforested(model, view, SIDE, given.seed)
        print(row([seed, tagged.auc, *figures(theirs, majority(ours), trees)]), flush=True)
        ranked.append((tagged.auc or 0.0, model, ours))
    _, model, ours = max(ranked, key=lambda entry: entry[0])
    small = deforested(model, view, 20, given.seed)
    print(f"\nchosen: mapping {model.training['seed']}; in squares of {SIDE} as theirs:")
    print_kinds(theirs, majority(ours), trees)
    agreement = ", ".join(figures(theirs, majority(small), trees))
    print(f"\nsquares of 20, the majority in each square of theirs: {agreement}")
    make_folder(given.output.parent)
    write_png(given.output, side_by_side(view, drawn, ours, small, theirs))
    print(f"written to {given.output}")


def trained(paper: Path, seed: int, draw: int) -> WisardModel:
    """Ten RAMs of four address bits, trained on the paper's chips with the random mapping of a seed."""
    dataset = from_regions(paper / "regions.csv", paper / "chips", seed=draw)
    encoder = high_bits()
    histograms = image_histograms(dataset, encoder, silent)
    mapping = draw_mapping(encoder.width, RAMS, ADDRESS_BITS, seed)
    threshold = choose_bleaching(histograms, mapping)
    return train_histogram(histograms.sum(axis=0), encoder, CLASSES, mapping, threshold, {"seed": seed})


def deforested(model: WisardModel, view: NDArray[np.uint8], side: int, seed: int) -> NDArray[np.uint8]:
    """The class of each pixel by its square, half of whose pixels vote: uint8 ``[height, width]``."""
    single = model_classifier(model).classify(view)
    return vote(single, None, side=side, share=0.5, seed=seed, count=len(CLASSES))


def share(pixels: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Of each of the authors' squares, the share of its pixels that are set."""
    starts = [np.arange(0, size, SIDE) for size in pixels.shape]
    counts = np.add.reduceat(np.add.reduceat(pixels.astype(np.int64), starts[0], 0), starts[1], 1)
    sizes = [np.diff(np.append(start, size)) for start, size in zip(starts, pixels.shape, strict=True)]
    return np.asarray(counts / np.multiply.outer(*sizes))


def majority(pixels: NDArray[np.generic]) -> Squares:
    """Of each of the authors' squares, whether most of its pixels are set."""
    return share(pixels != 0) > 0.5


def obvious_mistakes(theirs: Squares, trees: NDArray[np.float64]) -> Squares:
    """Squares where the authors' map contradicts what the view evidently shows."""
    return np.asarray((theirs & (trees > EVIDENTLY_TREE)) | (~theirs & (trees < EVIDENTLY_OPEN)))


def figures(theirs: Squares, ours: Squares, trees: NDArray[np.float64]) -> list[str]:
    """Agreement and kappa, on all squares and without the authors' obvious mistakes."""
    cells = []
    for chosen in (np.ones_like(theirs), ~obvious_mistakes(theirs, trees)):
        cells += [(theirs == ours)[chosen].mean(), cohen_kappa_score(theirs[chosen], ours[chosen])]
    return [f"{cell:.3f}" for cell in cells]


def print_kinds(theirs: Squares, ours: Squares, trees: NDArray[np.float64]) -> None:
    """A table of what both say, by what the view shows."""
    kinds = {
        "evidently trees": trees > EVIDENTLY_TREE,
        "evidently open": trees < EVIDENTLY_OPEN,
        "mixed": (trees >= EVIDENTLY_OPEN) & (trees <= EVIDENTLY_TREE),
    }
    print(head(["squares", "all", "both forest", "both deforested", "deforested by them only", "by us only"]))
    for name, kind in kinds.items():
        counts = [
            kind,
            kind & ~theirs & ~ours,
            kind & theirs & ours,
            kind & theirs & ~ours,
            kind & ~theirs & ours,
        ]
        print(row([name, *(int(count.sum()) for count in counts)]))


def side_by_side(
    view: NDArray[np.uint8],
    drawn: NDArray[np.uint8],
    ours: NDArray[np.uint8],
    small: NDArray[np.uint8],
    theirs: Squares,
) -> NDArray[np.uint8]:
    """Above the authors' overlay and ours; below ours in squares of 20, and where the two differ.

    In the last one yellow is deforested by them only, blue by us only.
    """
    everywhere = np.ones(ours.shape, dtype=np.bool_)
    palette = overlay_palette(CLASSES)
    other = majority(ours)
    differ = (view.astype(np.int64) * 2 // 3).astype(np.uint8)
    for only, colour in ((theirs & ~other, (240, 210, 60)), (other & ~theirs, (70, 120, 255))):
        large = np.kron(only, np.ones((SIDE, SIDE), dtype=np.bool_))[: ours.shape[0], : ours.shape[1]]
        differ[large] = (differ[large] * 0.5 + np.array(colour) * 0.5).astype(np.uint8)
    rows = [
        [drawn, overlay(view, ours, everywhere, palette)],
        [overlay(view, small, everywhere, palette), differ],
    ]
    picture = np.concatenate([np.concatenate(row, axis=1) for row in rows])
    half = Image.fromarray(picture).resize((picture.shape[1] // 2, picture.shape[0] // 2))
    return np.asarray(half)


def silent(step: str, done: int, total: int) -> None:
    """No progress is shown."""


if __name__ == "__main__":
    main()
