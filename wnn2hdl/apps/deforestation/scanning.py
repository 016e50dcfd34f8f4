"""A whole scan: pictures to maps, polygons, overlays and summaries in a folder."""

import hashlib
import math
import shutil
import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import Any

import wnn2hdl
from wnn2hdl.apps.deforestation.areas import SQUARE_METRES, class_areas
from wnn2hdl.apps.deforestation.change import write_change
from wnn2hdl.apps.deforestation.cleanup import sieve_in_place
from wnn2hdl.apps.deforestation.ellipsoid import PixelAreas
from wnn2hdl.apps.deforestation.journal import Journal
from wnn2hdl.apps.deforestation.mapping import CLASSIFYING, Coverage, Runner, write_classes
from wnn2hdl.apps.deforestation.options import ScanOptions
from wnn2hdl.apps.deforestation.output import (
    BEFORE,
    CHANGE_FILE,
    CLASSES_FILE,
    OVERLAY_FILE,
    SUMMARY_FILE,
    SUMMARY_PAGE,
    WORK,
    deliver,
    discard,
    emptied,
    require_apart,
)
from wnn2hdl.apps.deforestation.overlay import overlay_palette, write_overlay
from wnn2hdl.apps.deforestation.polygons import write_polygons
from wnn2hdl.apps.deforestation.summary import (
    change_figures,
    class_figures,
    coverage_figures,
    page,
    total_figures,
    warnings,
)
from wnn2hdl.apps.deforestation.task import Task
from wnn2hdl.build.classifier import open_classifier
from wnn2hdl.dataset import cleared_classes
from wnn2hdl.emit import MANIFEST_NAME
from wnn2hdl.errors import InputError, ModelFileError
from wnn2hdl.evaluation.classifiers import PictureClassifier
from wnn2hdl.files import made_folder, read_json, write_json, write_text
from wnn2hdl.images import Source, by_stem, open_picture
from wnn2hdl.progress import Progress
from wnn2hdl.raster import NODATA, add_overviews, same_grid

