"""The sweep as one HTML page, pictures included, that needs no other file."""

from collections.abc import Sequence
from pathlib import Path

from wnn2hdl.apps.sweep.pictures import draw_all
from wnn2hdl.apps.sweep.pixels import PixelSets
from wnn2hdl.apps.sweep.study import Outcome, circuits
from wnn2hdl.files import write_text
from wnn2hdl.report.drawing import inlined
from wnn2hdl.report.shell import environment

PAGE_FILE = "index.html"

_CAPTIONS = {
    "surface": "Mean accuracy over address bits and RAMs.",
    "contour": "The same as a contour, finalists marked.",
    "cost": "Logarithm of the mean LUTs per pixel.",
    "finalists": "Accuracies of the finalists' valid trials.",
    "pareto": "Circuits by LUTs and accuracy, with the Pareto front.",
}


def present(outcome: Outcome, sets: PixelSets, folder: Path) -> Path:
    """Draw every picture of a finished sweep and write its page.

    Args:
        outcome: what was found.
        sets: what it was found on.
        folder: the sweep's.

    Returns:
        the page.

    Raises:
        InputError: the folder cannot be written.
    """
    clouds = [("grid", circuits(outcome.plan, folder, search=False), outcome.front)]
    if outcome.searched:
        clouds.append(("NSGA-II", circuits(outcome.plan, folder, search=True), outcome.search_front))
    entered = outcome.decision.finalists if outcome.decision else ()
    drawn = draw_all(folder, outcome.surface, [x.cell for x in entered], entered, clouds)
    return write_page(outcome, sets, drawn, folder)


def write_page(outcome: Outcome, sets: PixelSets, pictures: Sequence[str], folder: Path) -> Path:
    """Write `PAGE_FILE` into the folder of a sweep.

    Args:
        outcome: what was found.
        sets: what it was found on.
        pictures: names of the pictures in the folder, as `draw_all` returns them.
        folder: the sweep's.

    Raises:
        InputError: the folder cannot be written.
    """
    template = environment("wnn2hdl.apps.sweep").get_template("sweep.html")
    recipe = outcome.plan.recipe
    least = recipe.care_minimum or 0
    at_least = f" at least {least} times" if least > 1 else ""
    path = folder / PAGE_FILE
    text = template.render(
        **outcome.to_json(),
        architectures=len(outcome.plan.cells),
        pixels=sets.pixels,
        training_images=len(sets.training_images),
        held_out_images=len(sets.held_out_images),
        mode="Circuits equal the classifier on every code"
        if recipe.care_minimum is None
        else "Circuits equal the classifier on the codes that occur in the training images"
        f"{at_least}, and are free elsewhere",
        seed=recipe.seed,
        bits=" ".join(recipe.bits),
        pictures=[
            {
                "svg": inlined((folder / f"{name}.svg").read_text(), _CAPTIONS[name], name, "plot"),
                "caption": _CAPTIONS[name],
            }
            for name in pictures
        ],
    )
    write_text(path, text)
    return path
