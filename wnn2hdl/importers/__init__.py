"""Other tools' trained models, read as data: nothing in a file is ever run."""

from wnn2hdl.importers.base import Importer, ImportOptions, Source
from wnn2hdl.importers.formats import import_model, known_formats

__all__ = ["ImportOptions", "Importer", "Source", "import_model", "known_formats"]
