"""Architecture search: thousands of classifiers trained and costed, and one chosen with statistics."""

from wnn2hdl.apps.sweep.distributed import run_distributed
from wnn2hdl.apps.sweep.grid import Plan, Recipe, Trial, grid
from wnn2hdl.apps.sweep.local import run_locally
from wnn2hdl.apps.sweep.page import present
from wnn2hdl.apps.sweep.pixels import TRAINING_PIXELS, PixelSets, draw, seen_colours
from wnn2hdl.apps.sweep.study import Outcome, discard_another, find_trial, run_sweep
from wnn2hdl.apps.sweep.trial import Record, rebuild, run_trial

__all__ = [
    "TRAINING_PIXELS",
    "Outcome",
    "PixelSets",
    "Plan",
    "Recipe",
    "Record",
    "Trial",
    "discard_another",
    "draw",
    "find_trial",
    "grid",
    "present",
    "rebuild",
    "run_distributed",
    "run_locally",
    "run_sweep",
    "run_trial",
    "seen_colours",
]
