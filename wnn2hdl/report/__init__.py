"""What a build costs and how it was checked: values to `report.json`, that to pages."""

from wnn2hdl.report.baseline import Recorded, read_baseline, write_baseline
from wnn2hdl.report.build_report import (
    PUBLISHED,
    REPORT_VERSION,
    BuildReport,
    Care,
    EdgeFigures,
    LightFigures,
    Minimised,
    ModelFigures,
    PartFigures,
    Proof,
    PublishedFigure,
    RowFigures,
    published_figures,
    report_dict,
)
from wnn2hdl.report.gate import Check, Limits, run_gate
from wnn2hdl.report.gate_formats import gate_json, gate_junit, gate_markdown
from wnn2hdl.report.index_page import Entry, Exhibit, index_page, is_index
from wnn2hdl.report.markdown import report_markdown
from wnn2hdl.report.model_figures import model_figures
from wnn2hdl.report.page import Picture, build_page
from wnn2hdl.report.placed import HARNESSES, placed_rows
from wnn2hdl.report.schemas import check_report, load_report
from wnn2hdl.report.shell import percent

__all__ = [
    "HARNESSES",
    "PUBLISHED",
    "REPORT_VERSION",
    "BuildReport",
    "Care",
    "Check",
    "EdgeFigures",
    "Entry",
    "Exhibit",
    "LightFigures",
    "Limits",
    "Minimised",
    "ModelFigures",
    "PartFigures",
    "Picture",
    "Proof",
    "PublishedFigure",
    "Recorded",
    "RowFigures",
    "build_page",
    "check_report",
    "gate_json",
    "gate_junit",
    "gate_markdown",
    "index_page",
    "is_index",
    "load_report",
    "model_figures",
    "percent",
    "placed_rows",
    "published_figures",
    "read_baseline",
    "report_dict",
    "report_markdown",
    "run_gate",
    "write_baseline",
]
