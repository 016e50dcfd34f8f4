"""Cameras: read from TOML, refused with one line, scaled with their frames."""

from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wnn2hdl.apps.navigation.camera import KEYS, Camera
from wnn2hdl.errors import InputError


def read(folder: Path, text: str) -> Camera:
    path = folder / "camera.toml"
    path.write_text(text)
    return Camera.read(path)


def test_a_focal_length_is_enough(tmp_path: Path) -> None:
    camera = read(tmp_path, "[camera]\nfocal = 750\nwidth = 1000\nheight = 562\ntilt_deg = 10")
    assert camera == Camera.of_focal(750, 1000, 562, 10)
    assert camera.matrix.tolist() == [[750, 0, 499.5], [0, 750, 280.5], [0, 0, 1]]


def test_everything_can_be_given(tmp_path: Path) -> None:
    text = (
        "[camera]\nfx = 700.5\nfy = 701\ncx = 450\ncy = 340\nwidth = 900\nheight = 675\n"
        "distortion = [0.1, -0.2, 0, 0, 0.01]\ntilt_deg = 3\nlean_deg = -1\ntwist_deg = 90\n"
        "stabilised = true"
    )
    assert read(tmp_path, text) == Camera(
        700.5,
        701,
        450,
        340,
        900,
        675,
        (0.1, -0.2, 0, 0, 0.01),
        tilt_deg=3,
        lean_deg=-1,
        twist_deg=90,
        stabilised=True,
    )


FOCAL = "[camera]\nfocal = 750\nwidth = 1000\nheight = 562\n"


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("focal = 750", "no camera in the file"),
        ("[camera", "not TOML"),
        ("[camera]\nfocal = 750\nwidth = 1000", "lacks a key: height"),
        ("[camera]\nfx = 750\nwidth = 1000\nheight = 9", "lacks a key: cx, cy, fy"),
        (FOCAL + "f = 3", "unknown key: f"),
        (FOCAL + "tilt_deg = 'down'", "tilt_deg is not a number: 'down'"),
        (FOCAL + "tilt_deg = 85", "beyond 80 degrees: 85"),
        (FOCAL + "twist_deg = nan", "beyond 360 degrees: nan"),
        (FOCAL + "stabilised = 1", "neither true nor false: 1"),
        (FOCAL + "cx = 2000", "outside the frame"),
        (FOCAL + "distortion = 1", "not a list of numbers: 1"),
        (FOCAL + "distortion = [1]", "not the coefficients of a lens"),
        ("[camera]\nfocal = 8.8\nwidth = 1000\nheight = 562", "focal length is probably in millimetres: 8.8"),
        ("[camera]\nfocal = 0.76\nwidth = 1000\nheight = 562", "a share of the frame's longer side"),
        ("[camera]\nfocal = 0.76\nwidth = 1000\nheight = 562", "give pixels: 760"),
        (FOCAL + "cx = 3.8\ncy = 6.1", "cx is probably an offset from the frame's middle: 3.8"),
        (FOCAL + "cx = 3.8\ncy = 6.1", "count it from the first pixel: 503.3"),
        (FOCAL + "cx = -3.8\ncy = 6.1", "an offset from the middle would be (495.7, 286.6)"),
        (FOCAL + "cx = 510\ncy = 0.5", "cy is probably a share of the frame: 0.5"),
        (FOCAL + "tilt_deg = -90", "where a gimbal's pitch is -90"),
        ("[camera]\nfocal = 0\nwidth = 1000\nheight = 562", "not positive: fx = 0"),
        ("[camera]\nfocal = 750\nwidth = 1000.5\nheight = 562", "width is not a whole number: 1000.5"),
        ("[camera]\nfocal = 750\nwidth = 0\nheight = 562", "frame is empty: width = 0"),
    ],
)
def test_bad_files_are_refused(tmp_path: Path, text: str, fault: str) -> None:
    with pytest.raises(InputError) as caught:
        read(tmp_path, text)
    assert fault in caught.value.line()
    assert "camera.toml" in caught.value.line()


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot read the camera"):
        Camera.read(tmp_path / "none.toml")


def test_scaling_keeps_what_a_place_in_the_frame_looks_at() -> None:
    full = Camera.of_focal(1500, 2000, 1124)
    half = full.scaled(1000, 562)
    assert half == Camera.of_focal(750, 1000, 562)
    corner = np.array([-0.5]), np.array([-0.5])
    assert full.rays(*corner) == pytest.approx(half.rays(*corner))


def test_another_shape_is_refused() -> None:
    with pytest.raises(InputError, match="another shape"):
        Camera.of_focal(750, 1000, 562).scaled(1000, 750)


@settings(max_examples=300, deadline=None)
@given(
    st.dictionaries(
        st.sampled_from([*KEYS, "f", "k1"]),
        st.one_of(
            st.floats().map(repr),
            st.integers(-(10**20), 10**20).map(str),
            st.sampled_from(["true", "'down'", "[]", "[0.1, 0, 0, 0]", "[nan]", "{}", "750.0", "1000"]),
        ),
    ),
    st.text(max_size=20),
)
def test_any_table_is_a_camera_or_refused_in_one_line(
    tmp_path_factory: pytest.TempPathFactory, values: dict[str, str], rest: str
) -> None:
    path = tmp_path_factory.getbasetemp() / "fuzz.toml"
    lines = [f"{key} = {value}" for key, value in values.items()]
    path.write_bytes("\n".join(["[camera]", *lines, rest]).encode("utf-8", "replace"))
    with suppress(InputError):
        camera = Camera.read(path)
        assert np.isfinite(camera.matrix).all()
