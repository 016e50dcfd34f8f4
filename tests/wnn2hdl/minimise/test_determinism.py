"""Equal tables give equal networks, on a busy machine as on a quiet one."""

import os
import subprocess
import sys
from collections.abc import Iterator
from importlib.metadata import version

import numpy as np
import pytest

from wnn2hdl.ir import TruthTable
from wnn2hdl.minimise import Mapping, espresso, generators, map_luts
from wnn2hdl.tools import find_yosys


def tables() -> list[TruthTable]:
    """Two outputs that share logic, one with don't-cares, and one that keeps ABC busy for some seconds."""
    rng = np.random.default_rng(0)
    made = []
    for width, outputs, on, care in ((8, 2, 0.4, 1.0), (9, 1, 0.4, 0.4), (14, 1, 0.1, 1.0)):
        values = rng.random((1 << width, outputs)) < on
        names = tuple(f"x{i}" for i in range(width)), tuple(f"y{i}" for i in range(outputs))
        made.append(TruthTable(*names, values, rng.random(1 << width) < care))
    return made


def results() -> list[Mapping]:
    return [map_luts(table, effort=1) for table in tables()]


@pytest.fixture
def load() -> Iterator[None]:
    """Three busy processes for each core."""
    count = 3 * (os.cpu_count() or 1)
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(count)]
    yield
    for process in busy:
        process.kill()
        process.wait()


@pytest.mark.slow
def test_a_busy_machine_gives_the_same_networks_and_candidates(request: pytest.FixtureRequest) -> None:
    quiet = results()
    covers = [espresso(table) for table in tables()]
    request.getfixturevalue("load")
    assert results() == quiet
    assert [espresso(table) for table in tables()] == covers


def test_what_decides_a_network_is_told_with_its_version() -> None:
    found = generators()
    assert found["numpy"] == np.__version__
    assert found["pyeda"] == version("pyeda")
    assert found["ABC"].startswith(f"of {find_yosys().name} ")
