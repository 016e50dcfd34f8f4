"""A picture through a build's circuit."""

from pathlib import Path

import numpy as np
import pytest

from wnn2hdl.build.playback import play
from wnn2hdl.errors import InputError
from wnn2hdl.images import read_rgb
from wnn2hdl.ir import WisardModel
from wnn2hdl.wisard import PixelClassifier


def silent(step: str, done: int, total: int) -> None:
    pass


@pytest.mark.slow
def test_every_window_of_a_picture_runs_and_the_waves_are_recorded(
    build: Path, model: WisardModel, imagery: Path, tmp_path: Path
) -> None:
    picture = imagery / "7.png"
    result = play(build, picture, "amaranth", silent, tmp_path / "waves.vcd")
    assert result.windows == 62 * 62
    assert result.cared == 1.0
    model_says = PixelClassifier(model).classify(read_rgb(picture)) != 0
    assert np.array_equal(result.foreground, model_says[1:-1, 1:-1])
    assert result.edges is not None
    assert result.edges.any()
    assert "edge_bit" in (tmp_path / "waves.vcd").read_text()


def test_waves_come_from_amaranths_simulator_only(build: Path, imagery: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="Amaranth's simulator only"):
        play(build, imagery / "7.png", "icarus", silent, tmp_path / "waves.vcd")
