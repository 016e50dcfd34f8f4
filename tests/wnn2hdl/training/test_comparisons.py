"""The choice of comparisons: on ground whose classes differ in a ratio, whatever the light."""

from dataclasses import replace

import numpy as np
import pytest

from wnn2hdl.dataset import ColourHistogram, LabelledImage, colour_histogram
from wnn2hdl.errors import InputError
from wnn2hdl.ir import Relational, WisardModel
from wnn2hdl.training.budget import pixel_luts
from wnn2hdl.training.comparisons import draw_pixels, select_comparisons
from wnn2hdl.training.crossval import pixels_right

CLASSES = ("forest", "deforested")


def scene(light: float, seed: int) -> ColourHistogram:
    """Forest with half as much red as blue, cleared land with as much, both lit alike."""
    rng = np.random.default_rng(seed)
    labels = rng.integers(0, 2, 3000).astype(np.uint8)
    blue = light * rng.uniform(40, 80, len(labels))
    red = blue * np.where(labels == 1, 1.0, 0.5) * rng.uniform(0.95, 1.05, len(labels))
    pixels = np.stack([red, rng.uniform(30, 90, len(labels)), blue], axis=1)
    return colour_histogram(LabelledImage("scene", pixels.astype(np.uint8), labels), 2)


@pytest.fixture(scope="module", params=[False, True], ids=["labels", "smooth"])
def model(request: pytest.FixtureRequest) -> WisardModel:
    images = [scene(1.0, seed) for seed in range(2)]
    return select_comparisons(images, CLASSES, luts=6, seed=0, smooth=request.param)


def test_red_is_compared_with_blue_within_the_luts(model: WisardModel) -> None:
    assert isinstance(model.encoder, Relational)
    (comparison,) = model.encoder.comparisons.values()
    assert {term.channel for term in comparison.left + comparison.right} == {"R", "B"}
    assert pixel_luts(model) <= 6


def test_the_answers_are_right_in_any_light(model: WisardModel) -> None:
    for exposure in (0.7, 1.0, 1.5):
        assert pixels_right(model, scene(1.0, seed=7), exposure) > 0.98 * 3000


def test_what_is_brighter_than_all_training_pixels_does_not_count_as_dark(model: WisardModel) -> None:
    levels = np.array([[230, 60, 210], [255, 90, 255], [250, 10, 130]], dtype=np.uint8)
    assert model.evaluate_all_codes()[model.encoder.codes(levels)].tolist() == [1, 1, 1]  # type: ignore[union-attr]


def test_the_choice_depends_on_the_seed_alone() -> None:
    images = [scene(1.0, seed) for seed in range(2)]
    first, again = (select_comparisons(images, CLASSES, luts=5, seed=3, smooth=True) for _ in range(2))
    assert first.to_json() == again.to_json()


def test_a_smooth_aim_does_not_follow_labels_that_contradict_the_ratio() -> None:
    images = [scene(1.0, seed) for seed in range(2)]
    wrong = scene(1.0, seed=2)
    mislabelled = replace(
        wrong, counts=np.where(wrong.pixels[:, 0] % 4 == 0, wrong.counts[::-1], wrong.counts)
    )
    training = {
        smooth: draw_pixels([*images, mislabelled], np.random.default_rng(0), smooth=smooth)
        for smooth in (False, True)
    }
    red, _, blue = training[True].pixels.T
    cleared = red > 0.75 * blue
    assert set(training[False].sign) == {-1.0, 1.0}
    assert ((training[False].sign > 0) == cleared).mean() < 0.95
    assert ((training[True].sign > 0) == cleared).mean() > 0.98


def test_images_of_one_class_alone_leave_the_smooth_classifier_out() -> None:
    image = scene(1.0, seed=0)
    forest = replace(image, counts=np.stack([image.counts.sum(axis=0), np.zeros_like(image.counts[0])]))
    assert set(draw_pixels([forest], np.random.default_rng(0), smooth=True).sign) == {-1.0}


@pytest.mark.parametrize(("classes", "luts"), [(("a", "b", "c"), 6), (CLASSES, 3)])
def test_other_classes_and_too_few_luts_are_refused(classes: tuple[str, ...], luts: int) -> None:
    with pytest.raises(InputError, match="comparisons separate two classes and take 4 LUTs or more"):
        select_comparisons([scene(1.0, 0)], classes, luts=luts, seed=0, smooth=False)
