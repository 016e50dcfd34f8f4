"""A whole scan: pictures to maps, polygons, overlays and summaries in a folder."""

import hashlib
import math
import shutil
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

import wnn2hdl
from wnn2hdl.emit import MANIFEST_NAME
from wnn2hdl.errors import InputError, ModelFileError
from wnn2hdl.images import list_images
from wnn2hdl.ir.files import make_folder, read_json, write_json, write_text
from wnn2hdl.pipeline.classifiers import PictureClassifier, open_classifier
from wnn2hdl.pipeline.training import Progress
from wnn2hdl.raster import NODATA, RasterReader, add_overviews, same_grid
from wnn2hdl.scan.areas import SQUARE_METRES, class_areas, cleared_classes
from wnn2hdl.scan.change import write_change
from wnn2hdl.scan.cleanup import sieve_raster
from wnn2hdl.scan.ellipsoid import PixelAreas
from wnn2hdl.scan.journal import Journal
from wnn2hdl.scan.mapping import Coverage, Runner, write_classes
from wnn2hdl.scan.options import ScanOptions
from wnn2hdl.scan.overlay import overlay_palette, write_overlay
from wnn2hdl.scan.polygons import write_polygons
from wnn2hdl.scan.source import Source
from wnn2hdl.scan.summary import (
    change_figures,
    class_figures,
    coverage_figures,
    page,
    total_figures,
    warnings,
)
from wnn2hdl.scan.task import Task

SUMMARY_FILE = "summary.json"
SUMMARY_PAGE = "summary.md"
CLASSES_FILE = "classes.tif"
OVERLAY_FILE = "overlay.png"

_WORK = ".scan"
"""The folder, inside the output's, of what is not finished."""

_RESULTS = (
    SUMMARY_FILE,
    SUMMARY_PAGE,
    CLASSES_FILE,
    OVERLAY_FILE,
    "change.tif",
    *(f"{name}.{kind}" for name in ("polygons", "change") for kind in ("geojson", "gpkg")),
)


