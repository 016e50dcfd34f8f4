from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from wnn2hdl.dataset import colour_histogram, from_masks
from wnn2hdl.errors import InputError
from wnn2hdl.ir import BitSelect, WisardModel
from wnn2hdl.training.bitselect import look_up_table, select_bits

CLASSES = ("forest", "deforested")


@dataclass(frozen=True)
class Colours:
    colours: NDArray[np.uint32]
    counts: NDArray[np.int64]


def scene(seed: int, offset: int = 0) -> Colours:
    """Forest around (40, 50, 45), cleared ground around (75, 60, 55), both moved by a haze."""
    rng = np.random.default_rng(seed)
    samples = []
    for label, centre in enumerate([(40, 50, 45), (75, 60, 55)]):
        pixels = rng.normal(np.array(centre) + offset, 5, (2000, 3)).round().clip(0, 255).astype(np.uint32)
        samples.append((pixels[:, 0] << 16 | pixels[:, 1] << 8 | pixels[:, 2], label))
    colours, place = np.unique(np.concatenate([packed for packed, _ in samples]), return_inverse=True)
    counts = np.zeros((2, len(colours)), np.int64)
    np.add.at(counts, (np.repeat([0, 1], 2000), place), 1)
    return Colours(colours, counts)


def accuracy(model: WisardModel, image: Colours) -> float:
    packed = image.colours
    rgb = np.stack([packed >> 16, packed >> 8 & 255, packed & 255], axis=1).astype(np.uint8)
    assert isinstance(model.encoder, BitSelect)
    answers = model.evaluate_all_codes()[model.encoder.codes(rgb)]
    return float(image.counts[answers, np.arange(len(answers))].sum() / image.counts.sum())


@pytest.fixture(scope="module")
def scenes() -> list[Colours]:
    return [scene(seed, offset) for seed, offset in enumerate([-6, -3, 0, 3, 6])]


@pytest.mark.parametrize("luts", [1, 2, 3])
def test_images_under_another_haze_are_classified(scenes: list[Colours], luts: int) -> None:
    model = select_bits(scenes, CLASSES, luts=luts, seed=0)
    assert accuracy(model, scene(99, offset=4)) > 0.95


def test_model_is_a_plain_table_over_bits_that_the_cascade_reads(scenes: list[Colours]) -> None:
    model = select_bits(scenes, CLASSES, luts=2, seed=0)
    assert isinstance(model.encoder, BitSelect)
    assert (model.rams, model.address_bits, model.bleaching) == (1, model.encoder.width, 1)
    assert (model.counts.sum(axis=0) == 1).all()
    inner, last = model.training["cascade"]
    assert {*inner, *last} == {*model.encoder.bits, "lut0"}


def test_same_seed_gives_the_same_model(scenes: list[Colours]) -> None:
    first, second = (select_bits(scenes, CLASSES, luts=1, seed=3) for _ in range(2))
    assert first.digest() == second.digest()


def test_a_single_image_is_enough(scenes: list[Colours]) -> None:
    assert accuracy(select_bits(scenes[:1], CLASSES, luts=1, seed=0), scenes[0]) > 0.95


def test_more_than_two_classes_are_refused(scenes: list[Colours]) -> None:
    with pytest.raises(InputError, match=r"separates two classes: forest, river, road; train discrim"):
        select_bits(scenes, ("forest", "river", "road"), luts=1, seed=0)


@pytest.mark.parametrize("luts", [0, 4])
def test_other_numbers_of_luts_are_refused(scenes: list[Colours], luts: int) -> None:
    with pytest.raises(InputError, match=rf"1 to 3 LUTs per pixel: {luts}; ask for 1 to 3"):
        select_bits(scenes, CLASSES, luts=luts, seed=0)


def test_a_class_without_pixels_is_refused(scenes: list[Colours]) -> None:
    bare = [Colours(image.colours, image.counts * np.array([[1], [0]])) for image in scenes]
    with pytest.raises(InputError, match=r"a class has no training pixels: deforested"):
        select_bits(bare, CLASSES, luts=1, seed=0)
    with pytest.raises(InputError, match=r"a class has no training pixels: forest"):
        select_bits([], CLASSES, luts=1, seed=0)


def test_look_up_table_answers_what_it_was_given() -> None:
    answers = np.array([2, 0, 1, 1])
    model = look_up_table(BitSelect(("R7", "B0")), ("a", "b", "c"), answers, {"method": "test"})
    assert model.evaluate_all_codes().tolist() == answers.tolist()
    assert model.training == {"method": "test"}


@pytest.mark.realdata
def test_one_lut_a_pixel_keeps_its_accuracy_on_images_not_trained_on(realdata: Path) -> None:
    folder = realdata / "amazon_masks"
    images = [colour_histogram(image, 2) for image in from_masks(folder / "images", folder / "masks")]
    right = total = 0.0
    for fold in range(5):
        train = [image for i, image in enumerate(images) if i % 5 != fold]
        model = select_bits(train, CLASSES, luts=1, seed=0)
        for image in images[fold::5]:
            right += accuracy(model, Colours(image.colours, image.counts)) * image.counts.sum()
            total += image.counts.sum()
    assert right / total > 0.925
