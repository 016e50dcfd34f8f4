"""A whole scan: pictures to maps, polygons, overlays and summaries in a folder."""

import hashlib
import shutil
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

import wnn2hdl
from wnn2hdl.apps.deforestation.areas import class_areas
from wnn2hdl.apps.deforestation.calibration import Calibration, require_comparable
from wnn2hdl.apps.deforestation.change import write_change
from wnn2hdl.apps.deforestation.cleanup import sieve_in_place
from wnn2hdl.apps.deforestation.ellipsoid import PixelAreas
from wnn2hdl.apps.deforestation.finished import FinishedWindows
from wnn2hdl.apps.deforestation.folder import scan_folder
from wnn2hdl.apps.deforestation.mapping import Runner, write_classes
from wnn2hdl.apps.deforestation.options import ScanOptions
from wnn2hdl.apps.deforestation.output import (
    BEFORE,
    CHANGE_FILE,
    CLASSES_FILE,
    OVERLAY_FILE,
    SUMMARY_FILE,
    SUMMARY_HTML,
    SUMMARY_PAGE,
    WINDOWS,
    WORK,
    deliver,
    require_apart,
    unfinished,
)
from wnn2hdl.apps.deforestation.overlay import overlay_palette, write_overlay
from wnn2hdl.apps.deforestation.page import scan_page
from wnn2hdl.apps.deforestation.polygons import write_polygons
from wnn2hdl.apps.deforestation.summary import (
    change_figures,
    class_figures,
    coverage_figures,
    page,
    warnings,
)
from wnn2hdl.apps.deforestation.task import Task
from wnn2hdl.build.classifier import open_classifier
from wnn2hdl.dataset import cleared_classes
from wnn2hdl.emit import MANIFEST_NAME
from wnn2hdl.errors import InputError, ModelFileError
from wnn2hdl.evaluation.classifiers import PictureClassifier
from wnn2hdl.files import output_folder, read_json, write_json, write_text
from wnn2hdl.images import Source, by_stem, open_picture
from wnn2hdl.progress import Progress
from wnn2hdl.raster import NODATA, Reading, add_overviews, same_grid