_PARTS = 1000
"""How finely it is told how far a folder's picture is."""


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
                hint="train a model of fewer classes",
            )
        file = model / MANIFEST_NAME if model.is_dir() else model
        return cls(model, classifier, hashlib.sha256(file.read_bytes()).hexdigest(), options, run, progress)

    def scan(
        self, picture: Path, output: Path, before: Path | None = None, before_mask: Path | None = None
    ) -> dict[str, Any]:
        """Scan a picture, or all pictures of a folder.

        A repeated call goes on where an interrupted one stopped.

        Args:
            picture: a file; or a folder, whose pictures get a folder each in ``output``.
            output: the folder to write into.
            before: a picture of the same area at an earlier date.
            before_mask: its mask; that of the options is the later picture's.

        Returns:
            the object of `SUMMARY_FILE`.

        Raises:
            InputError: a file cannot be read or written, or would be written over; options contradict each
                other or the pictures. Of a folder all other pictures are scanned before.
            ExtraMissingError: the extra ``geo`` is not installed.
        """
        if picture.is_dir():
            self._check_folder(picture, before)
            pictures = by_stem(picture)
            require_apart([self.model, *pictures.values()], output)
            with made_folder(output):
                return self._folder(picture, pictures, output)
        reading = replace(self.options.reading, mask=before_mask)
        earlier = replace(self, options=replace(self.options, reading=reading))
        after = open_picture(picture, self.options.reading)
        # That pixels have no area is told before anything is written.
        files, limit = after.files, self._minimum_pixels(after)
        if before is not None:
            files += earlier._check_earlier(before, picture, after)
        require_apart([self.model, *files], output)
        with made_folder(output):
            identity = self._identity(after.files)
            if before is None:
                return self._finish(output, self._picture(picture, output, identity))
            first = earlier._finished(before, output / BEFORE)
            summary = self._picture(picture, output, identity)
            summary["warnings"] += [f"{before}: {warning}" for warning in first["warnings"]]
            summary |= {"before": str(before), "change": self._change(output, limit)}
            return self._finish(output, summary)

    def _check_earlier(self, before: Path, picture: Path, after: Source) -> tuple[Path, ...]:
        """Refuse a picture of an earlier date that does not fit the later one; all its files."""
        if self.options.vector == "none":
            raise InputError(
                "the changes since --before are polygons",
                value="--vector none",
                hint="choose geojson or gpkg",
            )
        earlier = open_picture(before, self.options.reading)
        sizes = [(x.height, x.width) for x in (earlier, after)]
        if sizes[0] != sizes[1] or not same_grid(earlier.georeference, after.georeference, *sizes[0]):
            raise InputError(
                "the pictures of the two dates are on different grids",
                value=f"{before} and {picture}",
                hint="bring them onto one grid first, for instance with gdalwarp",
            )
        return earlier.files

    def _check_folder(self, folder: Path, before: Path | None) -> None:
        if before or self.options.reading.mask:
            raise InputError(
                "--before and --mask go with one picture, not with a folder", value=folder, hint="name a file"
            )

    def _folder(self, folder: Path, pictures: Mapping[str, Path], output: Path) -> dict[str, Any]:
        summaries, faults = [], []
        for number, (stem, path) in enumerate(pictures.items()):
            one = replace(self, progress=partial(self._part, number, len(pictures)))
            one.progress(CLASSIFYING, 0, 1)
            try:
                summaries.append(one._finished(path, output / stem))
            except InputError as error:
                faults.append(error.line())
            one.progress(CLASSIFYING, 1, 1)
        if faults:
            raise InputError(
                f"{len(faults)} of {len(pictures)} pictures are not scanned",
                value=f"{faults[0]}{', …' if len(faults) > 1 else ''}",
                hint="correct or remove them and run the same command again; the others are kept",
            )
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
        discard(output)
        return self._finish(output, summary)

    def _part(self, number: int, count: int, step: str, done: int, total: int) -> None:
        """Tell how far a picture of a folder is; a line for each step of each would be too many."""
        if step == CLASSIFYING:
            share = number + done / total
            self.progress("scanning pictures", int(share * _PARTS), count * _PARTS)

    def _finished(self, picture: Path, output: Path) -> dict[str, Any]:
        """Scan a picture unless that was done already with the same options."""
        try:
            known = read_json(output / SUMMARY_FILE, "a summary")
        except ModelFileError:
            known = {}
        identity = self._identity(open_picture(picture, self.options.reading).files)
        if known.get("identity") == identity and (output / CLASSES_FILE).is_file():
            return known
        with made_folder(output):
            return self._finish(output, self._picture(picture, output, identity))

    def _picture(self, picture: Path, output: Path, identity: dict[str, Any]) -> dict[str, Any]:
        """Scan one picture; all files but the summary."""
        started = time.perf_counter()
        task = Task(picture.absolute(), self.options.reading, self.classifier, self.options.method)
        source = task.open()
        limit = self._minimum_pixels(source)
        palette = overlay_palette(self.classifier.classes)
        work = output / WORK
        with (
            made_folder(work),
            Journal(work / "windows", identity) as kept,
            emptied(work / "results") as results,
        ):
            raster = results / CLASSES_FILE
            coverage = write_classes(task, source, kept, self.run, raster, palette, self.progress)
            classify_seconds = time.perf_counter() - started
            if limit is not None:
                sieve_in_place(raster, limit, self.progress)
            add_overviews(raster)
            self.progress("measuring areas", 0, 1)
            areas = class_areas(raster, self.classifier.classes)
            self.progress("measuring areas", 1, 1)
            if self.options.vector != "none":
                polygons = results / f"polygons.{self.options.vector}"
                write_polygons(raster, polygons, self.classifier.classes, self.progress)
            write_overlay(source.thinned, raster, results / OVERLAY_FILE, palette)
            deliver(results, output)
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
                hint="say --minimum-pixels",
            )
        return math.ceil(hectares * SQUARE_METRES / areas.middle)

    def _change(self, output: Path, limit: int | None) -> dict[str, Any]:
        """Compare the class rasters of two dates that are in the output's folder."""
        with emptied(output / WORK) as results:
            changes = results / CHANGE_FILE
            polygons = results / f"change.{self.options.vector}"
            before = output / BEFORE / CLASSES_FILE
            cleared = cleared_classes(self.classifier.classes)
            after = output / CLASSES_FILE
            change = write_change(before, after, cleared, limit, changes, polygons, self.progress)
            add_overviews(changes)
            for file in (changes, polygons):
                file.replace(output / file.name)
        return change_figures(change)

    def _finish(self, output: Path, summary: dict[str, Any]) -> dict[str, Any]:
        write_text(output / SUMMARY_PAGE, page(summary))
        write_json(output / SUMMARY_FILE, summary)
        return summary

    def _identity(self, files: Iterable[Path]) -> dict[str, Any]:
        """What decides the result, as far as it can be told without reading all of the picture's files."""
        states = {file.absolute(): file.stat() for file in files}
        return {
            "version": wnn2hdl.__version__,
            "files": [[str(file), state.st_size, state.st_mtime_ns] for file, state in states.items()],
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


def _speed(pixels: int, seconds: float) -> dict[str, float]:
    return {"seconds": seconds, "megapixels_per_second": pixels / seconds / 1e6}
