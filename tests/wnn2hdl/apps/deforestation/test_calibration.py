"""Pictures whose samples mean different values."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from wnn2hdl.apps.deforestation.calibration import Calibration, require_comparable
from wnn2hdl.errors import InputError

rasterio = pytest.importorskip("rasterio")


def saved(path: Path, kind: str = "uint16", scale: float = 1e-4, offset: float = 0.0) -> Path:
    options: dict[str, Any] = {"height": 4, "width": 4, "count": 3, "dtype": kind, "photometric": "rgb"}
    place = {"crs": "EPSG:32720", "transform": rasterio.Affine(10, 0, 5e5, 0, -10, 9e6)}
    with rasterio.open(path, "w", driver="GTiff", **options, **place) as target:
        target.write(np.ones((3, 4, 4), dtype=kind))
        target.scales, target.offsets = (scale,) * 3, (offset,) * 3
    return path


def test_what_a_file_states_is_read(tmp_path: Path) -> None:
    found = Calibration.read(saved(tmp_path / "a.tif", offset=-0.1), None)
    assert found == Calibration(("uint16",), (1e-4,) * 3, (-0.1,) * 3)
    assert str(found) == "uint16, scale 0.0001, offset -0.1, 3 bands"
    assert Calibration.read(tmp_path / "a.tif", (2,)).offsets == (-0.1,)


@pytest.mark.parametrize(
    ("changed", "named"),
    [({"offset": -0.1}, "offset -0.1"), ({"scale": 1e-4}, "scale 0.0001,"), ({"kind": "int16"}, "int16")],
)
def test_pictures_that_differ_are_refused_by_what_differs(
    changed: dict[str, Any], named: str, tmp_path: Path
) -> None:
    paths = saved(tmp_path / "a.tif", scale=1.0), saved(tmp_path / "b.tif", **{"scale": 1.0} | changed)
    first, second = (Calibration.read(path, None) for path in paths)
    require_comparable(paths[0], first, paths[0], first, "")
    with pytest.raises(InputError, match=rf"mean different values: .*a\.tif.*b\.tif \(.*{named}.*; say so"):
        require_comparable(paths[0], first, paths[1], second, "say so")


def test_pictures_that_both_state_their_units_share_a_scale(tmp_path: Path) -> None:
    paths = saved(tmp_path / "a.tif"), saved(tmp_path / "b.tif", kind="int16", scale=2e-4, offset=-0.1)
    first, second = (Calibration.read(path, None) for path in paths)
    require_comparable(paths[0], first, paths[1], second, "")
