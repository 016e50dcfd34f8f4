"""A grid of architectures, each trained several times, compiled and counted, and one of them chosen.

Run it as ``python examples/a_sweep.py [FOLDER]``; records, plots and a page go there. If it is killed, the
same command continues where it stopped.
"""

import sys
from dataclasses import replace
from pathlib import Path

from wnn2hdl.api import Model, silent
from wnn2hdl.apps.sweep import (
    Recipe,
    draw,
    find_trial,
    grid,
    present,
    rebuild,
    run_locally,
    run_sweep,
    seen_colours,
)
from wnn2hdl.dataset import from_samples
from wnn2hdl.encode import high_bits


def main(folder: Path) -> None:
    """Sweep over six architectures, and keep the best model of the architecture that was chosen."""
    # Half of the landscapes are trained on, the others are held out. `from_masks` reads pictures of your own.
    sets = draw(from_samples(6, 128, seed=0), pixels=4000, seed=0, progress=silent)
    recipe = Recipe(seed=0, bits=high_bits().bits, bleaching=None, care_minimum=1)
    plan = grid(recipe, address_bits=(2, 3, 4), rams=(4, 16), trials=5)
    outcome = run_sweep(sets, plan, folder, run_locally, silent, finalist_trials=20)
    print("The front of accuracy on held-out landscapes against LUTs:")
    for record in outcome.front:
        print(f"{record.luts:>4} LUTs per pixel: accuracy {record.circuit_accuracy:.4f} ({record.name})")
    assert outcome.decision is not None
    best = outcome.decision.chosen.best
    print(outcome.decision.reasons)
    print(f"Its best trial is {best.name}: accuracy {best.accuracy:.4f}, {best.luts} LUTs per pixel.")
    present(outcome, sets, folder)
    model = replace(rebuild(sets, find_trial(plan, folder, best.name)), colours=seen_colours(sets))
    Model(model).save(folder / "model.json")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("build/example"))