@dataclass(frozen=True, eq=False)
class Scanner:
    """Scans pictures with one model and one set of options.

    Attributes:
        model: the model file, or the folder of a build.
        classifier: what it holds.
        digest: SHA-256 of the model file, or of the build's manifest, which holds those of its files.
        options: what is wanted.
        run: classifies windows, here or elsewhere.
        progress: called with every step.
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
            InputError: it is not a model or build, or it has more classes than a raster can hold.
        """
        classifier = open_classifier(model)
        if len(classifier.classes) > NODATA:
            raise InputError(
                f"a class raster holds at most {NODATA} classes",
                value=f"{model} ({len(classifier.classes)})",
                hint="train a model of fewer classes",
            )
        file = model / MANIFEST_NAME if model.is_dir() else model
        return cls(model, classifier, hashlib.sha256(file.read_bytes()).hexdigest(), options, run, progress)

    def scan(
        self, picture: Path, output: Path, before: Path | None = None, before_reading: Reading | None = None
    ) -> dict[str, Any]:
        """Scan a picture, or all pictures of a folder.

        A repeated call continues where an interrupted one stopped.

        Args:
            picture: a file; or a folder, whose pictures get a folder each in ``output``.
            output: the folder to write into.
            before: a picture of the same area at an earlier date.
            before_reading: how it is read, with its own mask; what else it does not name is as for the
                later picture.

        Returns:
            the object of `SUMMARY_FILE`.

        Raises:
            InputError: a file cannot be read or written, or would be written over; options contradict each
                other or the pictures; the samples of two pictures mean different values; or another process
                writes into the folder. Of a folder all other pictures are scanned before.
            ExtraMissingError: the extra ``geo`` is not installed.
        """
        if picture.is_dir():
            if before or self.options.reading.exclude:
                raise InputError(
                    "--before and --exclude go with one picture, not with a folder",
                    value=picture,
                    hint="give a file",
                )
            pictures = by_stem(picture)
            require_apart([self.model, *pictures.values()], output)
            with output_folder(output, "scan"):
                return self._finish(output, self._folder(picture, pictures, output))
        after = open_picture(picture, self.options.reading)
        # Pixels without an area are reported before anything is written.
        self._check_place(after)
        if before is None:
            require_apart([self.model, *after.files], output)
            with output_folder(output, "scan"):
                return self._finish(output, self._picture(picture, output, self._identity(after.files)))
        earlier = self._earlier(before, before_reading or Reading(), picture, after)
        files = open_picture(before, earlier.options.reading).files
        require_apart([self.model, *after.files, *files], output)
        with output_folder(output, "scan"):
            first = earlier._finished(before, output / BEFORE)
            summary = self._picture(picture, output, self._identity(after.files))
            summary["warnings"] += [f"{before}: {warning}" for warning in first["warnings"]]
            summary |= {"before": first["input"], "before_options": first["options"]}
            summary |= {"change": self._change(output)}
            return self._finish(output, summary)

    def _folder(self, folder: Path, pictures: Mapping[str, Path], output: Path) -> dict[str, Any]:
        """The summary of all pictures of a folder."""
        figures = scan_folder(
            pictures,
            output,
            self.options.reading.bands,
            self.classifier.classes,
            lambda picture, place, progress: replace(self, progress=progress)._finished(picture, place),
            self.progress,
        )
        return {"input": str(folder), **figures, **self._provenance()}

    def _finished(self, picture: Path, output: Path) -> dict[str, Any]:
        """The summary of one picture, which is scanned unless that was done with the same options."""
        identity = self._identity(open_picture(picture, self.options.reading).files)
        with output_folder(output, "scan"):
            try:
                known = read_json(output / SUMMARY_FILE, "a summary")
            except ModelFileError:
                known = {}
            if known.get("identity") == identity and (output / CLASSES_FILE).is_file():
                return known
            return self._finish(output, self._picture(picture, output, identity))

    def _provenance(self) -> dict[str, Any]:
        """What a summary says of how it came about."""
        packages = ("numpy", "rasterio", "pyproj", "shapely", "pyogrio")
        return {
            "model": {"path": str(self.model), "sha256": self.digest},
            "options": self.options.to_json(),
            "versions": {"wnn2hdl": wnn2hdl.__version__, **{name: version(name) for name in packages}},
        }

    def _earlier(self, before: Path, reading: Reading, picture: Path, after: Source) -> "Scanner":
        """The scanner of the picture of an earlier date, which must fit the later one."""
        if self.options.vector == "none":
            raise InputError(
                "the changes since --before are polygons",
                value="--vector none",
                hint="choose geojson or gpkg",
            )
        now = self.options.reading
        then = replace(
            reading,
            bands=reading.bands or now.bands,
            scale=reading.scale or now.scale,
            alpha=reading.alpha or now.alpha,
        )
        if reading.scale is None:
            require_comparable(
                before,
                Calibration.read(before, then.bands),
                picture,
                Calibration.read(picture, now.bands),
                "give --scale LOW..HIGH and --before-scale LOW..HIGH, each in the units of its own file",
            )
        earlier = open_picture(before, then)
        sizes = [(x.height, x.width) for x in (earlier, after)]
        if sizes[0] != sizes[1] or not same_grid(earlier.georeference, after.georeference, *sizes[0]):
            raise InputError(
                "the pictures of the two dates are on different grids",
                value=f"{before} and {picture}",
                hint="bring them onto one grid first, for instance with gdalwarp",
            )
        return replace(self, options=replace(self.options, reading=then))

    def _picture(self, picture: Path, output: Path, identity: dict[str, Any]) -> dict[str, Any]:
        """Scan one picture; all files but the summary."""
        task = Task(picture.absolute(), self.options.reading, self.classifier, self.options.method)
        source = task.source
        self._check_place(source)
        palette = overlay_palette(self.classifier.classes)
        with unfinished(output) as results, FinishedWindows(output / WORK / WINDOWS, identity) as kept:
            raster = results / CLASSES_FILE
            coverage = write_classes(task, source, kept, self.run, raster, palette, self.progress)
            if self.options.minimum is not None:
                sieve_in_place(raster, self.options.minimum, self.progress)
            add_overviews(raster)
            self.progress("measuring areas", 0, 1)
            areas = class_areas(raster, self.classifier.classes)
            self.progress("measuring areas", 1, 1)
            if self.options.vector != "none":
                polygons = results / f"polygons.{self.options.vector}"
                write_polygons(raster, polygons, self.classifier.classes, self.progress)
            write_overlay(source.thinned, raster, results / OVERLAY_FILE, palette)
            deliver(results, output)
        shutil.rmtree(output / WORK)
        return {
            "input": str(picture),
            "size": [source.height, source.width],
            "pixels": source.height * source.width,
            **class_figures(areas),
            "coverage": {**coverage_figures(coverage), "pixels": coverage.covered},
            "note": source.note,
            "warnings": warnings(source.note, coverage),
            **self._provenance(),
            "identity": identity,
        }

    def _check_place(self, source: Source) -> None:
        """Refuse pixels without an area, where one is wanted, before all are classified."""
        place, minimum = source.georeference, self.options.minimum
        if place.located:
            PixelAreas(place, source.height, source.width)
        elif minimum is not None and minimum.hectares:
            raise InputError(
                "the picture has no georeference, so its pixels have no area",
                value=f"--min-area {minimum.hectares:g}",
                hint="give --min-pixels",
            )

    def _change(self, output: Path) -> dict[str, Any]:
        """Compare the class rasters of two dates that are in the output's folder."""
        with unfinished(output) as results:
            change = write_change(
                output / BEFORE / CLASSES_FILE,
                output / CLASSES_FILE,
                cleared_classes(self.classifier.classes),
                self.options.minimum,
                results / CHANGE_FILE,
                results / f"change.{self.options.vector}",
                self.progress,
            )
            add_overviews(results / CHANGE_FILE)
            for file in results.iterdir():
                file.replace(output / file.name)
        return change_figures(change)

    def _finish(self, output: Path, summary: dict[str, Any]) -> dict[str, Any]:
        write_text(output / SUMMARY_PAGE, page(summary))
        write_text(output / SUMMARY_HTML, scan_page(summary, output))
        write_json(output / SUMMARY_FILE, summary)
        return summary

    def _identity(self, files: Iterable[Path]) -> dict[str, Any]:
        """What decides the result, as far as it is known without reading all of the picture's files."""
        states = {file.absolute(): file.stat() for file in files}
        return {
            "version": wnn2hdl.__version__,
            "files": [[str(file), state.st_size, state.st_mtime_ns] for file, state in states.items()],
            "model": self.digest,
            "options": self.options.to_json(),
        }
