"""Sets of labelled images are split by image."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wnn2hdl.dataset import CLASSES, Dataset, LabelledImage, folds, split
from wnn2hdl.errors import InputError

NAMES = st.sets(st.text(min_size=1, max_size=4), min_size=2, max_size=12)


def make(names: tuple[str, ...], loaded: list[str]) -> Dataset:
    def load(name: str) -> LabelledImage:
        loaded.append(name)
        return LabelledImage(name, np.zeros((1, 3), dtype=np.uint8), np.zeros(1, dtype=np.uint8))

    return Dataset(CLASSES, names, load)


def test_images_are_read_one_by_one_and_again_on_each_pass() -> None:
    loaded: list[str] = []
    dataset = make(("a", "b", "c"), loaded)
    assert len(dataset) == 3
    stream = iter(dataset)
    assert loaded == []
    assert next(stream).name == "a"
    assert loaded == ["a"]
    assert [image.name for image in dataset] == ["a", "b", "c"]


def test_a_subset_has_only_the_named_images() -> None:
    dataset = make(("a", "b", "c"), [])
    assert [image.name for image in dataset.subset(["c", "a"])] == ["a", "c"]
    assert dataset.subset(["a"]).classes == CLASSES


@given(names=NAMES, data=st.data())
def test_each_image_is_tested_in_exactly_one_fold_and_never_trained_in_it(
    names: set[str], data: st.DataObject
) -> None:
    count = data.draw(st.integers(2, len(names)))
    tested: list[str] = []
    for train, test in folds(names, count):
        assert not set(train) & set(test)
        assert set(train) | set(test) == names
        tested += test
    assert sorted(tested) == sorted(names)


def test_fold_membership_follows_the_sorted_names() -> None:
    assert folds(["d", "a", "c", "b", "e"], 2) == (
        (("b", "d"), ("a", "c", "e")),
        (("a", "c", "e"), ("b", "d")),
    )


@pytest.mark.parametrize("count", [0, 1, 4])
def test_an_impossible_number_of_folds_is_refused(count: int) -> None:
    with pytest.raises(InputError, match=f"3 images cannot be split into {count} folds; choose from 2 to 3"):
        folds(["a", "b", "c"], count)


@given(names=NAMES, data=st.data())
def test_a_split_holds_out_as_many_images_as_asked_for(names: set[str], data: st.DataObject) -> None:
    count = data.draw(st.integers(1, len(names) - 1))
    train, test = split(names, count)
    assert len(test) == count
    assert sorted(train + test) == sorted(names)


@pytest.mark.parametrize("test", [0, 3, -1])
def test_a_split_leaves_images_on_both_sides(test: int) -> None:
    with pytest.raises(InputError, match=f"{test} of 3 images cannot be held out"):
        split(["a", "b", "c"], test)
