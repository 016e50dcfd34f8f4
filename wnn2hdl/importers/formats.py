"""The formats that can be imported, and which of them a file is."""

from functools import cache
from importlib.metadata import entry_points
from pathlib import Path

from wnn2hdl.errors import InputError
from wnn2hdl.importers import aiger, blif, bthowen, dwn, kanele, wisardpkg
from wnn2hdl.importers.base import ImportedModel, Importer, ImportOptions, Source

GROUP = "wnn2hdl.importers"
"""Entry points of other packages that name an `Importer`."""

BUILT_IN = (
    wisardpkg.IMPORTER,
    bthowen.IMPORTER,
    dwn.IMPORTER,
    kanele.IMPORTER,
    aiger.IMPORTER,
    blif.IMPORTER,
)


@cache
def known_formats() -> dict[str, Importer]:
    """Importers by name: our own, then those of other packages.

    Raises:
        InputError: another package's importer cannot be loaded, is not an importer, or uses a name that is
            taken.
    """
    found = {importer.name: importer for importer in BUILT_IN}
    for point in entry_points(group=GROUP):
        try:
            importer = point.load()
        except Exception as error:
            raise InputError("cannot load an importer", value=f"{point.value} ({error})") from error
        if not isinstance(importer, Importer) or importer.name in found:
            raise InputError(
                "not an importer with its own name",
                value=point.value,
                hint="uninstall or repair its package",
            )
        found[importer.name] = importer
    return found


def import_model(
    path: Path, options: ImportOptions, format_name: str | None = None
) -> tuple[Importer, ImportedModel]:
    """Read another tool's trained model.

    Args:
        path: the file.
        options: what the file may leave open.
        format_name: its format, a key of `known_formats`; found by its content if left out.

    Returns:
        the importer that read it, and the model.

    Raises:
        InputError: the file cannot be read, is of no known format or of several, is damaged, leaves open
            what no option says, or an option was given that does not apply to it.
    """
    source = Source(path)
    importer = _recognised(source) if format_name is None else known_formats()[format_name]
    needless = sorted(options.given - importer.options)
    if needless:
        raise InputError(
            f"an option does not apply to {importer.description}",
            value=f"--{needless[0]}",
            hint="leave it out",
        )
    return importer, importer.read(source, options)


def _recognised(source: Source) -> Importer:
    found = [importer for importer in known_formats().values() if importer.recognises(source)]
    if len(found) == 1:
        return found[0]
    names = ", ".join(importer.name for importer in found or known_formats().values())
    fault = (
        "the file could be of several formats" if found else "the file is of no format that can be imported"
    )
    raise InputError(fault, value=source.path, hint=f"give --format, one of {names}")
