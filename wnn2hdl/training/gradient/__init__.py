"""Networks of 6-input look-up tables, trained by gradient.

One layer of nodes reads chosen bits of the features; each node votes for a class, and the most votes win.
What a node reads and what its table says are both learned, by finite differences that pass straight through
the steps (as in DWN, Bacellar et al., ICML 2024). Few samples are learned by way of a teacher, which labels
as many rows as are wanted. `train_network` trains one, for a number of nodes or within a number of LUTs;
`train_rows` does so from the rows of a table, `LutNetworkClassifier` as a scikit-learn estimator.
"""

from wnn2hdl.training.gradient.classifier import LutNetworkClassifier
from wnn2hdl.training.gradient.network import Architecture, Trained, train_network
from wnn2hdl.training.gradient.rows import train_rows
from wnn2hdl.training.gradient.teacher import Teacher, usual_made_up
from wnn2hdl.training.gradient.training import Recipe, usual_recipe

__all__ = [
    "Architecture",
    "LutNetworkClassifier",
    "Recipe",
    "Teacher",
    "Trained",
    "train_network",
    "train_rows",
    "usual_made_up",
    "usual_recipe",
]
