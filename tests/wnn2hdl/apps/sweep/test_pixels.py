import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.apps.sweep.pixels import PixelSets, code_counts, draw, even_shares
from wnn2hdl.dataset import CLASSES, Dataset, LabelledImage
from wnn2hdl.encode import high_bits
from wnn2hdl.errors import InputError


def uniform(name: str, forest: int, deforested: int) -> LabelledImage:
    """An image whose only colour gives its name: all pixels (i, i, i) for image i."""
    labels = np.repeat([0, 1], [forest, deforested]).astype(np.uint8)
    return LabelledImage(name, np.full((len(labels), 3), int(name), np.uint8), labels)


def dataset(**sizes: tuple[int, int]) -> Dataset:
    images = {name.removeprefix("i"): size for name, size in sizes.items()}
    return Dataset(CLASSES, tuple(sorted(images)), lambda name: uniform(name, *images[name]))


def drawn(data: Dataset, pixels: int = 100, seed: int = 0) -> PixelSets:
    return draw(data, pixels=pixels, seed=seed, progress=lambda *_: None)


@given(st.lists(st.integers(0, 50), min_size=1, max_size=8), st.integers(0, 500))
def test_even_shares_spend_the_total_and_take_from_the_rich_only_what_the_poor_lack(
    available: list[int], total: int
) -> None:
    shares = even_shares(np.array(available, dtype=np.int64), total)
    assert shares.sum() == min(total, sum(available))
    assert (shares <= available).all()
    short = shares < available
    if short.any():
        assert shares[short].max() - shares[short].min() <= 1
        assert shares.max() <= shares[short].min() + 1


def test_images_are_on_one_side_only() -> None:
    sets = drawn(dataset(i1=(9, 9), i2=(9, 9), i3=(9, 9), i4=(9, 9), i5=(9, 9)))
    assert set(sets.training_images) | set(sets.held_out_images) == set("12345")
    assert len(sets.held_out_images) == 2
    colours = {int(name) * 0x010101 for name in sets.training_images}
    assert set(sets.sample[0].tolist()) == set(sets.imagery[0].tolist()) == colours
    assert not colours & set(sets.held_out[0].tolist())


def test_the_sample_is_even_over_images_and_classes() -> None:
    sets = drawn(dataset(i1=(900, 100), i2=(9, 9), i3=(100, 900), i4=(9, 9)), pixels=80)
    assert sets.training_images == ("1", "3")
    assert sets.sample[1:].T.tolist() == [[0, 0, 20], [0, 1, 20], [1, 0, 20], [1, 1, 20]]


def test_a_scarce_class_is_made_up_for_by_the_others() -> None:
    sets = drawn(dataset(i1=(900, 5), i2=(9, 9), i3=(100, 900), i4=(9, 9)), pixels=80)
    assert sorted(sets.sample[3].tolist()) == [5, 25, 25, 25]
    assert sets.pixels == 80


def test_codes_count_sample_held_out_images_and_imagery() -> None:
    data = dataset(i16=(30, 30), i32=(40, 20), i64=(30, 50), i96=(25, 36))
    sets = drawn(data, pixels=40)
    counts = code_counts(sets, high_bits(4).bits)
    assert counts.training.shape == (2, 2, 4096)
    assert counts.training.sum(axis=2).tolist() == [[10, 10], [10, 10]]
    trained = [int(name) for name in sets.training_images]
    codes = counts.encoder.codes(np.array([[x, x, x] for x in trained], np.uint8))
    assert counts.imagery[codes].tolist() == [len(data.load(name).labels) for name in sets.training_images]
    assert counts.held_out.sum() == sum(len(data.load(name).labels) for name in sets.held_out_images)


def test_the_draw_depends_on_the_seed_alone(sets: PixelSets) -> None:
    data = dataset(i1=(9, 9), i2=(9, 9), i3=(9, 9))
    assert drawn(data).digest == drawn(data).digest
    assert drawn(data) != sets


def test_too_few_images_or_a_class_missing_on_a_side_are_refused() -> None:
    with pytest.raises(InputError, match="a sweep needs images to hold out: 1 image; give two"):
        drawn(dataset(i1=(9, 9)))
    with pytest.raises(InputError, match="no pixel of the held-out images is labelled deforested"):
        drawn(dataset(i1=(9, 9), i2=(9, 0), i3=(9, 9), i4=(9, 0)))
