"""Fixtures that more than one part of the suite needs."""

from pathlib import Path

import pytest

REAL_DATA = Path(__file__).parents[2] / "shared" / "data"


@pytest.fixture(scope="session")
def realdata() -> Path:
    """The folder of real imagery that lies beside the repository; the test is skipped where it is absent."""
    if not REAL_DATA.is_dir():
        pytest.skip("the real imagery is not beside this repository")
    return REAL_DATA