@dataclass(frozen=True, eq=False)
class Scanner:
    """Scans pictures with one model and one set of options.

    Attributes:
        model: the model file, or the folder of a build.
        classifier: what it holds.
        digest: SHA-256 of the model file, or of the build's manifest, which holds those of its files.
        options: what is wanted.
        run: classifies windows, here or elsewhere.
        progress: told of every step.
    """

    model: Path
    classifier: PictureClassifier
    digest: str
    options: ScanOptions
    run: Runner
    progress: Progress

    @classmethod
    def open(cls, model: Path, options: ScanOptions, run: Runner, progress: Progress) -> "Scanner":
        """Open a model.

        Raises:
            InputError: it is no model or build, or it has more classes than a raster can hold.
        """
        classifier = open_classifier(model)
        if len(classifier.classes) > NODATA:
            raise InputError(
                f"a class raster holds at most {NODATA} classes",
                value=f"{model} ({len(classifier.classes)})",
                mend="train a model of fewer classes",
            )
        file = model / MANIFEST_NAME if model.is_dir() else model
        return cls(model, classifier, hashlib.sha256(file.read_bytes()).hexdigest(), options, run, progress)

    def scan(self, picture: Path, output: Path, before: Path | None = None) -> dict[str, Any]:
        """Scan a picture, or all pictures of a folder.

        A repeated call goes on where an interrupted one stopped.

        Args:
            picture: a file; or a folder, whose pictures get a folder each in ``output``.
            output: the folder to write into.
            before: a picture of the same area at an earlier date.

        Returns:
            the object of `SUMMARY_FILE`.

        Raises:
            InputError: a file cannot be read or written, options contradict each other or the pictures.
            ExtraMissingError: the extra ``geo`` is not installed.
        """
        if picture.is_dir():
            self._check_folder(picture, before)
        else:
            self._check(picture, before)
        make_folder(output)
        if picture.is_dir():
            return self._folder(picture, output)
        if before is None:
            return self._finish(output, self._picture(picture, output))
        # The cloud mask is the later picture's.
        reading = replace(self.options.reading, mask=None)
        earlier = replace(self, options=replace(self.options, reading=reading))
        first = earlier._finished(before, output / "before")
        summary = self._picture(picture, output)
        summary["warnings"] += [f"{before}: {warning}" for warning in first["warnings"]]
        summary |= {"before": str(before), "change": self._change(output)}
        return self._finish(output, summary)

    def _check(self, picture: Path, before: Path | None) -> None:
        """Refuse what cannot be scanned before anything is written."""
        after = RasterReader(picture, self.options.reading)
        self._minimum_pixels(after)
        if before is None:
            return
        if self.options.vector == "none":
            raise InputError(
                "the changes since --before are polygons",
                value="--vector none",
                mend="choose geojson or gpkg",
            )
        earlier = RasterReader(before, replace(self.options.reading, mask=None))
        sizes = [(x.height, x.width) for x in (earlier, after)]
        if sizes[0] != sizes[1] or not same_grid(earlier.georeference, after.georeference, *sizes[0]):
            raise InputError(
                "the pictures of the two dates are on different grids",
                value=f"{before} and {picture}",
                mend="bring them onto one grid first, for instance with gdalwarp",
            )

    def _check_folder(self, folder: Path, before: Path | None) -> None:
        if before or self.options.reading.mask:
            raise InputError(
                "--before and --mask go with one picture, not with a folder", value=folder, mend="name a file"
            )
        stems = [path.stem for path in list_images(folder)]
        for stem in stems:
            if stems.count(stem) > 1:
                raise InputError(
                    "two pictures of a folder have the same stem", value=stem, mend="rename or remove one"
                )

    def _folder(self, folder: Path, output: Path) -> dict[str, Any]:
        pictures = list_images(folder)
        summaries = []
        for number, path in enumerate(pictures):
            summaries.append(self._finished(path, output / path.stem))
            self.progress("scanning pictures", number + 1, len(pictures))
        coverage = Coverage(
            sum(x["classified_pixels"] for x in summaries), sum(x["coverage"]["pixels"] for x in summaries)
        )
        foreign = [x["input"] for x in summaries if x["coverage"]["foreign"]]
        notes = sorted({x["note"] for x in summaries} - {""})
        warned = warnings("; ".join(notes), coverage)
        if foreign:
            warned.append(f"{len(foreign)} of {len(summaries)} pictures are foreign to the model")
        summary = {
            "input": str(folder),
            "pixels": sum(x["pixels"] for x in summaries),
            **total_figures(summaries),
            "coverage": coverage_figures(coverage),
            "warnings": warned,
            **self._provenance(),
            **_speed(sum(x["pixels"] for x in summaries), sum(x["seconds"] for x in summaries)),
            "pictures": summaries,
        }
        return self._finish(output, summary)

    def _finished(self, picture: Path, output: Path) -> dict[str, Any]:
        """Scan a picture unless that was done already with the same options."""
        make_folder(output)
        try:
            known = read_json(output / SUMMARY_FILE, "a summary")
        except ModelFileError:
            known = {}
        if known.get("identity") == self._identity(picture) and (output / CLASSES_FILE).is_file():
            return known
        return self._finish(output, self._picture(picture, output))

    def _picture(self, picture: Path, output: Path) -> dict[str, Any]:
        """Scan one picture; all files but the summary."""
        started = time.perf_counter()
        identity = self._identity(picture)
        task = Task(picture.absolute(), self.options.reading, self.classifier, self.options.method)
        source = task.open()
        limit = self._minimum_pixels(source)
        palette = overlay_palette(self.classifier.classes)
        work = output / _WORK
        make_folder(work)
        with Journal(work / "windows", identity) as kept, _emptied(work / "results") as results:
            raster = results / CLASSES_FILE
            coverage = write_classes(task, source, kept, self.run, raster, palette, self.progress)
            classify_seconds = time.perf_counter() - started
            if limit is not None:
                sieved = raster.with_name("sieved.tif")
                sieve_raster(raster, sieved, limit, self.progress)
                sieved.replace(raster)
            add_overviews(raster)
            self.progress("measuring areas", 0, 1)
            areas = class_areas(raster, self.classifier.classes)
            self.progress("measuring areas", 1, 1)
            if self.options.vector != "none":
                polygons = results / f"polygons.{self.options.vector}"
                write_polygons(raster, polygons, self.classifier.classes, self.progress)
            write_overlay(source.thinned, raster, results / OVERLAY_FILE, palette)
            _deliver(results, output)
        shutil.rmtree(work)
        pixels = source.height * source.width
        return {
            "input": str(picture),
            "size": [source.height, source.width],
            "pixels": pixels,
            **class_figures(areas),
            "coverage": {**coverage_figures(coverage), "pixels": coverage.covered},
            "note": source.note,
            "warnings": warnings(source.note, coverage),
            **self._provenance(),
            "classify_seconds": classify_seconds,
            **_speed(pixels, time.perf_counter() - started),
            "identity": identity,
        }

    def _minimum_pixels(self, source: Source) -> int | None:
        """The least pixels of a region, of the size of the one in the middle; None for no such limit."""
        place, hectares = source.georeference, self.options.minimum_hectares
        # That pixels have no area is told now, not when all are classified.
        areas = PixelAreas(place, source.height, source.width) if place.located else None
        if hectares is None:
            return self.options.minimum_pixels
        if areas is None:
            raise InputError(
                "the picture has no georeference, so its pixels have no area",
                value=f"--minimum-area {hectares:g}",
                mend="say --minimum-pixels",
            )
        return math.ceil(hectares * SQUARE_METRES / areas.middle)

    def _change(self, output: Path) -> dict[str, Any]:
        """Compare the class rasters of two dates that are in the output's folder."""
        with _emptied(output / _WORK) as results:
            changes = results / "change.tif"
            polygons = results / f"change.{self.options.vector}"
            before = output / "before" / CLASSES_FILE
            cleared = cleared_classes(self.classifier.classes)
            after = output / CLASSES_FILE
            change = write_change(before, after, cleared, changes, polygons, self.progress)
            add_overviews(changes)
            for file in (changes, polygons):
                file.replace(output / file.name)
        return change_figures(change)

    def _finish(self, output: Path, summary: dict[str, Any]) -> dict[str, Any]:
        write_text(output / SUMMARY_PAGE, page(summary))
        write_json(output / SUMMARY_FILE, summary)
        return summary

    def _identity(self, picture: Path) -> dict[str, Any]:
        """What decides the result, as far as it can be told without reading all of the picture."""
        files = [picture, *([self.options.reading.mask] if self.options.reading.mask else [])]
        try:
            states = [[str(file.absolute()), file.stat().st_size, file.stat().st_mtime_ns] for file in files]
        except OSError as error:
            raise InputError(
                "cannot read the picture", value=f"{error.filename} ({error.strerror})"
            ) from error
        return {
            "version": wnn2hdl.__version__,
            "files": states,
            "model": self.digest,
            "options": self.options.to_json(),
        }

    def _provenance(self) -> dict[str, Any]:
        packages = ("numpy", "rasterio", "pyproj", "shapely", "pyogrio")
        return {
            "model": {"path": str(self.model), "sha256": self.digest},
            "options": self.options.to_json(),
            "versions": {"wnn2hdl": wnn2hdl.__version__, **{name: version(name) for name in packages}},
        }


@contextmanager
def _emptied(folder: Path) -> Iterator[Path]:
    """A folder for what is not finished; it and all that is in it is removed in the end."""
    shutil.rmtree(folder, ignore_errors=True)
    make_folder(folder)
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _deliver(results: Path, output: Path) -> None:
    """Move finished files to their place; an earlier scan's files of other kinds would contradict them."""
    for name in _RESULTS:
        if not (results / name).exists():
            (output / name).unlink(missing_ok=True)
    for file in sorted(results.iterdir()):
        file.replace(output / file.name)


def _speed(pixels: int, seconds: float) -> dict[str, float]:
    return {"seconds": seconds, "megapixels_per_second": pixels / seconds / 1e6}
