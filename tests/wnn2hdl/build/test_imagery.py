"""What the compiler learns from a folder of pictures."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from wnn2hdl.build.imagery import Imagery, edge_agreement, learn_edges, survey
from wnn2hdl.edges import boundary
from wnn2hdl.errors import InputError
from wnn2hdl.images import list_images, read_rgb
from wnn2hdl.ir import WisardModel, pixel_encoder, window_codes
from wnn2hdl.raster import Reading
from wnn2hdl.samples import landscape
from wnn2hdl.wisard import PixelClassifier


def silent(step: str, done: int, total: int) -> None:
    pass


def test_a_survey_counts_every_pixel_and_every_window(model: WisardModel, imagery: Path) -> None:
    seen = survey(model, Imagery(imagery, Reading()), silent)
    pictures = [read_rgb(path) for path in list_images(imagery)]
    codes = np.concatenate([pixel_encoder(model).codes(picture).ravel() for picture in pictures])
    assert np.array_equal(seen.codes, np.bincount(codes, minlength=2**8))
    classifier = PixelClassifier(model)
    windows = [window_codes(classifier.classify(picture) != 0).ravel() for picture in pictures]
    assert np.array_equal(seen.windows, np.bincount(np.concatenate(windows), minlength=512))


def test_progress_is_told_of_every_picture(model: WisardModel, imagery: Path) -> None:
    reported: list[tuple[int, int]] = []
    survey(model, Imagery(imagery, Reading()), lambda _, done, total: reported.append((done, total)))
    assert reported == [(0, 2), (1, 2), (2, 2)]


def test_learned_patterns_agree_with_canny_at_least_as_well_as_any_boundary(
    model: WisardModel, imagery: Path
) -> None:
    pictures = Imagery(imagery, Reading())
    learned = edge_agreement(learn_edges(model, pictures, 75, None, silent), model, pictures, silent).f1
    plain = edge_agreement(boundary(), model, pictures, silent).f1
    assert learned is not None
    assert plain is not None
    assert learned > plain


def test_an_empty_folder_is_refused(model: WisardModel, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no pictures"):
        survey(model, Imagery(tmp_path, Reading()), silent)


def test_what_is_no_data_is_neither_a_code_nor_a_window(model: WisardModel, tmp_path: Path) -> None:
    scene = landscape(64, 64, 3).image
    alpha = np.full((64, 64), 255, dtype=np.uint8)
    alpha[:, 40:] = 0
    Image.fromarray(np.dstack([scene, alpha])).save(tmp_path / "a.png")
    seen = survey(model, Imagery(tmp_path, Reading()), silent)
    (tmp_path / "cut").mkdir()
    Image.fromarray(scene[:, :40]).save(tmp_path / "cut" / "a.png")
    expected = survey(model, Imagery(tmp_path / "cut", Reading()), silent)
    assert np.array_equal(seen.codes, expected.codes)
    assert np.array_equal(seen.windows, expected.windows)
    assert (seen.left_out, expected.left_out) == (24 / 64, 0)


def test_the_rim_of_the_data_is_no_edge(model: WisardModel, tmp_path: Path) -> None:
    pixels = np.full((32, 32, 4), (40, 90, 40, 255), dtype=np.uint8)
    pixels[:, 20:] = (255, 255, 255, 0)
    Image.fromarray(pixels).save(tmp_path / "a.png")
    found = edge_agreement(boundary(), model, Imagery(tmp_path, Reading()), silent)
    assert (found.found, found.expected) == (0, 0)
