"""Fixtures that more than one part of the suite needs."""

import os
import shutil
import signal
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import is_hypothesis_test

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

REAL_DATA = Path(__file__).parents[2] / "shared" / "data"


def pytest_sessionstart() -> None:
    """Let Ctrl-C reach the tests of it: what a shell starts in the background ignores it."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Measure coverage in quick tests of single examples alone: elsewhere it costs half as much again."""
    if config.pluginmanager.hasplugin("_cov"):
        for item in items:
            if item.get_closest_marker("slow") or is_hypothesis_test(getattr(item, "obj", None)):
                item.add_marker(pytest.mark.no_cover)


@pytest.fixture(scope="session")
def realdata() -> Path:
    """The folder of real imagery that lies beside the repository; the test is skipped where it is absent."""
    if not REAL_DATA.is_dir():
        pytest.skip("the real imagery is not beside this repository")
    return REAL_DATA


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[Any]:
    """A scheduler and two workers, each in its own process; a task that killed one is not tried again."""
    dask, distributed = pytest.importorskip("dask"), pytest.importorskip("distributed")
    with (
        dask.config.set({"distributed.scheduler.allowed-failures": 0}),
        distributed.LocalCluster(
            n_workers=2,
            threads_per_worker=1,
            processes=True,
            dashboard_address=None,
            local_directory=str(tmp_path / "workers"),
        ) as running,
    ):
        yield running


@pytest.fixture(scope="session")
def write_build() -> Callable[..., Path]:
    """``write_build(folder, **changes)`` writes a build that was not synthesised: its figures are made up.

    Model, design and networks are real; changes are those of the fields of `BuildReport`.
    """
    from wnn2hdl.build.design import Design
    from wnn2hdl.dataset import from_samples
    from wnn2hdl.edges import boundary
    from wnn2hdl.emit import write_manifest
    from wnn2hdl.encode import parse_bits
    from wnn2hdl.files import write_json
    from wnn2hdl.lower.targets import TARGETS, Ingredients
    from wnn2hdl.minimise.circuit import minimise
    from wnn2hdl.report import BuildReport, Care, PartFigures, Proof, model_figures, report_dict
    from wnn2hdl.training.discriminators import train

    def silent(step: str, done: int, total: int) -> None:
        """No progress is shown."""

    model = train(
        from_samples(2, 64, seed=1),
        parse_bits("R7,R6,R5,G7,G6,G5,B7,B6"),
        address_bits=3,
        rams=6,
        bleaching=None,
        seed=0,
        progress=silent,
    )
    target = TARGETS["block"]
    circuit = minimise(target.lower(Ingredients(model, boundary())), 0, silent).circuit
    design = Design(model, boundary(), circuit, target, "exact", "cells", "made_up", ())
    luts = {
        **{name: len(network.luts) for name, network in design.networks.items()},
        "match": 10,
        "sobel": 74,
    }
    luts["block"] = 9 * luts["pixel"] + luts["edge"]
    report = BuildReport(
        name="made-up",
        target="block",
        mode="exact",
        parts={part: PartFigures(count, carry4=0, delay_ps=100 * count) for part, count in luts.items()},
        proof=Proof("proved", "SAT", 0.5),
        care=Care(256, 1.0, 256),
        accuracy=0.9,
        confusion=((90, 10), (10, 90)),
        model=model_figures(model),
    )

    def write(folder: Path, **changes: Any) -> Path:
        folder.mkdir(parents=True)
        design.save(folder)
        write_json(folder / "report.json", report_dict(replace(report, **({"name": folder.name} | changes))))
        write_manifest(folder, ["design.json", "model.json", "report.json"], versions={}, options={})
        return folder

    return write


@pytest.fixture(scope="session")
def browser() -> Iterator["Browser"]:
    """Headless Chromium; where CI lacks it, that is a failure."""
    from playwright.sync_api import sync_playwright

    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None and not os.environ.get("CI"):
        pytest.skip("Chromium is not installed")
    with sync_playwright() as playwright:
        opened = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox", "--disable-gpu"])
        yield opened
        opened.close()


@pytest.fixture
def open_page(browser: "Browser") -> Iterator[Callable[..., "Page"]]:
    """``open_page(path, color_scheme)`` shows a file; any message, error or request fails the test."""
    wrong: list[str] = []
    pages: list[Page] = []

    def show(path: Path, scheme: Any = "light") -> "Page":
        page = browser.new_page(color_scheme=scheme, viewport={"width": 1180, "height": 900})
        pages.append(page)
        page.on("console", lambda message: wrong.append(message.text))
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on("request", lambda request: wrong.append(request.url) if _asked(request.url) else None)
        page.goto(path.as_uri())
        return page

    yield show
    for page in pages:
        page.close()
    assert wrong == []


def _asked(url: str) -> bool:
    """Whether an address is that of something outside the page."""
    return not url.startswith(("file:", "data:"))
