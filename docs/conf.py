"""Sphinx's settings; the page of each command is written from the code before every build."""

from pathlib import Path

import wnn2hdl
from wnn2hdl.cli.commands import COMMANDS

project = "wnn2hdl"
author = "the wnn2hdl developers"
version = release = wnn2hdl.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.doctest",
    "sphinx.ext.napoleon",
    "sphinx_click",
]
exclude_patterns = ["_build"]
html_theme = "furo"
html_title = "wnn2hdl"
html_copy_source = False
myst_enable_extensions = ["deflist", "dollarmath"]
myst_heading_anchors = 3
html_show_copyright = False
smartquotes = False  # it would turn two hyphens, as options have, into a dash
autodoc_typehints = "none"  # signatures have names; docstrings say what they mean
default_role = "literal"  # docstrings name code in single backquotes
nitpicky = True
nitpick_ignore_regex = [("py:(class|exc)", ".*")]  # types and errors have no pages of their own
suppress_warnings = ["epub.unknown_project_files"]
linkcheck_ignore = [r"https://doi\.org/"]  # publishers' sites refuse robots

_PAGE = """.. click:: {module}:{function}
   :prog: wnn2hdl {name}
   :nested: none
"""


def _write_command_pages(folder: Path) -> None:
    folder.mkdir(exist_ok=True)
    for page in folder.glob("*.rst"):
        if page.stem not in COMMANDS:
            page.unlink()
    for name, entry in COMMANDS.items():
        text = _PAGE.format(name=name, module=f"wnn2hdl.cli.{entry.module}", function=f"{name}_command")
        page = folder / f"{name}.rst"
        if not page.exists() or page.read_text(encoding="utf-8") != text:
            page.write_text(text, encoding="utf-8")


_write_command_pages(Path(__file__).parent / "commands")
