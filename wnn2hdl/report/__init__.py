"""What a build costs and how it was checked: values to `report.json`, and that to Markdown for a person."""

from wnn2hdl.report.build_report import (
    PUBLISHED,
    REPORT_VERSION,
    BuildReport,
    Care,
    EdgeFigures,
    Minimised,
    ModelFigures,
    PartFigures,
    Parts,
    Proof,
    PublishedFigure,
    report_dict,
)
from wnn2hdl.report.markdown import report_markdown

__all__ = [
    "PUBLISHED",
    "REPORT_VERSION",
    "BuildReport",
    "Care",
    "EdgeFigures",
    "Minimised",
    "ModelFigures",
    "PartFigures",
    "Parts",
    "Proof",
    "PublishedFigure",
    "report_dict",
    "report_markdown",
]
