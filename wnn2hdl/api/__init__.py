"""The compiler from Python: each stage a function, whose result prints well and shows itself in a notebook.

Pictures are arrays or folders of files, and nothing is written unless a folder is named. What these functions
return holds the library's own objects, for whoever needs more.
"""

from wnn2hdl.api.builds import (
    Build,
    Verification,
    compile,  # noqa: A004  # as the command is called
    open_build,
    verify,
)
from wnn2hdl.api.flights import Flight, locate, recording
from wnn2hdl.api.maps import Map, scan
from wnn2hdl.api.measuring import Measured, evaluate, evaluate_table
from wnn2hdl.api.models import Model, import_model, load, train, train_table
from wnn2hdl.api.progress import silent
from wnn2hdl.build.planning import CompileOptions

__all__ = [
    "Build",
    "CompileOptions",
    "Flight",
    "Map",
    "Measured",
    "Model",
    "Verification",
    "compile",
    "evaluate",
    "evaluate_table",
    "import_model",
    "load",
    "locate",
    "open_build",
    "recording",
    "scan",
    "silent",
    "train",
    "train_table",
    "verify",
]
